"""What an output of a delivery is: which files it writes, and how."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cadpanel.delivery.settings import SheetSettings

if TYPE_CHECKING:
    from cadpanel.delivery.sheets import (
        PanelSheet,  # the kernel takes seconds to load, and a refusal asks for names only
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Delivery:
    """What outputs are made of.

    Attributes:
        panels: the sheets as they were built.
        title: the reference's name without its ending.
        sheet: thickness, side and schema.
    """

    panels: tuple[PanelSheet, ...]
    title: str
    sheet: SheetSettings


class Output(ABC):
    """One output; a kind of output is one subclass.

    Modules of outputs load without the CAD kernel: what needs it is imported when something is written.

    Attributes:
        name: what it is called.
        files: the names of all files that it may write; --overwrite deletes these and no others.
        always: whether every delivery has it.
    """

    name: str
    files: tuple[str, ...]
    always: bool = False

    @abstractmethod
    def write(self, folder: Path, delivery: Delivery) -> None:
        """Write the files into a folder that is there.

        Raises:
            DeliveryError: one of them cannot be written.
        """
