"""What everything asks of a fitted panel, whatever its kind, and what the geometry asks of the two that there are.

A kind of panel is one class with the members of `Panel`. Whoever needs more of it than geometry can know, as the CAD
kernel's faces or the rows of a record, has one entry for each class.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Generic, Protocol, Self, TypeGuard, TypeVar, runtime_checkable

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.curve_pieces import CurvePieces
from cadpanel.geometry.patches import Patch

Shape = TypeVar("Shape", bound="Panel")


@dataclass(frozen=True, slots=True, kw_only=True)
class CutPlane:
    """A plane in which a wall of a sheet stands.

    Attributes:
        point: (3,) on it, mm.
        normal: (3,) unit, out of the panel.
        jointed: whether half of a joint lies between it and the plane of its seam.
    """

    point: Array
    normal: Array
    jointed: bool = False

    def beyond(self, points: Array) -> Array:
        """How far points (..., 3) lie beyond it, mm (...)."""
        return np.asarray((points - self.point) @ self.normal)

    def moved(self, distance: float) -> CutPlane:
        """The parallel plane that many mm farther out."""
        return replace(self, point=self.point + distance * self.normal)


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelEdge:
    """One edge of a panel's skin, and which way it goes on beyond it.

    Attributes:
        corners: (m, 3) along it, mm.
        outward: (3,) unit normal of the plane in which the fit has cut it, out of the panel.
        normal: (3,) the skin's unit normal along it, None where the edge bends with the skin: then the cut plane is the
            fit's, else the edge is straight and any plane through it will do.
    """

    corners: Array
    outward: Array
    normal: Array | None


@runtime_checkable
class Panel(Protocol):
    """A panel's skin, exact, in millimetres and radians; what a fit hands to solids, reports and measures.

    Attributes:
        name: the panel's stable name.
        feature: name of the shape feature.
        patches: of its skin, in the order of the walk.
        four_sided: whether it has two ends and two sides, along both of which `corners` gives a row.
        square: whether the walls of its sheet stand square to it, as a laser cuts them; else its ends stand in their
            cut planes, and other walls lean as they do.
    """

    @property
    def name(self) -> str: ...  # noqa: D102 - the class says it

    @property
    def feature(self) -> str: ...  # noqa: D102

    @property
    def patches(self) -> tuple[Patch, ...]: ...  # noqa: D102

    @property
    def four_sided(self) -> bool: ...  # noqa: D102

    @property
    def square(self) -> bool: ...  # noqa: D102

    def corners(self) -> Array:
        """(2, k + 1, 3) the corners along both ends, or (1, n, 3) all round, mm."""
        ...

    def rulings(self) -> tuple[Array, Array, Array]:
        """Points in mm, unit directions and unit normals (k + 1, 3) of the rulings that bound its k patches.

        Of a panel with edges all round that of its one plane, (1, 3) each.
        """
        ...

    def cuts(self) -> tuple[Array, Array]:
        """Points in mm and unit normals (2, 3) of the planes that cut its two ends; (0, 3) where it has none."""
        ...

    def area(self) -> float:
        """Area of the trimmed skin, mm2. The panel must be buildable."""
        ...

    def offset(self, distance: float) -> Self:
        """The parallel skin at `distance` mm outwards (negative: inwards), on the other face of a sheet."""
        ...

    def edge(self, edge: str) -> PanelEdge:
        """One edge: "end 0", "end 1", "side 0", "side 1", or "edge 0" and so on.

        Raises:
            ValueError: the panel has no such edge.
        """
        ...

    def arcs(self) -> CurvePieces:
        """The bent pieces of its outline; all others run straight from corner to corner."""
        ...

    def cut_back(self, planes: Mapping[str, CutPlane], depth: float) -> Self:
        """The panel with the walls of its sheet in these planes, edge by edge; the other walls stay as they are.

        Args:
            planes: by edge.
            depth: the sheet's other face is `offset(depth)`, mm.

        Raises:
            PanelError: nothing is left of it.
        """
        ...

    def squared(self, depth: float) -> Self:
        """The panel with walls square to the sheet, inside of those that it has: the shorter face of each edge rules.

        Args:
            depth: the sheet's other face is `offset(depth)`, mm.

        Raises:
            PanelError: nothing is left of it.
        """
        ...

    def straightened(self) -> Straightened[Self]:
        """The panel as it is built: cones that are all but cylinders made cylinders."""
        ...

    def check(self) -> None:
        """Refuse a skin that cannot be built exactly.

        Raises:
            PanelError: with one reason and a remedy.
        """
        ...

    def check_sheet(self, away: Self, thickness: float) -> None:
        """Refuse a skin that passes, but not with a sheet of `thickness` mm whose other face is `away`.

        Raises:
            PanelError: with one reason and a remedy.
        """
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Straightened(Generic[Shape]):
    """A panel with its tiny half angles taken out.

    Attributes:
        shape: the panel as it is built.
        patches: indices of the patches that became cylinders; empty if nothing was changed.
        largest_move: how far the farthest corner moved, mm.
    """

    shape: Shape
    patches: tuple[int, ...]
    largest_move: float


@runtime_checkable
class Chain(Protocol):
    """Patches between rulings, cut by a plane at either end; see `PanelShape`."""

    @property
    def name(self) -> str: ...  # noqa: D102

    @property
    def patches(self) -> tuple[Patch, ...]: ...  # noqa: D102

    @property
    def points(self) -> Array: ...  # noqa: D102

    @property
    def directions(self) -> Array: ...  # noqa: D102

    @property
    def normals(self) -> Array: ...  # noqa: D102

    @property
    def cut_points(self) -> Array: ...  # noqa: D102

    @property
    def cut_normals(self) -> Array: ...  # noqa: D102

    @property
    def side_leans(self) -> Array: ...  # noqa: D102

    @property
    def side_planes(self) -> tuple[CutPlane | None, CutPlane | None]: ...  # noqa: D102

    @property
    def lift(self) -> float: ...  # noqa: D102

    def corners(self) -> Array: ...  # noqa: D102

    def pierced(self) -> Array: ...  # noqa: D102

    def offset(self, distance: float) -> Self: ...  # noqa: D102

    def binormals(self) -> Array: ...  # noqa: D102

    def rewalked(self, points: Array, directions: Array, normals: Array, patches: tuple[Patch, ...]) -> Self: ...  # noqa: D102

    def trimmed(self, cut_points: Array, cut_normals: Array, side_leans: Array) -> Self: ...  # noqa: D102

    def walled(self, side: int, plane: CutPlane | None) -> Self: ...  # noqa: D102

    def made_square(self) -> Self: ...  # noqa: D102


def is_chain(shape: object) -> TypeGuard[Chain]:
    """Whether a panel is a chain, as the first one of its class was: to look for so many members takes 0.1 ms."""
    kind = type(shape)
    if kind not in _CHAINS:
        _CHAINS[kind] = isinstance(shape, Chain)
    return _CHAINS[kind]


_CHAINS: dict[type, bool] = {}


class Outlined(Protocol):
    """Corners round a plane; see `PolygonShape`."""

    @property
    def name(self) -> str: ...  # noqa: D102

    @property
    def outline(self) -> Array: ...  # noqa: D102

    @property
    def normal(self) -> Array: ...  # noqa: D102
