"""What an output of a delivery is: which files it writes, and how; and how they are held against the report."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from cadpanel.delivery.contents import Contents, Proof

if TYPE_CHECKING:  # the kernel takes seconds to load, and a refusal asks for names only
    from cadpanel.delivery.sheets import PanelSheet
    from cadpanel.fitting.result import FitResult


@dataclass(frozen=True, slots=True, kw_only=True)
class Delivery(Contents):
    """What outputs are made of.

    Attributes:
        panels: the sheets that are delivered, as they were built.
        result: the fit that they come from; None where no file shows what only a fit knows.
    """

    panels: tuple[PanelSheet, ...]
    result: FitResult | None = None


class Output(ABC):
    """One output; a kind of output is one subclass.

    Modules of outputs load without the CAD kernel: what needs it is imported when something is written.

    Attributes:
        name: what it is called.
        files: the names of all files that it may write; --overwrite deletes these and no others.
        folders: of those that it may write, each with the bytes that every file in it begins with.
        always: whether every delivery has it.
        unasked: whether a delivery has it where nothing else is asked for.
        needs: the packages that it needs besides, an extra of the same name as the output.
        tells_joints: whether it tells how wide joints are, which is measured on the other files: it is written last.
    """

    name: str
    files: tuple[str, ...]
    folders: Mapping[str, bytes] = MappingProxyType({})
    always: bool = False
    unasked: bool = True
    needs: tuple[str, ...] = ()
    tells_joints: bool = False

    @abstractmethod
    def write(self, folder: Path, delivery: Delivery) -> None:
        """Write the files into a folder that is there.

        Raises:
            DeliveryError: one of them cannot be written.
        """

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """Hold the files against what they should tell; STEP files are proved by the certificate.

        Raises:
            DeliveryError: one of them is missing or cannot be read.
        """
        del folder, contents
        return Proof()
