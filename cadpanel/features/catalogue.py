"""The shape features that have a name; a new one is one line here."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Literal

from cadpanel.errors import SettingsError
from cadpanel.features.feature import MOST_PATCHES, Feature
from cadpanel.features.patches import Cone, Cylinder, Patch, Plane
from cadpanel.features.polygon import Polygon
from cadpanel.features.rulings import Cuts, PanelFeature

Tilt = Literal["free", "fixed"]

POLYGON = "planar-polygon"
AUTO = "auto"


@dataclass(frozen=True, slots=True)
class Entry:
    """A feature of the catalogue.

    Attributes:
        patches: in the order of the walk.
        cuts: how its ends are cut.
        picture: its section across the panel, in text.
        use: what it is for, in a few words.
    """

    patches: tuple[Patch, ...]
    cuts: Cuts
    picture: str
    use: str


CATALOGUE: dict[str, Entry] = {
    "planar-rectangle": Entry((Plane(turn=0.0),), "square", "____", "flat sheet with four right angles"),
    "planar-quadrilateral": Entry((Plane(),), "upright", "____", "flat sheet with four corners"),
    "cylinder-parallel": Entry((Cylinder(),), "parallel", "(  ", "rolled sheet, both ends cut alike"),
    "cylinder": Entry((Cylinder(),), "mitre", "(  ", "rolled sheet, each end cut at its own slant"),
    "cone": Entry((Cone(),), "mitre", "(  ", "tapered rolled sheet"),
    "plane-cylinder-plane": Entry((Plane(), Cylinder(), Plane()), "mitre", "__(__", "a fold of constant radius"),
    "plane-cone-plane": Entry((Plane(), Cone(), Plane()), "mitre", "__(__", "a fold that widens: roof edges, lips"),
    "tri-cone": Entry((Cone(), Cone(), Cone()), "mitre", "(((", "a bend whose radius changes"),
    "plane-cone-cone-plane": Entry((Plane(), Cone(), Cone(), Plane()), "mitre", "__((__", "a fold of two radii"),
    "plane-cone-plane-cone-plane": Entry(
        (Plane(), Cone(), Plane(), Cone(), Plane()), "mitre", "__(__(__", "a double fold: gutters, soffits, Z profiles"
    ),
}
_SPLINE = re.compile(r"cone-spline-(\d+)")


def feature(name: str, *, tilt: Tilt = "free") -> Feature:
    """The chain of that name in the catalogue, or "cone-spline-K" for K cones, which follow any developable strip.

    Args:
        name: the name.
        tilt: "fixed" holds mitred cuts upright, as the paper's trimming does.

    Raises:
        SettingsError: no feature has that name; the message lists those that exist.
    """
    if tilt not in ("free", "fixed"):
        raise SettingsError(f"tilt must be 'free' or 'fixed', not '{tilt}'")
    return _feature(name, tilt)


@cache
def _feature(name: str, tilt: Tilt) -> Feature:
    spline = _SPLINE.fullmatch(name)
    if spline is not None:
        cones = int(spline.group(1))
        if not 1 <= cones <= MOST_PATCHES:
            raise SettingsError(f"a cone spline has between 1 and {MOST_PATCHES} cones, not {cones}")
        return Feature(*cones * [Cone()], name=name, cuts=_cuts("mitre", tilt))
    if name not in CATALOGUE:
        names = [*sorted(CATALOGUE), POLYGON, "cone-spline-K (K cones)", AUTO]
        raise SettingsError(f"there is no feature '{name}'; choose one of: {', '.join(names)}")
    entry = CATALOGUE[name]
    return Feature(*entry.patches, name=name, cuts=_cuts(entry.cuts, tilt))


def _cuts(cuts: Cuts, tilt: Tilt) -> Cuts:
    return "upright" if cuts == "mitre" and tilt == "fixed" else cuts


def for_corners(name: str, *, tilt: Tilt = "free") -> Callable[[int], PanelFeature]:
    """The feature of that name for a panel with so many corners: polygons have as many as their panel.

    Raises:
        SettingsError: no feature has that name.
    """
    if name == POLYGON:
        return polygon
    chain = feature(name, tilt=tilt)
    return lambda _corners: chain


@cache
def polygon(corners: int) -> PanelFeature:
    """The flat sheet with so many corners; with four it is a chain, whose sides can be told from its ends."""
    if corners == 4:
        return Feature(Plane(), name=POLYGON, cuts="upright")
    return Polygon(corners)
