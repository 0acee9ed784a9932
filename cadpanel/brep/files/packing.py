"""What a file holds on its way between two interpreters."""

from __future__ import annotations

from dataclasses import dataclass, replace

from cadpanel.brep.files.model import Model, NamedShape, Products
from cadpanel.brep.kernel.shapes import children, unpacked


@dataclass(frozen=True, slots=True, kw_only=True)
class PackedModel:
    """A model on its way between interpreters: all its shapes in one piece, so that what they share stays shared."""

    model: Model
    shapes: bytes

    def unpack(self) -> Model:
        """The model again."""
        shapes = children(unpacked(self.shapes))
        parts = tuple(replace(part, shape=shape) for part, shape in zip(self.model.parts, shapes, strict=True))
        return replace(self.model, parts=parts)


@dataclass(frozen=True, slots=True, kw_only=True)
class PackedProducts:
    """Named shapes on their way between interpreters, and the unit that their file says."""

    names: tuple[str, ...]
    unit: str | None
    shapes: bytes

    def unpack(self) -> Products:
        """The shapes again."""
        shapes = zip(self.names, children(unpacked(self.shapes)), strict=True)
        return Products(shapes=tuple(NamedShape(name, shape) for name, shape in shapes), unit=self.unit)
