"""A shape feature: a chain of patches, walked from a ruling in its middle patch, cut by one plane at either end."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cadpanel.errors import SettingsError
from cadpanel.features.numbers import Number
from cadpanel.features.patches import Patch

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]

Tilt = Literal["free", "fixed"]

# The anchor ruling sits in the middle of the anchor patch and may move only in ways that change the panel. Sliding it
# along itself, and for a plane anything within the plane, changes nothing; those motions are left out.
_CURVED_ANCHOR = (
    Number("anchor: shift_b", "length"),
    Number("anchor: shift_n", "length"),
    Number("anchor: turn_b", "slope"),
    Number("anchor: turn_t", "slope"),
    Number("anchor: turn_n", "slope"),
)


@dataclass(frozen=True)
class Feature:
    """A chain of patches with tangent continuity, and the numbers that describe it.

    Attributes:
        name: its name in the catalogue, for example "plane-cone-plane".
        patches: the patches in the order of the walk.
        tilt: "free" lets both cut planes tilt (mitre, 3 numbers an end); "fixed" holds them upright on the panel as the
            paper's trimming does (2 numbers an end).
        anchor: index of the patch in whose middle the walk starts; lengths and angles stay well scaled there.
        numbers: all numbers in the order: anchor, patches, cut of end 0, cut of end 1.
        free: indices of the numbers that the fit may choose.
    """

    name: str
    patches: tuple[Patch, ...]
    tilt: Tilt = "free"
    anchor: int = field(init=False)
    numbers: tuple[Number, ...] = field(init=False)
    free: IntArray = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Choose the anchor and lay out the numbers."""
        if self.tilt not in ("free", "fixed"):
            raise SettingsError(f"tilt must be 'free' or 'fixed', not '{self.tilt}'")
        middle = (len(self.patches) - 1) / 2
        curved = [i for i, patch in enumerate(self.patches) if patch.kind != "plane"]
        if not curved:
            raise SettingsError(f"feature '{self.name}' has no cone or cylinder; flat panels are not supported yet")
        object.__setattr__(self, "anchor", min(curved, key=lambda i: abs(i - middle)))
        numbers = [*_CURVED_ANCHOR]
        for i, patch in enumerate(self.patches):
            numbers += [Number(f"patch {i}: {number.name}", number.unit, number.fixed) for number in patch.numbers()]
        for end in (0, 1):
            numbers += [
                Number(f"cut {end}: position", "length"),
                Number(f"cut {end}: skew", "slope"),
                Number(f"cut {end}: tilt", "slope", None if self.tilt == "free" else 0.0),
            ]
        object.__setattr__(self, "numbers", tuple(numbers))
        object.__setattr__(self, "free", np.array([i for i, n in enumerate(numbers) if n.fixed is None], dtype=np.intp))

    def patch_slice(self, patch: int) -> slice:
        """Where the numbers of one patch stand among `numbers`."""
        start = len(_CURVED_ANCHOR) + sum(len(other.numbers()) for other in self.patches[:patch])
        return slice(start, start + len(self.patches[patch].numbers()))

    def cut_slice(self, end: int) -> slice:
        """Where position, skew and tilt of one cut plane stand among `numbers`."""
        start = len(self.numbers) - 6 + 3 * end
        return slice(start, start + 3)

    def expand(self, unknowns: Array) -> Array:
        """(n, numbers) all numbers from the (n, free) unknowns; the fixed ones take their values."""
        values = np.empty((len(unknowns), len(self.numbers)))
        values[:, :] = [0.0 if number.fixed is None else number.fixed for number in self.numbers]
        values[:, self.free] = unknowns
        return values
