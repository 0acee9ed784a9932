"""What walking a feature gives: rulings, points, and how both follow the numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import wraps
from typing import Any, Literal, Protocol, Self, TypeVar, runtime_checkable

from cadpanel.arrays import Array, IntArray
from cadpanel.features.numbers import Number
from cadpanel.features.panel_edges import Edge
from cadpanel.features.patches import Dimensions, Patch
from cadpanel.features.placed import Placed
from cadpanel.geometry.panel import Panel

Cuts = Literal["mitre", "upright", "parallel", "square"]
Found = TypeVar("Found")


@runtime_checkable
class PanelFeature(Protocol):
    """What fits, terms and seams ask of anything that can be fitted to one panel: a chain or a polygon.

    Attributes:
        name: as reports call it.
        patches: in the order of the walk.
        cuts: how the planes lie that cut the ends.
        cut_numbers: (ends, 3) where position, skew and tilt of each cut plane stand among `numbers`; (0, 3) for what
            has no ends.
        anchor: index of the patch in whose middle the walk starts.
        numbers: all numbers.
        free: (free,) indices of the numbers that the fit may choose.
        curved: for each patch whether it is a cone or cylinder.
        edges: the boundary, edge by edge.
        corner_count: number of corners.
        four_sided: whether the edges are end 0, end 1, side 0 and side 1, and the corners those along either end.
    """

    @property
    def name(self) -> str: ...  # noqa: D102 - the class says it

    @property
    def patches(self) -> tuple[Patch, ...]: ...  # noqa: D102

    @property
    def cuts(self) -> Cuts: ...  # noqa: D102

    @property
    def cut_numbers(self) -> IntArray: ...  # noqa: D102

    @property
    def anchor(self) -> int: ...  # noqa: D102

    @property
    def numbers(self) -> tuple[Number, ...]: ...  # noqa: D102

    @property
    def free(self) -> IntArray: ...  # noqa: D102

    @property
    def curved(self) -> tuple[bool, ...]: ...  # noqa: D102

    @property
    def edges(self) -> tuple[Edge, ...]: ...  # noqa: D102

    @property
    def corner_count(self) -> int: ...  # noqa: D102

    @property
    def four_sided(self) -> bool: ...  # noqa: D102

    def in_units(self, length: float) -> Self:
        """The same feature with lengths counted in units of `length` mm."""
        ...

    def patch_slice(self, patch: int) -> slice:
        """Where the numbers of one patch stand among `numbers`; empty where it has none of its own."""
        ...

    def expand(self, unknowns: Array) -> Array:
        """(n, numbers) all numbers from the (n, free) unknowns."""
        ...

    def by_unknowns(self, derivatives: Array) -> Array:
        """Derivatives (..., free) by the unknowns, from those (..., numbers) by all numbers."""
        ...

    def bounds(self) -> tuple[Array, Array]:
        """(free,) least and greatest values of the unknowns."""
        ...

    def walk(self, values: Array, *, derivatives: bool) -> Walk:
        """Walk panels with these numbers (n, numbers)."""
        ...

    def corners(self, walked: Walk) -> Points:
        """The corners (n, corners, 3) of walked panels."""
        ...

    def arcs(self, walked: Walk) -> Points:
        """The arc points (n, arcs, 3) of walked panels."""
        ...

    def shapes(self, walked: Walk, placed: Placed) -> Sequence[Panel]:
        """Walked panels in the coordinates of the reference's file, mm."""
        ...


@dataclass(frozen=True, slots=True)
class Rulings:
    """n x R ruling frames and their twists.

    Attributes:
        frames: (panels, R, 4, 3) rows b, t, n and p of each.
        twist: (panels, R, 6, N) for the N numbers of the feature, or None where no derivatives were asked for.
    """

    frames: Array
    twist: Array | None

    @property
    def b(self) -> Array:
        """(panels, R, 3) the binormals."""
        return self.frames[:, :, 0]

    @property
    def t(self) -> Array:
        """(panels, R, 3) the directions."""
        return self.frames[:, :, 1]

    @property
    def n(self) -> Array:
        """(panels, R, 3) the skin's normals."""
        return self.frames[:, :, 2]

    @property
    def p(self) -> Array:
        """(panels, R, 3) a point on each."""
        return self.frames[:, :, 3]

    def at(self, rulings: IntArray | slice) -> Rulings:
        """Some of the rulings."""
        return Rulings(self.frames[:, rulings], None if self.twist is None else self.twist[:, rulings])

    def of(self, panels: slice) -> Rulings:
        """Those of some of the panels."""
        return Rulings(self.frames[panels], None if self.twist is None else self.twist[panels])


@dataclass(frozen=True, slots=True)
class Walk:
    """A batch of panels, walked.

    Attributes:
        feature: the feature of all these panels.
        values: (panels, N) all numbers, the fixed ones included.
        dimensions: those of the patches that have numbers of their own.
        anchor: the ruling in the middle of the anchor patch (R = 1).
        edges: the k + 1 rulings that bound the patches, from side 0 to side 1.
        carriers: per patch the ruling that its radius is measured at (R = k).
        kept: what was worked out of the walk, see `once`.
    """

    feature: PanelFeature
    values: Array
    dimensions: tuple[Dimensions, ...]
    anchor: Rulings
    edges: Rulings
    carriers: Rulings
    kept: dict[Callable[..., object], Any] = field(default_factory=dict, init=False, repr=False, compare=False)


def once(function: Callable[[Walk], Found]) -> Callable[[Walk], Found]:
    """Work something out of a walk when it is first asked for, and keep it with the walk: several terms ask.

    Nobody may write into it.
    """

    @wraps(function)
    def kept(walked: Walk) -> Found:
        if function not in walked.kept:
            walked.kept[function] = function(walked)
        found: Found = walked.kept[function]
        return found

    return kept


@dataclass(frozen=True, slots=True)
class Points:
    """Points of the panels that follow the numbers.

    Attributes:
        position: (panels, R, 3).
        jacobian: (panels, R, 3, N) or None without derivatives.
    """

    position: Array
    jacobian: Array | None
