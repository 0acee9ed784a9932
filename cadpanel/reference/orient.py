"""From an outline to a panel's reference: which sides are the ends, which way is out, and whether there is a fold.

A panel is bent sheet: walking across the fold the normals turn, walking along it they hardly do. On a sphere or a
saddle they turn both ways.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cadpanel.errors import PanelError
from cadpanel.reference.model import PanelReference, RawPanel
from cadpanel.reference.outline import Outline, Side
from cadpanel.reference.polyline import norm, unit

Array = NDArray[np.float64]

# A fold turns the normals by at least this much from side to side, degrees.
LEAST_FOLD = 3.0
# Refused is what turns along the fold, against across it, by more than this: the geometric mean of the ratio of the
# angles and of the ratio of the angles per length. On a sphere it is 0.5 and more up to sides of 1 : 4, and 1 on a
# square; on a lip that folds by 60 degrees and whose flanges turn by 25 degrees on the way it is 0.3 to 0.5.
MOST_DOUBLE_CURVATURE = 0.55


def orient(panel: RawPanel, outline: Outline, source: str) -> PanelReference:
    """Return the panel's reference. Which of the two ends is end 0 is left to chance here.

    Raises:
        PanelError: the panel is flat, or curved both ways.
    """
    bends = [_bend(side) for side in outline.sides]
    first = 0 if abs(bends[0] + bends[2]) >= abs(bends[1] + bends[3]) else 1
    ends = outline.sides[first], outline.sides[first + 2]
    long_edges = outline.sides[1 - first], outline.sides[3 - first]
    fold = 0.5 * (bends[first] + bends[first + 2])
    _check_fold(panel.name, source, np.degrees(abs(fold)), ends, long_edges)
    convex = 1.0 if fold > 0.0 else -1.0
    normals = [convex * sign * face.normals for sign, face in zip(outline.face_signs, panel.faces, strict=True)]
    # The sides follow each other round the loop; here both ends are to run from side 0 to side 1.
    end_0, end_1 = ends
    points_0, points_1 = end_0.points, end_1.points[::-1]
    normals_0, normals_1 = convex * end_0.normals, convex * end_1.normals[::-1]
    side_1, side_0 = outline.sides[first + 1].points, outline.sides[first - 1].points[::-1]
    reference = PanelReference(
        name=panel.name,
        points=np.concatenate([face.points for face in panel.faces]),
        normals=np.concatenate(normals),
        weights=np.concatenate([face.weights for face in panel.faces]),
        ends=(points_0, points_1),
        end_normals=(normals_0, normals_1),
        sides=(side_0, side_1),
    )
    return reference if _is_right_handed(reference) else mirror(reference)


def turn(panel: PanelReference) -> PanelReference:
    """Return the same panel turned by 180 degrees about its normal: end 0 becomes end 1, side 0 becomes side 1."""
    return mirror(
        PanelReference(
            name=panel.name,
            points=panel.points,
            normals=panel.normals,
            weights=panel.weights,
            ends=(panel.ends[1], panel.ends[0]),
            end_normals=(panel.end_normals[1], panel.end_normals[0]),
            sides=(panel.sides[0][::-1], panel.sides[1][::-1]),
        )
    )


def mirror(panel: PanelReference) -> PanelReference:
    """Return the panel with side 0 and side 1 exchanged, which changes its handedness."""
    return PanelReference(
        name=panel.name,
        points=panel.points,
        normals=panel.normals,
        weights=panel.weights,
        ends=(panel.ends[0][::-1], panel.ends[1][::-1]),
        end_normals=(panel.end_normals[0][::-1], panel.end_normals[1][::-1]),
        sides=(panel.sides[1], panel.sides[0]),
    )


def _is_right_handed(panel: PanelReference) -> bool:
    """Tell whether t x n points from side 0 to side 1, in the mean."""
    corners = panel.corners
    along = (corners[1] - corners[0]).mean(axis=0)
    across = (corners[:, 1] - corners[:, 0]).mean(axis=0)
    normal = panel.weights @ panel.normals
    return bool(np.cross(along, normal) @ across > 0.0)


def _bend(side: Side) -> float:
    """Angle by which the normals lean forwards on the way along a side, radians; positive where the side is convex.

    Turning sideways (the twist of a flange) does not count.
    """
    return float(np.sum(_leans(side)))


def _leans(side: Side) -> Array:
    """(k - 1,) the same from each point of a side to the next."""
    steps = np.diff(side.normals, axis=0)
    sizes = norm(steps)
    angles = 2.0 * np.arcsin(np.clip(0.5 * sizes, 0.0, 1.0))
    forwards = np.einsum("kd,kd->k", unit(steps), unit(np.diff(side.points, axis=0)))
    return np.asarray(angles * forwards)


def _spread(side: Side) -> float:
    """Largest angle between any two normals along a side, degrees."""
    return float(np.degrees(np.arccos(np.clip((side.normals @ side.normals.T).min(), -1.0, 1.0))))


def _check_fold(name: str, source: str, across: float, ends: tuple[Side, Side], long_edges: tuple[Side, Side]) -> None:
    """Refuse a panel that is not folded one way: flat, or curved both ways (angles in degrees)."""
    along = max(_spread(side) for side in long_edges)
    width = sum(side.length for side in ends)
    length = sum(side.length for side in long_edges)
    to_and_fro = max(float(np.degrees(np.abs(_leans(side)).sum())) for side in (*ends, *long_edges))
    if across < LEAST_FOLD and to_and_fro >= 2.0 * LEAST_FOLD:
        raise PanelError(
            name,
            f"in '{source}', it bends to and fro like an S (its normals turn by {to_and_fro:.0f} degrees on the way, "
            f"by {across:.2g} in the end), where a panel folds one way: divide it where the bend changes sides.",
        )
    if max(across, along) < LEAST_FOLD:
        raise PanelError(
            name,
            f"in '{source}', it is flat (its normals turn by {across:.2g} degrees, a fold needs {LEAST_FOLD:g}): "
            "leave it out, flat sheet needs no fitting.",
        )
    if across < LEAST_FOLD or along / across * np.sqrt(width / length) > MOST_DOUBLE_CURVATURE:
        raise PanelError(
            name,
            f"in '{source}', it curves both ways like a sphere or a saddle (its normals turn by {across:.0f} degrees "
            f"across the fold and by {along:.0f} along it), which flat sheet cannot follow: divide it further.",
        )
