"""What everything asks of a fitted panel, whatever its kind, and what the geometry asks of the two that there are.

A kind of panel is one class with the members of `Panel`. Whoever needs more of it than geometry can know, as the CAD
kernel's faces or the rows of a record, has one entry for each class.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Protocol, Self, TypeVar, runtime_checkable

from cadpanel.arrays import Array
from cadpanel.geometry.patches import Patch

Shape = TypeVar("Shape", bound="Panel")


class Panel(Protocol):
    """A panel's skin, exact, in millimetres and radians; what a fit hands to solids, reports and measures.

    Attributes:
        name: the panel's stable name.
        feature: name of the shape feature.
        patches: of its skin, in the order of the walk.
        four_sided: whether it has two ends and two sides, along both of which `corners` gives a row.
    """

    @property
    def name(self) -> str: ...  # noqa: D102 - the class says it

    @property
    def feature(self) -> str: ...  # noqa: D102

    @property
    def patches(self) -> tuple[Patch, ...]: ...  # noqa: D102

    @property
    def four_sided(self) -> bool: ...  # noqa: D102

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

    def corners(self) -> Array: ...  # noqa: D102

    def binormals(self) -> Array: ...  # noqa: D102

    def rewalked(self, points: Array, directions: Array, normals: Array, patches: tuple[Patch, ...]) -> Self: ...  # noqa: D102


class Outlined(Protocol):
    """Corners round a plane; see `PolygonShape`."""

    @property
    def name(self) -> str: ...  # noqa: D102

    @property
    def outline(self) -> Array: ...  # noqa: D102

    @property
    def normal(self) -> Array: ...  # noqa: D102
