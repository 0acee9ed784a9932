"""The shape features that have a name; a new one is one line here."""

from __future__ import annotations

from cadpanel.errors import SettingsError
from cadpanel.features.feature import Feature, Tilt
from cadpanel.features.patches import Cone, Cylinder, Patch, Plane

CATALOGUE: dict[str, tuple[Patch, ...]] = {
    "plane-cone-plane": (Plane(), Cone(), Plane()),
    "plane-cylinder-plane": (Plane(), Cylinder(), Plane()),
}


def feature(name: str, *, tilt: Tilt = "free") -> Feature:
    """The feature of that name in the catalogue.

    Raises:
        SettingsError: no feature has that name; the message lists those that exist.
    """
    if name not in CATALOGUE:
        raise SettingsError(f"there is no feature '{name}'; choose one of: {', '.join(sorted(CATALOGUE))}")
    return Feature(name, CATALOGUE[name], tilt)
