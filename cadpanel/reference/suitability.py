"""Is a panel what a feature is made for? Told by how its normals turn along its outline.

A folded panel is bent sheet: walking across the fold the normals turn, walking along it they hardly do. On a sphere or
a saddle they turn both ways.
"""

from __future__ import annotations

import numpy as np

from cadpanel.errors import PanelError
from cadpanel.reference.model import PanelReference

# Between flanges the normals of a fold turn by at least this much, degrees; those of a rolled sheet by this.
LEAST_FOLD = 3.0
LEAST_ROLL = 0.2
# A cylinder or cone of nearly half a turn cannot be told from one that goes round the other way, degrees.
MOST_TURN = 174.0
# Refused is what turns along the fold, against across it, by more than this: the geometric mean of the ratio of the
# angles and of the ratio of the angles per length. On a sphere it is 0.5 and more up to sides of 1 : 4, and 1 on a
# square; on a lip that folds by 60 degrees and whose flanges turn by 25 degrees on the way it is 0.3 to 0.5.
MOST_DOUBLE_CURVATURE = 0.55
# A sheet without flanges may follow a surface that curves both ways, if it does so gently, degrees.
GENTLE = 15.0


def check_corners(panel: PanelReference, source: str, feature: str) -> None:
    """Refuse a panel whose ends cannot be told from its sides.

    Raises:
        PanelError: it has other than four corners.
    """
    if panel.four_sided:
        return
    places = ", ".join("({:.1f}, {:.1f}, {:.1f})".format(*corner) for corner in panel.corners[:6])
    # A flat sheet may have more corners; what would give a bent one four is not known here.
    mean = panel.normals.sum(axis=0)
    flat = (panel.normals @ mean).min() >= np.cos(np.radians(GENTLE)) * np.linalg.norm(mean)
    raise PanelError(
        panel.name,
        f"in '{source}', its outline has {len(panel.corners)} corners (at {places}) where a {feature} panel has 4"
        + (": make it a planar-polygon." if flat else ", and it is bent too much for a planar-polygon."),
    )


def check_fold(panel: PanelReference, source: str, *, flanged: bool, folds: int) -> None:
    """Refuse a panel that is flat, or curved both ways, where a curved feature is asked for.

    Args:
        panel: with four edges.
        source: the file's name, for messages.
        flanged: whether the feature has flat patches, which tell a fold from a roll.
        folds: how many curved patches it has; one alone folds one way only.

    Raises:
        PanelError: naming the panel and the angles.
    """
    turning = panel.turning
    if turning is None:
        return  # made by hand, without an outline to ask
    across, along, to_and_fro = (np.degrees(abs(a)) for a in (turning.across, turning.along, turning.to_and_fro))
    least = LEAST_FOLD if flanged else LEAST_ROLL
    turns = max(across, to_and_fro) if folds > 1 else across
    if folds == 1 and across < least and to_and_fro >= 2.0 * least:
        raise PanelError(
            panel.name,
            f"in '{source}', it bends to and fro like an S (its normals turn by {to_and_fro:.0f} degrees on the way, "
            f"by {across:.2g} in the end), where a panel folds one way: divide it where the bend changes sides, or "
            "give it a double fold.",
        )
    if max(turns, along) < least:
        raise PanelError(
            panel.name,
            f"in '{source}', it is flat (its normals turn by {across:.2g} degrees, a fold needs {least:g}): "
            "give it a flat feature, or leave it out.",
        )
    if across > MOST_TURN * folds:
        raise PanelError(
            panel.name,
            f"in '{source}', it turns by {across:.0f} degrees, and one roll or fold reaches round {MOST_TURN:g}: "
            "cut it along its bend, too (--grid or --network), or keep a band narrower than the bend (--lip).",
        )
    both_ways = turns < least or along / turns * np.sqrt(turning.slenderness) > MOST_DOUBLE_CURVATURE
    if both_ways and (flanged or along > GENTLE):
        raise PanelError(
            panel.name,
            f"in '{source}', it curves both ways like a sphere or a saddle (its normals turn by {across:.0f} degrees "
            f"across the fold and by {along:.0f} along it), which flat sheet cannot follow: make it shorter along the "
            "fold, by a cut the other way where dividing it leaves these angles as they are.",
        )
