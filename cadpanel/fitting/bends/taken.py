"""Which stretch of a panel became which patch, and samples held to the stretch that the user gave them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.bends.asked import Blend
from cadpanel.fitting.start.segmentation import curved_runs
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.polyline import arc_length, interpolate
from cadpanel.reference.model import PanelReference, Reference

# Lines across which a panel is walked from side to side, in each of the three stretches.
LINES = 17
# A blend is missed where a curved patch begins or ends farther from it than this part of its width.
MISSED = 0.2


def taken(panel: PanelReference, shape: Panel) -> Array:
    """(2, k + 1) where on both ends of its reference a chain's k patches begin and end, mm from side 0.

    Each ruling counts from the point of the reference's end that is nearest to where it ends. Empty for polygons.
    """
    if not (shape.four_sided and panel.four_sided):
        return np.empty((0, 0))
    found = []
    for end, corners in zip(panel.ends, shape.corners(), strict=True):
        lengths = arc_length(end)
        steps = np.diff(end, axis=0)
        off = corners[1:-1, None] - end[None, :-1]
        share = np.clip(np.sum(off * steps, axis=-1) / np.sum(steps**2, axis=-1), 0.0, 1.0)
        nearest = np.linalg.norm(off - share[..., None] * steps, axis=-1).argmin(axis=1)
        rows = np.arange(len(nearest))
        inner = lengths[nearest] + share[rows, nearest] * np.diff(lengths)[nearest]
        found.append(np.maximum.accumulate([0.0, *inner, lengths[-1]]))
    return np.array(found)


def stretches(panels: Sequence[PanelReference], blends: Sequence[Blend]) -> Array:
    """(n, 2, 2) where the blends begin and end on both ends of each panel, mm from side 0; nan where none is given.

    Raises:
        SettingsError: a blend reaches beyond a panel's end.
    """
    own = {blend.panel: blend for blend in blends}
    found = np.full((len(panels), 2, 2), np.nan)
    for i, panel in enumerate(panels):
        blend = own.get(panel.name, own.get(None))
        if blend is None or not panel.four_sided:
            continue
        widths = np.array([arc_length(end)[-1] for end in panel.ends])
        found[i] = np.array([blend.first, blend.last]) * (widths[:, None] / 100.0 if blend.percent else 1.0)
        if np.any(found[i, :, 1] >= widths):
            raise SettingsError(
                f"the blend '{blend}' leaves panel '{panel.name}' no second flange: its ends are "
                f"{widths[0]:.6g} and {widths[1]:.6g} mm long"
            )
    return found


def missed_blend(panel: PanelReference, shape: Panel, blends: Sequence[Blend]) -> tuple[Array, Array] | None:
    """Where a panel's curved patches were told to begin and end and where they do, each (2, 2) as in `stretches`.

    None where nothing was told, or all comes within MISSED of the stretch's width. A blend says which part of the
    drawing the curved patches are held to: where their rulings end is for the fit.
    """
    (asked,) = stretches([panel], blends)
    if np.isnan(asked).any():
        return None
    ((start, stop),) = curved_runs([patch.kind != "plane" for patch in shape.patches])
    became = taken(panel, shape)[:, [start, stop]]
    near = np.abs(became - asked) <= MISSED * np.diff(asked, axis=1)
    return None if near.all() else (asked, became)


def check_blends(reference: Reference, features: Sequence[PanelFeature], blends: Sequence[Blend]) -> None:
    """Refuse blends for panels that are not there, or whose features have no such stretch.

    Raises:
        SettingsError: naming the panel.
    """
    names = {panel.name for panel in reference.panels}
    for blend in blends:
        if blend.panel is not None and blend.panel not in names:
            raise SettingsError(f"there is no panel '{blend.panel}' in '{reference.source}' for the blend '{blend}'")
    meant = {blend.panel for blend in blends}
    for panel, feature in zip(reference.panels, features, strict=True):
        if (None in meant or panel.name in meant) and not has_blend(feature):
            raise SettingsError(
                f"panel '{panel.name}' is to be a {feature.name}, which is no single bend between two flanges: a "
                "blend has no meaning there"
            )


def has_blend(feature: PanelFeature) -> bool:
    """Whether a feature is two flanges with one stretch of curved patches between them."""
    runs = curved_runs(feature.curved)
    return len(runs) == 1 and runs[0][0] > 0 and runs[0][1] < len(feature.curved)


def allowed_patches(
    panels: Sequence[PanelReference], features: Sequence[PanelFeature], blends: Sequence[Blend], points: Array
) -> tuple[IntArray, IntArray] | None:
    """The first and last patch (panels, m) to which each sample may belong, or None where nothing restricts them.

    Args:
        panels: the reference's.
        features: theirs.
        blends: what the user asks for.
        points: (panels, m, 3) samples, mm.
    """
    if not blends:
        return None
    first = np.zeros(points.shape[:2], dtype=np.intp)
    last = np.repeat([[len(feature.curved) - 1] for feature in features], points.shape[1], axis=1)
    for i, stretch in enumerate(stretches(panels, blends)):
        if np.isnan(stretch).any():
            continue
        ((start, stop),) = curved_runs(features[i].curved)
        zone = _zones(panels[i], stretch, points[i])
        first[i] = np.choose(zone, [0, start, stop])
        last[i] = np.choose(zone, [start - 1, stop - 1, len(features[i].curved) - 1])
    return first, last


def _zones(panel: PanelReference, stretch: Array, points: Array) -> IntArray:
    """(m,) on which side of the stretch points (m, 3) lie: 0 before, 1 within, 2 beyond.

    The panel is walked from side to side in lines between its ends; a point goes to the line that passes it nearest.
    """
    lines = []
    for end, (begin, stop) in zip(panel.ends, stretch, strict=True):
        lengths = arc_length(end)
        knots = [0.0, begin, stop, lengths[-1]]
        # In the middle of steps, such that no line lies on a border.
        steps = (np.arange(LINES) + 0.5) / LINES
        places = np.concatenate([low + (high - low) * steps for low, high in pairwise(knots)])
        lines.append(interpolate([lengths], end, [places]))
    start, way = lines[0], lines[1] - lines[0]
    off = points[:, None] - start[None]
    along = np.sum(off * way, axis=-1) / np.sum(way**2, axis=-1)
    distance = np.linalg.norm(off - along[..., None] * way, axis=-1)
    nearest: IntArray = distance.argmin(axis=1) // LINES
    return nearest
