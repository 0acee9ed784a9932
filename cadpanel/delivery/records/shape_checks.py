"""Is what a report says of a panel's shape that of the shape which its corners, patches and cuts make?"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.records.from_shape import radius_ranges
from cadpanel.delivery.records.patches import PlanePatchModel
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.records.to_shape import unfolded_rulings
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.slender_cones import SMALLEST_HALF_ANGLE

SAME_LENGTH = 1e-5
"""Two lengths in mm that are meant to be one may differ by this: a cone's apex may lie 100 m away."""
SAME_AREA = 1e-9
"""Relative difference of two areas that are meant to be one."""
SAME_CORNER = 1e-6
"""Distance in mm of a corner from a plane that cuts it."""


def shape_faults(record: PanelModel, shape: Panel) -> Iterator[str]:
    """One sentence for every number of a record that is not the shape's, as `recorded_shape` makes it.

    Where that surface is, is proved by the files; here are the numbers that are told of it besides.
    """
    name = f"Panel '{record.name}'"
    area = shape.area()
    if not abs(record.area / area - 1.0) <= SAME_AREA:
        yield f"{name}: the report's area is {record.area:.9g} mm2, its corners and patches enclose {area:.9g}."
    corners = np.array(record.corners).reshape(-1, 3)
    most = SMALLEST_HALF_ANGLE * float(np.linalg.norm(np.ptp(corners, axis=0)))
    if not record.moved <= most:
        yield (
            f"{name}: the report says that a slender cone was straightened by {record.moved:.3g} mm, one of its size "
            f"moves by {most:.3g} mm at most."
        )
    radii_of = radius_ranges(shape)[: len(record.patches)]
    for index, (stated, own) in enumerate(zip(record.patches, radii_of, strict=True), start=1):
        if isinstance(stated, PlanePatchModel) or own is None:
            continue
        radii = stated.radius_min, stated.radius_max
        if not np.abs(np.subtract(radii, own)).max() <= SAME_LENGTH:
            yield (
                f"{name}: the report's {stated.kind} (patch {index}) goes from radius {radii[0]:.9g} to "
                f"{radii[1]:.9g} mm, its corners make {own[0]:.9g} to {own[1]:.9g}."
            )
    if record.fitted is not None:
        off = _off_cuts(np.array(record.fitted.corners), record)
        if not off <= SAME_CORNER:
            yield f"{name}: a corner of the report's fitted panel lies {off:.3g} mm from the plane that cuts it there."
        unfolded = slice(*unfolded_rulings(record))
        beside = _beside_rulings(np.array(record.fitted.corners), np.array(record.corners)[:, unfolded])
        if not beside <= SAME_LENGTH:
            yield f"{name}: a corner of the report's fitted panel lies {beside:.3g} mm beside the panel's ruling."


def _off_cuts(corners: Array, record: PanelModel) -> float:
    """How far, mm, a corner of the fitted panel lies from the plane that cuts its end; 0 of a polygon."""
    assert record.fitted is not None
    if len(corners) != len(record.fitted.cuts):
        return 0.0 if len(corners) == 1 and not record.fitted.cuts else np.inf
    heights = [row @ np.array(cut.normal) - cut.offset for row, cut in zip(corners, record.fitted.cuts, strict=True)]
    return float(np.abs(heights).max())


def _beside_rulings(fitted: Array, built: Array) -> float:
    """How far, mm, a corner of the fitted panel lies beside the line on which the built one has its own.

    Cutting back leaves a chain's rulings on their lines, but for the outermost ones, which lie in the same flat or
    curved patch; a polygon's corners stay in its plane.
    """
    if len(fitted) == 1 or fitted.shape[1] <= 2:
        return 0.0
    own = built[1, 1:-1] - built[0, 1:-1]
    along = own / np.linalg.norm(own, axis=1, keepdims=True)
    apart = fitted[:, 1:-1] - built[0, 1:-1]
    across = apart - np.sum(apart * along, axis=-1, keepdims=True) * along
    return float(np.linalg.norm(across, axis=-1).max(initial=0.0))
