"""What the guarded interpreter does: read files that another one names, and hand over what they hold."""

from __future__ import annotations

import os
import pickle
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import BinaryIO

from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_FACE

from cadpanel.brep.formats.catalogue import format_of
from cadpanel.brep.formats.step import STEP
from cadpanel.brep.guard import HEADER, Task
from cadpanel.brep.model import Model, children, compound_of, packed, shapes_of, unpacked
from cadpanel.brep.products import NamedShape, read_products
from cadpanel.brep.sampling import sample_faces
from cadpanel.errors import ReferenceFileError


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
    """Named shapes on their way between interpreters."""

    names: tuple[tuple[str, str], ...]
    shapes: bytes

    def unpack(self) -> tuple[NamedShape, ...]:
        """The shapes again."""
        shapes = children(unpacked(self.shapes))
        return tuple(NamedShape(*names, shape) for names, shape in zip(self.names, shapes, strict=True))


def read(task: Task, path: Path, millimetres: float | None) -> PackedModel | PackedProducts:
    """Read a file and pack what it holds.

    Raises:
        ReferenceFileError: the kernel cannot read it.
    """
    if task == "products":
        products = read_products(path)
        names = tuple((product.name, product.instance) for product in products)
        return PackedProducts(names=names, shapes=packed(compound_of(product.shape for product in products)))
    form = format_of(path)
    model = form.read(path, millimetres)
    if form is not STEP:
        _try_out(model)
    bare = tuple(replace(part, shape=None) for part in model.parts)
    shapes = packed(compound_of(part.shape for part in model.parts))
    return PackedModel(model=replace(model, parts=bare), shapes=shapes)


def _try_out(model: Model) -> None:
    """Evaluate every face here, where a crash of the kernel does no harm.

    The STEP reader checks what it builds, and of 1500 damaged files none crashed later; the other readers take shapes
    over as they are.
    """
    for part in model.parts:
        for face in shapes_of(part.shape, TopAbs_FACE):
            try:
                sample_faces(face)
            except (Standard_Failure, ValueError, FloatingPointError) as error:
                raise ReferenceFileError(
                    f"'{model.source}' holds a face that the CAD kernel cannot evaluate ({error}): repair the "
                    "reference and export it again."
                ) from error


def serve(requests: BinaryIO, answers: BinaryIO) -> None:
    """Answer one request after the other until none comes."""
    while header := requests.read(HEADER.size):
        task, path, millimetres = pickle.loads(requests.read(HEADER.unpack(header)[0]))
        answer: object
        try:
            answer = read(task, Path(path), millimetres)
        except ReferenceFileError as error:
            answer = error
        data = pickle.dumps(answer)
        answers.write(HEADER.pack(len(data)) + data)
        answers.flush()


if __name__ == "__main__":
    # Answers go through a channel of their own, as the kernel prints to standard output.
    channel = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    # The classes of the answers must bear the name under which the other interpreter knows them.
    from cadpanel.brep.reading import serve as serve_under_its_name

    serve_under_its_name(sys.stdin.buffer, channel)
