"""A file that came back from another program, held against the delivery that it was made of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from cadpanel.brep.proof.returned_solids import SolidBack, solids_back
from cadpanel.delivery.manifest import MANIFEST, changed_files
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.errors import DeliveryError
from cadpanel.kinds import checked
from cadpanel.reference.settings import file_named

SAME_PLACE = 0.01
"""Distance in mm up to which a solid counts as the one that was delivered."""
SAME_SIZE = 1e-5
"""The same as a part of its volume and of its area."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CameBack:
    """What a file shows of a delivery.

    Attributes:
        solids: the delivered solids that are in it.
        failures: one sentence for everything that does not agree.
    """

    solids: tuple[SolidBack, ...]
    failures: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """Whether every solid is there, and no other one."""
        return not self.failures


@checked
def check_returned(file: str | Path, delivery: str | Path) -> CameBack:
    """Find a delivery's solids in a file that another program wrote, by where they lie.

    Names, order and units of the file do not matter.

    Args:
        file: STEP, or another format that can be read.
        delivery: the folder that `deliver` wrote.

    Raises:
        DeliveryError: the delivery is not whole, or its panels.step is not the one that was delivered.
        ReferenceFileError: a file cannot be read.
    """
    path, folder = file_named(file, "file that came back"), Path(delivery)
    if not (folder / PANELS).is_file() or not (folder / MANIFEST).is_file():
        raise DeliveryError(f"'{delivery}' is no delivery: name a folder that 'cadpanel fit' wrote.")
    if PANELS in changed_files(folder):
        raise DeliveryError(f"'{folder / PANELS}' is not the file that was delivered: write the delivery again.")
    found = solids_back(path, folder / PANELS)
    failures = [f"Panel '{name}' is missing in '{path.name}'." for name in found.missing]
    failures += [f"'{path.name}' holds a solid '{called}' that was not delivered." for called in found.strange]
    failures += [fault for solid in found.found for fault in _faults(solid)]
    return CameBack(solids=found.found, failures=tuple(failures))


def _faults(solid: SolidBack) -> Iterator[str]:
    name = f"Panel '{solid.name}'" + (f" ('{solid.called}' there)" if solid.called not in ("", solid.name) else "")
    if not solid.valid:
        yield f"{name} is no valid solid any more."
    if not solid.apart <= SAME_PLACE:
        yield f"{name} lies up to {solid.apart:.3g} mm off."
    if not abs(solid.volume) <= SAME_SIZE:
        yield f"{name} has a volume that differs by {solid.volume:.3g} of its own."
    if not abs(solid.area) <= SAME_SIZE:
        yield f"{name} has an area that differs by {solid.area:.3g} of its own."
