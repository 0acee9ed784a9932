"""What a report says that nothing in its folder can prove, by the words of people and by the report's keys."""

from __future__ import annotations

from dataclasses import dataclass, fields

from cadpanel.delivery.records.settings import SettingsModel
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class Unproved:
    """Something that is said and not proved.

    Attributes:
        what: in the words of people.
        keys: of the report, with a star for what is counted or named.
    """

    what: str
    keys: tuple[str, ...]


_OF_THE_DELIVERY = {one.name for one in (*fields(SheetSettings), *fields(ShopSettings))} | {"step_schema"}
_OF_THE_FIT = tuple(
    f"settings.{key}{inside}"
    for key in SettingsModel.model_fields
    if key not in _OF_THE_DELIVERY
    for inside in ("", ".*")
)

_MET = tuple(f"seams.*.{key}" for key in ("width", "step", "shift", "max_kink"))
BY_REFERENCE: tuple[Unproved, ...] = (
    Unproved(what="deviation", keys=("panels.*.rms_deviation", "panels.*.max_deviation", "summary.rms_deviation")),
    Unproved(what="Hausdorff distance", keys=("panels.*.hausdorff",)),
    Unproved(what="drift", keys=("panels.*.*drift*", "summary.*drift_*percent", "summary.max_off_level")),
    Unproved(what="turn and unevenness of seams", keys=("seams.*.turn", "seams.*.unevenness")),
    Unproved(what="width, step, shift and kink of seams", keys=_MET),
)
"""What only the reference can tell."""
BY_A_FIT: tuple[Unproved, ...] = (
    Unproved(what="what other methods reach", keys=("baselines*",)),
    Unproved(what="what limits cost", keys=("solve*", "seams.*.price")),
    Unproved(what="how far slender cones were straightened", keys=("panels.*.moved",)),
    Unproved(what="what the bend was taken from", keys=("panels.*.taken*",)),
)
"""What only another fit could tell."""
_BOUNDS = tuple(f"settings.{key}" for key in ("dxf_name_length", "facet_height", "mesh_chord", "stock.*"))
IN_NO_FILE: tuple[Unproved, ...] = (
    Unproved(what="notes", keys=("panels.*.notes*", "reference.notes*")),
    Unproved(what="what was asked of the fit", keys=(*_OF_THE_FIT, "reference.file", "reference.reading*")),
    Unproved(what="bounds that files stay below", keys=_BOUNDS),
    Unproved(what="how long it took", keys=("timing*",)),
)
"""What was so when the delivery was made, and has left nothing else behind."""


def words(*parts: tuple[Unproved, ...]) -> tuple[str, ...]:
    """What people call it."""
    return tuple(one.what for part in parts for one in part)
