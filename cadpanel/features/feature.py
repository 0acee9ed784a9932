"""A shape feature: a chain of patches, walked from a ruling in its middle patch, cut by one plane at either end."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Self, get_args

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.chain_shapes import chain_shapes
from cadpanel.features.independence import refuse_dependent
from cadpanel.features.numbers import Number
from cadpanel.features.panel_edges import Edge, chain_edges
from cadpanel.features.patch_checks import check_patch
from cadpanel.features.patches import Patch
from cadpanel.features.placed import Placed
from cadpanel.features.rulings import Cuts, Points, Walk
from cadpanel.features.walk import arc_rulings, end_points, walk
from cadpanel.geometry.shape import PanelShape

MOST_PATCHES = 64

# The anchor ruling sits in the middle of the anchor patch and may move only in ways that change the panel. Sliding it
# along itself changes nothing and is left out.
_ANCHOR = (
    Number("anchor: shift_b", "length"),
    Number("anchor: shift_n", "length"),
    Number("anchor: turn_b", "slope"),
    Number("anchor: turn_t", "slope"),
    Number("anchor: turn_n", "slope"),
)


@dataclass(frozen=True, init=False)
class Feature:
    """A chain of patches with tangent continuity, and the numbers that describe it.

    Attributes:
        patches: the patches in the order of the walk, from side 0 to side 1.
        name: as reports call it; by default the kinds of its patches.
        cuts: how the planes lie that cut the two ends:
            "mitre": each tilts freely (3 numbers an end);
            "upright": each may turn about the panel's normal, as in the paper's trimming (2 numbers an end);
            "parallel": both have one normal, which is free (4 numbers together);
            "square": both stand square on the ruling in the middle (1 number an end).
            Tilting about its own line does nothing to a flat panel, so there "mitre" is "upright".
        anchor: index of the patch in whose middle the walk starts; lengths and angles stay well scaled there.
        numbers: all numbers in the order: anchor, patches, cut of end 0, cut of end 1; lengths in mm until `in_units`.
        free: indices of the numbers that the fit may choose.
        tied: pairs of indices (number, the number whose value it takes).
        own_numbers: for each patch where its numbers stand among `numbers`.
    """

    patches: tuple[Patch, ...]
    name: str
    cuts: Cuts
    anchor: int
    numbers: tuple[Number, ...] = field(repr=False)
    free: IntArray = field(repr=False, compare=False)
    tied: tuple[tuple[int, int], ...] = field(repr=False)
    own_numbers: tuple[slice, ...] = field(repr=False, compare=False)

    def __init__(self, *patches: Patch, name: str | None = None, cuts: Cuts = "mitre") -> None:
        """Lay out the numbers, and refuse a chain in which some of them depend on the others.

        Raises:
            SettingsError: there is no patch, one lacks what the package asks of it, a number is none, or numbers
                depend on each other; the message names them.
        """
        if not 1 <= len(patches) <= MOST_PATCHES:
            raise SettingsError(f"a feature has between 1 and {MOST_PATCHES} patches, not {len(patches)}")
        for patch in patches:
            check_patch(patch)
        word: object = name
        if word is not None and not (isinstance(word, str) and word.strip() and word.isprintable()):
            raise SettingsError(f"the name of a feature must be a word that can be printed, not {name!r}")
        if cuts not in get_args(Cuts):
            raise SettingsError(f"the cuts of a feature must be one of {', '.join(get_args(Cuts))}, not '{cuts}'")
        set_ = object.__setattr__
        set_(self, "patches", tuple(patches))
        set_(self, "name", name or "-".join(patch.kind for patch in patches))
        set_(self, "cuts", cuts)
        curved = [i for i, patch in enumerate(patches) if patch.kind != "plane"]
        middle = (len(patches) - 1) / 2
        set_(self, "anchor", min(curved or range(len(patches)), key=lambda i: abs(i - middle)))
        numbers = [*_ANCHOR, *(number.within(i) for i, patch in enumerate(patches) for number in patch.numbers())]
        tilts = cuts in ("mitre", "parallel") and bool(curved)
        for end in (0, 1):
            numbers += [
                Number(f"cut {end}: position", "length"),
                Number(f"cut {end}: skew", "slope", 0.0 if cuts == "square" else None),
                Number(f"cut {end}: tilt", "slope", None if tilts else 0.0),
            ]
        count = len(numbers)
        tied = tuple((count - 3 + i, count - 6 + i) for i in (1, 2)) if cuts == "parallel" else ()
        set_(self, "numbers", tuple(numbers))
        stops = np.cumsum([len(_ANCHOR), *(len(patch.numbers()) for patch in patches)]).tolist()
        set_(self, "own_numbers", tuple(slice(*pair) for pair in pairwise(stops)))
        set_(self, "tied", tuple(pair for pair in tied if numbers[pair[1]].fixed is None))
        bound = {number for number, _ in self.tied}
        free = [i for i, number in enumerate(numbers) if number.fixed is None and i not in bound]
        set_(self, "free", np.array(free, dtype=np.intp))
        refuse_dependent(self)
        if len(patches) > 1 and not curved:
            raise SettingsError(f"the {len(patches)} planes of '{self.name}' are one, as nothing bends between them")

    @cached_property
    def curved(self) -> tuple[bool, ...]:
        """For each patch whether it is a cone or cylinder."""
        return tuple(patch.kind != "plane" for patch in self.patches)

    @property
    def edges(self) -> tuple[Edge, ...]:
        """End 0, end 1, side 0 and side 1."""
        return chain_edges(self.curved)

    @property
    def corner_count(self) -> int:
        """Number of corners."""
        return 2 * (len(self.patches) + 1)

    @property
    def cut_numbers(self) -> IntArray:
        """(2, 3) where position, skew and tilt of both cut planes stand among `numbers`."""
        return np.arange(len(self.numbers) - 6, len(self.numbers), dtype=np.intp).reshape(2, 3)

    @property
    def four_sided(self) -> bool:
        """A chain has two ends and two sides."""
        return True

    def in_units(self, length: float) -> Self:
        """The same feature with lengths counted in units of `length` mm."""
        scaled = copy.copy(self)
        object.__setattr__(scaled, "numbers", tuple(number.in_units(length) for number in self.numbers))
        return scaled

    def patch_slice(self, patch: int) -> slice:
        """Where the numbers of one patch stand among `numbers`."""
        return self.own_numbers[patch]

    def expand(self, unknowns: Array) -> Array:
        """(n, numbers) all numbers from the (n, free) unknowns; fixed and tied ones take their values."""
        values = np.empty((len(unknowns), len(self.numbers)))
        values[:, :] = [0.0 if number.fixed is None else number.fixed for number in self.numbers]
        values[:, self.free] = unknowns
        for number, source in self.tied:
            values[:, number] = values[:, source]
        return values

    def by_unknowns(self, derivatives: Array) -> Array:
        """Derivatives (..., free) by the unknowns, from those (..., numbers) by all numbers."""
        if len(self.free) == len(self.numbers):
            return derivatives
        chosen: Array = derivatives[..., self.free]
        for number, source in self.tied:
            chosen[..., np.searchsorted(self.free, source)] += derivatives[..., number]
        return chosen

    def bounds(self) -> tuple[Array, Array]:
        """(free,) least and greatest values of the unknowns."""
        chosen = [self.numbers[i] for i in self.free]
        return np.array([number.lower for number in chosen]), np.array([number.upper for number in chosen])

    def walk(self, values: Array, *, derivatives: bool) -> Walk:
        """Walk panels with these numbers (n, numbers)."""
        return walk(self, values, derivatives=derivatives)

    def corners(self, walked: Walk) -> Points:
        """The corners (n, corners, 3) of walked panels."""
        return end_points(walked, walked.edges)

    def arcs(self, walked: Walk) -> Points:
        """The arc points (n, arcs, 3) of walked panels."""
        return end_points(walked, arc_rulings(walked))

    def shapes(self, walked: Walk, placed: Placed) -> list[PanelShape]:
        """Walked panels in the coordinates of the reference's file, mm."""
        return chain_shapes(walked, placed)
