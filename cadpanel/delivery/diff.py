"""Two deliveries against each other: which panels changed, by how much, and which blanks must be cut again.

Panels are the same by their names, which stay when a surface is solved again; one that has gone and one that has come
in its place, at the same corners, are one panel under two names. A blank is compared as the shop has it, flat: the new
contour is laid upon the old one, so that a panel which only hangs elsewhere is not cut again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.difference import DifferenceModel, PanelDifference, Status
from cadpanel.delivery.records.flat_parts import FlatPart, flat_parts
from cadpanel.delivery.records.report import PanelModel, ReportModel, read_report
from cadpanel.delivery.records.to_shape import recorded_shapes
from cadpanel.errors import DeliveryError, SettingsError
from cadpanel.geometry.congruence import best_motion
from cadpanel.kinds import checked

TOLERANCE = 0.1
"""Lengths in mm that a shop takes for the same."""
SAME_ANGLE = 0.05
"""Degrees that it takes for the same."""
_PLACES = np.linspace(0.0, 1.0, 9)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Panel:
    """A panel of a delivery: its record, its flat part, its corners in the model's coordinates (n, 3)."""

    record: PanelModel
    part: FlatPart
    corners: Array


@checked
def diff(before: str | Path, now: str | Path, *, tolerance: float = TOLERANCE) -> DifferenceModel:
    """What differs between two deliveries, by their reports.

    Args:
        before: the folder of the earlier delivery.
        now: that of the later one.
        tolerance: lengths that differ by no more than this are the same, mm.

    Raises:
        DeliveryError: a folder is missing, or its report cannot be read or is too old.
        SettingsError: the tolerance is none.
    """
    if not 0.0 < tolerance < np.inf:
        raise SettingsError(f"the tolerance must be a length above 0 mm, not {tolerance:g}")
    reports = [_report(folder) for folder in (before, now)]
    earlier, later = (_panels(report) for report in reports)
    sheet = _of_the_sheet(*reports)
    names = _names_before(earlier, later, tolerance)
    found = [
        _difference(earlier.get(names.get(name, "")), panel, tolerance, other_sheet=bool(sheet))
        for name, panel in later.items()
    ]
    left = earlier.keys() - names.values()
    found += [_lone(panel, "gone") for name, panel in earlier.items() if name in left]
    return DifferenceModel(before=str(before), now=str(now), tolerance=tolerance, sheet=sheet, panels=tuple(found))


def _report(folder: str | Path) -> ReportModel:
    if not Path(folder).is_dir():
        raise DeliveryError(f"'{folder}' is not a folder: name one that 'cadpanel fit' wrote.")
    return read_report(Path(folder) / REPORT)


def _panels(report: ReportModel) -> dict[str, _Panel]:
    sheet, shop = report.settings.sheet(), report.settings.shop()
    parts = flat_parts(recorded_shapes(report), sheet, shop)
    offset = np.array(report.origin.offset)
    return {
        record.name: _Panel(record=record, part=part, corners=np.concatenate(record.corners) + offset)
        for record, part in zip(report.panels, parts, strict=True)
    }


def _of_the_sheet(before: ReportModel, now: ReportModel) -> dict[str, tuple[str, str]]:
    """What makes every blank another one, before and now."""
    said = [
        {"thickness": f"{report.settings.thickness:g} mm", "material": report.settings.material}
        for report in (before, now)
    ]
    return {what: (said[0][what], said[1][what]) for what in said[0] if said[0][what] != said[1][what]}


def _names_before(earlier: Mapping[str, _Panel], later: Mapping[str, _Panel], tolerance: float) -> dict[str, str]:
    """By its name now the name that each panel had; those that are new are left out."""
    found = {name: name for name in later if name in earlier}
    gone = [panel for name, panel in earlier.items() if name not in later]
    if not gone:
        return found
    middles, taken = cKDTree([panel.corners.mean(axis=0) for panel in gone]), set[int]()
    for name, panel in later.items():
        if name in found:
            continue
        near = middles.query_ball_point(panel.corners.mean(axis=0), tolerance, return_sorted=True)
        same = [place for place in near if place not in taken and _apart(gone[place], panel) <= tolerance]
        if same:
            taken.add(same[0])
            found[name] = gone[same[0]].record.name
    return found


def _apart(one: _Panel, other: _Panel) -> float:
    """Distance of the corner that moved farthest; infinite where corners do not correspond."""
    if len(one.corners) != len(other.corners):
        return np.inf
    return float(np.linalg.norm(one.corners - other.corners, axis=-1).max())


def _lone(panel: _Panel, status: Status) -> PanelDifference:
    """A panel that only one of the deliveries has."""
    new = status == "new"
    name = panel.record.name
    return PanelDifference(
        name=name, before=None if new else name, status=status, cut_again=new, bend_again=new and bool(panel.part.bends)
    )


def _difference(before: _Panel | None, now: _Panel, tolerance: float, *, other_sheet: bool) -> PanelDifference:
    if before is None:
        return _lone(now, "new")
    moved, (contour, bend_lines, holes) = _apart(before, now), _flat(before.part, now.part)
    radius, sweep = _bends(before.part, now.part)
    bevel = _bevel(before.record, now.record)
    cut = other_sheet or max(contour, holes) > tolerance
    otherwise = other_sheet or max(bend_lines, radius) > tolerance or sweep > SAME_ANGLE
    bend = otherwise and bool(now.part.bends)
    other = before.record.feature != now.record.feature
    changed = cut or bend or bevel > SAME_ANGLE or other
    renamed = before.record.name != now.record.name
    here: Status = "moved" if moved > tolerance else "renamed" if renamed else "same"
    masses = (before.record.mass, now.record.mass)
    return PanelDifference(
        name=now.record.name,
        before=before.record.name,
        status="changed" if changed else here,
        cut_again=cut,
        bend_again=bend,
        moved=_told(moved),
        contour=_told(contour),
        bend_lines=_told(bend_lines),
        holes=_told(holes),
        radius=_told(radius),
        sweep=_told(sweep),
        bevel=_told(bevel),
        area=now.part.size.area - before.part.size.area,
        mass=None if masses[0] is None or masses[1] is None else masses[1] - masses[0],
        features=(before.record.feature, now.record.feature) if other else None,
    )


def _flat(before: FlatPart, now: FlatPart) -> tuple[float, float, float]:
    """How far the farthest place of contour, bends' lines and holes' middles lies from the old one, laid upon it, mm.

    Infinite where they do not correspond; of holes also where they are others in number or diameter.
    """
    old, new = before.pattern, now.pattern
    if old.edges != new.edges or old.tangents.shape != new.tangents.shape:
        return np.inf, np.inf, np.inf
    contours = [
        pattern.curves.points(np.broadcast_to(_PLACES, (len(pattern.curves), len(_PLACES)))).reshape(-1, 2)
        for pattern in (old, new)
    ]
    motion = best_motion(contours[1], contours[0])

    def farthest(here: Array, there: Array) -> float:
        return float(np.linalg.norm(motion.moved(there) - here, axis=-1).max(initial=0.0))

    drilled = before.circles, now.circles
    same = len(drilled[0]) == len(drilled[1]) and np.array_equal(drilled[0][:, 2], drilled[1][:, 2])
    holes = farthest(drilled[0][:, :2], drilled[1][:, :2]) if same else np.inf
    return farthest(contours[0], contours[1]), farthest(old.tangents, new.tangents), holes


def _bends(before: FlatPart, now: FlatPart) -> tuple[float, float]:
    """Largest difference of an inner radius, mm, and of a sweep, degrees."""
    if [bend.direction for bend in before.bends] != [bend.direction for bend in now.bends]:
        return np.inf, np.inf
    pairs = list(zip(before.bends, now.bends, strict=True))
    radii = [abs(one - other) for old, new in pairs for one, other in zip(old.radius, new.radius, strict=True)]
    return max(radii, default=0.0), max((abs(old.sweep - new.sweep) for old, new in pairs), default=0.0)


def _bevel(before: PanelModel, now: PanelModel) -> float:
    """Largest difference of a bevel, degrees."""
    if before.bevels.keys() != now.bevels.keys():
        return np.inf
    pairs = [(before.bevels[edge], now.bevels[edge]) for edge in before.bevels]
    return max((abs(one - other) for old, new in pairs for one, other in zip(old, new, strict=True)), default=0.0)


def _told(value: float) -> float | None:
    """What cannot be told has no number."""
    return value if np.isfinite(value) else None
