"""STEP files of panels: written straight from the exact topology, read back through the kernel.

The text is written without the kernel's own translator: it keeps every digit of a double (the translator keeps 12), is
byte for byte the same for the same panels, a third of the size, and takes a quarter of the time.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from OCP.IFSelect import IFSelect_RetDone
from OCP.Resource import Resource_DataMapOfAsciiStringAsciiString
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_AsciiString, TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from cadpanel.brep.files.step_damage import damage
from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.brep.step.products import Schema, step_file
from cadpanel.brep.step.topology import UnsupportedGeometry
from cadpanel.errors import DeliveryError

HEALING_MODES = (
    "FixSolidMode",
    "FixShellMode",
    "FixFaceMode",
    "FixSameParameterMode",
    "FixFreeShellMode",
    "FixFreeFaceMode",
    "FixFreeWireMode",
)
"""The steps by which the kernel's reader repairs shapes."""

Color = tuple[float, float, float]
NamedShape = tuple[str, TopoDS_Shape, Color | None]


def write_step(
    path: str | os.PathLike[str], shapes: Sequence[NamedShape], *, title: str, schema: Schema = "AP242"
) -> None:
    """Write a flat assembly, one product a shape with its name and colour, whole or not at all.

    Arguments:
        path: the file; an existing one is replaced once the new one is complete.
        shapes: name, a solid or an open shell that cadpanel built, sRGB colour with components in 0 to 1 or None.
            Names must differ.
        title: name of the assembly.
        schema: "AP242" or "AP214".

    Raises:
        DeliveryError: if the file cannot be written, or a shape has other than plane, cone and cylinder faces.
    """
    target = Path(path)
    try:
        text = step_file(shapes, title, schema)
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
    with step_shapes(path, heal=heal) as shapes:
        return shapes


@contextmanager
def step_shapes(path: str | os.PathLike[str], *, heal: bool = False) -> Iterator[list[tuple[str, TopoDS_Shape]]]:
    """The same, and the kernel's reader is kept for as long as the shapes are worked on.

    It holds hundreds of thousands of small objects. Once they are given back, memory is in so many pieces that the
    kernel's exact check takes half as long again.
    """
    target = Path(path)
    if not target.is_file():
        raise DeliveryError(f"{target} cannot be read: there is no such file.")
    silence_kernel()
    reader = _loaded(target)
    if not heal:
        # Only now: reading a file sets them back.
        reader.SetShapeFixParameters(_no_healing())
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    if not reader.Transfer(document):
        raise DeliveryError(f"{target} cannot be read: it holds no shapes.")
    yield _named_shapes(document)


def _loaded(target: Path) -> STEPCAFControl_Reader:
    """A reader of names and shapes that has read the file and found it sound."""
    reader = STEPCAFControl_Reader()
    for switch in (reader.SetColorMode, reader.SetLayerMode, reader.SetPropsMode, reader.SetGDTMode, reader.SetMatMode):
        switch(False)
    reader.SetNameMode(True)
    if reader.ReadFile(str(target)) != IFSelect_RetDone:
        raise DeliveryError(f"{target} cannot be read: it is not a complete STEP file.")
    fault = damage(reader.Reader().StepModel())
    if fault is not None:
        raise DeliveryError(f"{target} cannot be read: it is damaged ({fault}).")
    return reader


def _named_shapes(document: TDocStd_Document) -> list[tuple[str, TopoDS_Shape]]:
    """The parts of the document's assemblies, and what stands alone in it."""
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    free = TDF_LabelSequence()
    tool.GetFreeShapes(free)
    found: list[tuple[str, TopoDS_Shape]] = []
    for label in _labels(free):
        if XCAFDoc_ShapeTool.IsAssembly_s(label):
            components = TDF_LabelSequence()
            XCAFDoc_ShapeTool.GetComponents_s(label, components)
            found += [(_component_name(part), XCAFDoc_ShapeTool.GetShape_s(part)) for part in _labels(components)]
        else:
            found.append((_name(label), XCAFDoc_ShapeTool.GetShape_s(label)))
    return found


def _no_healing() -> Resource_DataMapOfAsciiStringAsciiString:
    parameters = Resource_DataMapOfAsciiStringAsciiString()
    for mode in HEALING_MODES:
        parameters.Bind(TCollection_AsciiString(f"FixShape.{mode}"), TCollection_AsciiString("0"))
    return parameters


def _labels(sequence: TDF_LabelSequence) -> list[TDF_Label]:
    return [sequence.Value(index) for index in range(1, sequence.Length() + 1)]


def _component_name(component: TDF_Label) -> str:
    """The product's name, which is what the fabricator sees; the instance's may be a mere number."""
    product = TDF_Label()
    if XCAFDoc_ShapeTool.GetReferredShape_s(component, product):
        return _name(product)
    return _name(component)


def _name(label: TDF_Label) -> str:
    attribute = TDataStd_Name()
    if not label.FindAttribute(TDataStd_Name.GetID_s(), attribute):
        return ""
    return str(attribute.Get().ToExtString())
