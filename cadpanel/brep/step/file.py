"""STEP files of panels: written straight from the exact topology, read back through the kernel.

The text is written without the kernel's own translator: it keeps every digit of a double (the translator keeps 12), is
byte for byte the same for the same panels, a third of the size, and takes a quarter of the time.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from OCP.Standard import Standard_Failure
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.files.step_reader import StepDocument, StepFault, read_document
from cadpanel.brep.files.xcaf import products_of
from cadpanel.brep.step.products import Header, step_file
from cadpanel.brep.step.properties import ATTRIBUTES, PartData, Stated
from cadpanel.brep.step.schemas import Schema
from cadpanel.brep.step.stated import stated_of
from cadpanel.brep.step.topology import UnsupportedGeometry
from cadpanel.errors import DeliveryError
from cadpanel.sizes import refuse_huge

Color = tuple[float, float, float]
NamedShape = tuple[str, TopoDS_Shape, Color | None]


def write_step(
    path: str | os.PathLike[str],
    shapes: Sequence[NamedShape],
    *,
    title: str,
    schema: Schema = "AP242",
    placed: tuple[float, float, float] = (0.0, 0.0, 0.0),
    data: Sequence[PartData] = (),
    header: Header | None = None,
) -> None:
    """Write a flat assembly, one product a shape with its name and colour, whole or not at all.

    Arguments:
        path: the file; an existing one is replaced once the new one is complete.
        shapes: name, a solid or an open shell that cadpanel built, sRGB colour with components in 0 to 1 or None.
            Names must differ.
        title: name of the assembly.
        schema: "AP242" or "AP214".
        placed: where the origin of the shapes' coordinates lies in the assembly, mm. Their own numbers stay small: far
            from the origin the kernel's checks lose their digits.
        data: what is said of each shape besides; empty to say nothing but their names.
        header: who wrote it, and when.

    Raises:
        DeliveryError: if the file cannot be written, or a shape has other than plane, cone and cylinder faces.
    """
    target = Path(path)
    try:
        text = step_file(shapes, title, schema, placed, data, header)
    except UnsupportedGeometry as error:
        raise DeliveryError(f"{target} cannot be written: it would hold {error}, not an exact panel.") from error
    _write_whole(target, text)


def _write_whole(target: Path, text: str) -> None:
    temporary: Path | None = None
    try:
        with tempfile.NamedTemporaryFile(
            "w", encoding="ascii", newline="\n", dir=target.parent, prefix=f".{target.name}.", delete=False
        ) as file:
            temporary = Path(file.name)
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    except OSError as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        raise DeliveryError(f"{target} cannot be written: {error.strerror or error}.") from error


def _umask() -> int:
    """The process's mask; a temporary file is created for the owner only, the delivered one is not to be."""
    mask = os.umask(0)
    os.umask(mask)
    return mask


def read_step_shapes(path: str | os.PathLike[str], *, heal: bool = False) -> list[tuple[str, TopoDS_Shape]]:
    """The products of a flat assembly with their names, in the file's order; a single part counts as one.

    Arguments:
        path: the file.
        heal: whether the kernel may repair what it reads, as it does by default. Without, the shapes are what the file
            says, and reading takes less than half the time.

    Raises:
        DeliveryError: if the file is missing, not STEP, cut short, or damaged.
    """
    return open_step(path, heal=heal).shapes


@dataclass(frozen=True, slots=True)
class OpenStep:
    """A file's products with their names, in its order.

    The kernel's reader is kept for as long as the shapes are worked on: see `StepDocument`.
    """

    document: StepDocument
    shapes: list[tuple[str, TopoDS_Shape]]

    def stated(self) -> dict[str, Stated]:
        """What the file says of its products besides, by their names; nothing if it was not read for it."""
        return stated_of(self.document.document, ATTRIBUTES)


def open_step(path: str | os.PathLike[str], *, heal: bool = False, properties: bool = False) -> OpenStep:
    """The same, for longer work on the shapes; and if asked for, what is said of them besides."""
    target = Path(path)
    if not target.is_file():
        raise DeliveryError(f"'{target}' cannot be read: there is no such file.")
    refuse_huge(target, DeliveryError)
    try:
        step = read_document(target, labels=False, heal=heal, properties=properties)
    except StepFault as error:
        why = f"is damaged ({error.fault})" if error.fault else "is not a complete STEP file"
        raise DeliveryError(f"'{target}' cannot be read: it {why}.") from error
    except Standard_Failure as error:
        raise DeliveryError(f"'{target}' cannot be read: it makes the CAD kernel fail ({error}).") from error
    shapes = products_of(step.document)
    if not shapes:
        raise DeliveryError(f"'{target}' cannot be read: it holds no shapes.")
    return OpenStep(step, shapes)
