"""Mirror symmetry: a panel is the mirror image of another one, so that one drawing and one set-up serve both."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.layout import Layout
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.boundary import boundary_of, places_in
from cadpanel.fitting.rules.rule import Fitted, Outcome, Posed, Rule, places_of
from cadpanel.geometry.vectors import unit
from cadpanel.reference.model import PanelReference, Reference
from cadpanel.setting import require
from cadpanel.terms.limits.limit import Panels
from cadpanel.terms.rules.mirrored import Images, MirrorTerm
from cadpanel.terms.term import HeldTerm

Scalar = TypeVar("Scalar", bound=np.generic)

# Drawn corners that are no mirror images by more than this share of the panel's length are other panels.
_MOST_OFF = 0.1
_MARGIN = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class MirrorRule(Rule):
    """A panel is the mirror image of another one.

    Attributes:
        panel, of: their names.
        point, normal: of the plane between them, in the coordinates of the file, mm; the plane midway between the two
            drawn panels if not given.
        within: how far corners and arcs may be from the image, mm.
    """

    table: ClassVar[str] = "mirror"

    panel: str
    of: str
    point: tuple[float, ...] = ()
    normal: tuple[float, ...] = ()
    within: float = 0.05

    def __post_init__(self) -> None:
        """Refuse what is no plane, or no two panels.

        Raises:
            SettingsError: saying what is wanted.
        """
        require("distance within which a [[mirror]] holds", self.within, least=1e-3, unit=" mm")
        given: tuple[object, ...] = (self.panel, self.of)
        if not all(isinstance(name, str) for name in given) or self.panel == self.of:
            raise SettingsError("a [[mirror]] is about two panels: panel = 'NW-01', of = 'NW-08'")
        for name in ("point", "normal"):
            value = getattr(self, name)
            numbers = tuple(value) if isinstance(value, list | tuple) else (value,)
            for number in numbers:
                require(f"{name} of a [[mirror]]", number, least=-1e9, most=1e9)
            if len(numbers) not in (0, 3):
                raise SettingsError(f"the {name} of a [[mirror]] has three numbers")
            object.__setattr__(self, name, tuple(float(number) for number in numbers))
        if bool(self.point) != bool(self.normal) or (self.normal and not any(self.normal)):
            raise SettingsError("the plane of a [[mirror]] has a point and a normal that is not 0, or neither is given")

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> list[Posed]:
        """See `Rule.pose`."""
        names = [panel.name for panel in reference.panels]
        one, other = ((places_of([word], names, self.table)) for word in (self.panel, self.of))
        if len(one) != 1 or len(other) != 1:
            raise SettingsError("a [[mirror]] is about two panels: write their names without *")
        first, second = sorted((one[0], other[0]))
        a, b = reference.panels[first], reference.panels[second]
        if len(a.edges) != len(b.edges) or not a.four_sided:
            raise SettingsError(f"panels '{a.name}' and '{b.name}' of a [[mirror]] must both have ends and sides")
        point, normal = self._plane(reference, a, b)
        turn, off = _turn(a, b, point, normal)
        if off > _MOST_OFF * a.length:
            raise SettingsError(
                f"the drawing's panels '{a.name}' and '{b.name}' are no mirror images: corners are {off:.0f} mm off; "
                "give the plane between them by point and normal, or leave the [[mirror]] out"
            )
        if features[first].curved != (features[second].curved[::-1] if turn[1] else features[second].curved):
            raise SettingsError(f"panels '{a.name}' and '{b.name}' of a [[mirror]] have features that are no images")
        return [_Mirrored((a.name, b.name), (first, second), point, normal, turn, self.within)]

    def _plane(self, reference: Reference, a: PanelReference, b: PanelReference) -> tuple[Array, Array]:
        if self.normal:
            return np.array(self.point) - np.array(reference.origin), unit(np.array(self.normal))
        middles = [panel.corners.reshape(-1, 3).mean(axis=0) for panel in (a, b)]
        return 0.5 * (middles[0] + middles[1]), unit(middles[0] - middles[1])


def _turn(a: PanelReference, b: PanelReference, point: Array, normal: Array) -> tuple[tuple[bool, bool], float]:
    """Whether the image of b has its ends, and its sides, the other way round than a, and how far it is off then."""
    image = _image(b.corners.reshape(-1, 3), point, normal).reshape(2, 2, 3)
    off = {
        (ends, sides): float(np.linalg.norm(_turned(image, ends=ends, sides=sides) - a.corners, axis=2).max())
        for ends in (False, True)
        for sides in (False, True)
    }
    best = min(off, key=lambda turn: (round(off[turn], 6), turn))
    return best, off[best]


def _image(points: Array, point: Array, normal: Array) -> Array:
    return np.asarray(points - 2.0 * ((points - point) @ normal)[..., None] * normal)


def _turned(values: NDArray[Scalar], *, ends: bool, sides: bool) -> NDArray[Scalar]:
    """Values (2, n, ...) by end and from side to side, the other way round."""
    turned = values[::-1] if ends else values
    return turned[:, ::-1] if sides else turned


class _Mirrored(Posed):
    """Two panels that are mirror images."""

    def __init__(
        self,
        names: tuple[str, str],
        panels: tuple[int, int],
        point: Array,
        normal: Array,
        turn: tuple[bool, bool],
        within: float,
    ) -> None:
        self._names, self._panels, self._within = names, panels, within
        self._point, self._normal, self._turn = point, normal, turn
        self.links = np.array([panels], dtype=np.intp)

    def held(self, panels: Panels, pair_of: Mapping[tuple[int, int], int]) -> list[HeldTerm]:
        """See `Posed.held`."""
        layout, place = panels.layout, panels.place
        first, second = (places_in(layout, panel) for panel in self._panels)
        images = Images(
            first=self.links[:, 0],
            second=self.links[:, 1],
            pair=np.array([pair_of[self._panels]], dtype=np.intp),
            places=np.stack([first[None], second[self._order(layout)][None]]),
            points=((self._point - place.centre) / place.length)[None],
            normals=self._normal[None],
        )
        return [MirrorTerm(images, place, (1.0 - _MARGIN) * self._within / place.length, layout.panels)]

    def _order(self, layout: Layout) -> IntArray:
        feature = layout.feature_of[self._panels[1]]
        return self._ordered(feature.corner_count, len(ARC_SHARES) * sum(feature.curved))

    def _ordered(self, corners: int, arcs: int) -> IntArray:
        """(q,) which point of the second panel is the image of each of the first."""
        ends, sides = self._turn
        parts = (np.arange(corners).reshape(2, -1), corners + np.arange(2 * arcs).reshape(2, -1))
        return np.concatenate([_turned(part, ends=ends, sides=sides).reshape(-1) for part in parts]).astype(np.intp)

    def outcome(self, fitted: Fitted) -> Outcome:
        """See `Posed.outcome`."""
        one, other = (fitted.shapes[panel] for panel in self._panels)
        first, second = boundary_of(one), boundary_of(other)
        corners = int(np.asarray(other.corners()).size // 3)
        order = self._ordered(corners, (len(second) - corners) // 2)
        off = np.linalg.norm(first - _image(second[order], self._point, self._normal), axis=1)
        return Outcome(
            rule=f"{self._names[0]} mirrors {self._names[1]}",
            measure="largest distance",
            found=float(off.max()),
            allowed=self._within,
        )
