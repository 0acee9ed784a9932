"""A STEP file as a document of the kernel: for panels, for parts with all that is said of them, and for the proof."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Check, Interface_Static
from OCP.Resource import Resource_DataMapOfAsciiStringAsciiString
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_AsciiString
from OCP.TColStd import TColStd_SequenceOfAsciiString
from OCP.TDocStd import TDocStd_Document

from cadpanel.brep.files.step_damage import damage
from cadpanel.brep.files.step_lost import Failure
from cadpanel.brep.files.xcaf import new_document
from cadpanel.brep.kernel.messages import silence_kernel

# The kernel's switch for names below products; off by default.
NAMES_OF_FACES = "read.stepcaf.subshapes.name"
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


class StepFault(Exception):
    """A STEP file that the kernel does not take over; says what it holds, empty where it cannot be read at all."""

    @property
    def fault(self) -> str:
        """What is wrong with its data."""
        return str(self)


@dataclass(frozen=True, slots=True)
class StepDocument:
    """A STEP file that is read.

    The reader is kept as long as this is: it holds hundreds of thousands of small objects, and once they are given
    back, memory is in so many pieces that the kernel's exact check takes half as long again.

    Attributes:
        document: what the reader has filled; empty where the file holds no shapes.
        reader: with the file's own data.
    """

    document: TDocStd_Document
    reader: STEPCAFControl_Reader

    @property
    def unit(self) -> str | None:
        """The units of length of the file, in its own words; None where it says none."""
        lengths, angles, solid_angles = (TColStd_SequenceOfAsciiString() for _ in range(3))
        self.reader.Reader().FileUnits(lengths, angles, solid_angles)
        words = {str(lengths.Value(index).ToCString()).lower() for index in range(1, lengths.Length() + 1)}
        return " and ".join(sorted(words)) or None

    def failures(self) -> list[Failure]:
        """Where the kernel could not make a shape; empty where it could make all."""
        checks, found = self.reader.Reader().WS().TransferReader().LastCheckList(), []
        checks.Start()
        while checks.More():
            if checks.Value().HasFailed():
                found.append(Failure(checks.Number(), _first_fail(checks.Value())))
            checks.Next()
        return found


def read_document(path: Path, *, labels: bool, heal: bool = True, properties: bool = False) -> StepDocument:
    """Read a STEP file.

    Args:
        path: the file.
        labels: whether colours, layers and names of faces matter. Without, names of products are all that is read
            beside shapes, which makes the reader as fast as one that knows no names at all.
        heal: whether the kernel may repair what it reads, as it does by default. Without, shapes are what the file
            says, and reading takes less than half the time.
        properties: whether what is said of products besides matters: numbers to check an import by, attributes.

    Raises:
        StepFault: the file is not whole, or its data are damaged.
        Standard_Failure: the kernel gives up.
    """
    silence_kernel()
    reader, document = STEPCAFControl_Reader(), new_document()
    for switch in (
        reader.SetColorMode,
        reader.SetLayerMode,
        reader.SetGDTMode,
        reader.SetMatMode,
        reader.SetViewMode,
        reader.SetSHUOMode,
    ):
        if not labels:
            switch(False)
    reader.SetPropsMode(properties)
    reader.SetMetaMode(properties)
    Interface_Static.SetIVal_s(NAMES_OF_FACES, int(labels))
    try:
        if reader.ReadFile(str(path)) != IFSelect_RetDone:
            raise StepFault
        fault = damage(reader.Reader().StepModel())
        if fault is not None:
            raise StepFault(fault)
        if not heal:
            # Only now: reading a file sets them back.
            reader.SetShapeFixParameters(_no_healing())
        reader.Transfer(document)
    finally:
        Interface_Static.SetIVal_s(NAMES_OF_FACES, 0)
    return StepDocument(document, reader)


def _no_healing() -> Resource_DataMapOfAsciiStringAsciiString:
    parameters = Resource_DataMapOfAsciiStringAsciiString()
    for mode in HEALING_MODES:
        parameters.Bind(TCollection_AsciiString(f"FixShape.{mode}"), TCollection_AsciiString("0"))
    return parameters


def _first_fail(check: Interface_Check) -> str:
    """The first message of a check that has failed."""
    message: str = check.CFail(1)
    return message.strip().rstrip(".")
