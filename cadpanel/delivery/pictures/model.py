"""All panels as a picture: seen from far away, nearer faces drawn over farther ones, seams as lines between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.page.scene import PanelScene, Scene
from cadpanel.delivery.pictures.colours import (
    CATEGORIES,
    DIVERGING,
    FLAT,
    LINE,
    NEUTRAL,
    OF_SEAMS,
    SEQUENTIAL,
    Colour,
    colour_map,
    require_colour,
    require_matplotlib,
    rounded_up,
)
from cadpanel.delivery.pictures.views import VIEWS, View
from cadpanel.errors import SettingsError
from cadpanel.geometry.vectors import cross, norm, unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.colorbar import Colorbar
    from matplotlib.figure import Figure

_WAYS = {
    "north": (0, 1, 0.25),
    "east": (1, 0, 0.25),
    "south": (0, -1, 0.25),
    "west": (-1, 0, 0.25),
    "top": (0, -0.02, 1),
}
_SIZE, _DOTS = (10.5, 7.0), 130
# Widths of lines as a share of the picture's width; how far they are drawn nearer; least light on a face.
_THICK, _THIN, _NEARER, _DARKEST = 0.006, 0.0015, 0.02, 0.72
_UPRIGHT, _LONG, _ABOVE = 0.25, 0.3, 0.35
_KEYS = 4
"""Names of features in a row of the legend."""
_LABELS = {
    "deviation": "reference inside (\u2212) or outside (+) of the panel, mm",
    "gap": "gap along the seams, mm",
    "step": "step along the seams, mm",
    "kink": "kink along the seams, degrees",
    "radius": "smallest radius of the skin, mm",
}


@dataclass(frozen=True, slots=True)
class _Faces:
    """Polygons in the picture: corners (f, 4, 2), how near they are (f,), and their colours (f, 4)."""

    corners: Array
    depth: Array
    colours: Array


def draw_model(scene: Scene, color: Colour = "deviation", view: View = "outside") -> Figure:
    """Draw all panels.

    Args:
        scene: what there is to see.
        color: what they are coloured by; gap, step and kink along the seams.
        view: from where they are seen; "outside" is where most of them face to. North is along y, up along z.

    Raises:
        SettingsError: matplotlib is missing, or there is no such colour or view.
    """
    require_matplotlib()
    require_colour(color)
    if view not in VIEWS:
        raise SettingsError(f"nothing can be seen from '{view}'; choose from {', '.join(VIEWS)}")
    from matplotlib.collections import PolyCollection

    from cadpanel.delivery.pictures.figure import Picture

    frame = _frame(_outside(scene) if view == "outside" else np.array(_WAYS[view], dtype=np.float64))
    scale = _scale(scene, color)
    panels = _panel_faces(scene, color, scale, frame)
    parts = [panels, _seam_faces(scene, color, scale, frame, float(np.ptp(panels.corners[..., 0])))]
    corners, depth, colours = (
        np.concatenate([getattr(part, what) for part in parts]) for what in ("corners", "depth", "colours")
    )
    order = np.argsort(depth, kind="stable")
    figure = Picture(figsize=_SIZE, dpi=_DOTS, layout="constrained")
    axes = figure.add_subplot()
    axes.add_collection(
        PolyCollection(list(corners[order]), facecolors=colours[order], edgecolors=colours[order], linewidths=0.3)
    )
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.04)
    axes.set_axis_off()
    _legend(figure, axes, scene, color, scale)
    return figure


def _frame(way: Array) -> Array:
    """(3, 3) unit vectors in rows: to the right, up, and towards who looks."""
    back = unit(way)
    right = unit(cross(np.array([0.0, 0.0, 1.0]), back))
    return np.stack([right, cross(back, right), back])


def _outside(scene: Scene) -> Array:
    """Where most panels face to, a little from above; a roof or a closed form is seen along its short side."""
    areas = np.concatenate([_doubled_areas(panel) for panel in scene.panels])
    outward = areas.sum(axis=0) / norm(areas).sum()
    way = outward.copy()
    if np.hypot(*outward[:2]) > _UPRIGHT:
        way = unit(outward)
    else:
        plan = np.array([panel.points.mean(axis=0)[:2] for panel in scene.panels])
        spread = np.atleast_2d((plan - plan.mean(axis=0)).T @ (plan - plan.mean(axis=0)))
        lengths, axes = np.linalg.eigh(spread)
        short = axes[:, 0] if lengths[1] - lengths[0] > _LONG * lengths.sum() else np.array([-0.5, -0.85])
        way[:2] = -np.copysign(1.0, short[1]) * short
    way[2] = max(way[2], 0.0) + _ABOVE
    return np.asarray(way)


def _doubled_areas(panel: PanelScene) -> Array:
    a, b, c = (panel.points[panel.triangles[:, corner]] for corner in range(3))
    return cross(b - a, c - a)


def _scale(scene: Scene, color: Colour) -> ScalarMappable | None:
    """From values to colours; None for features, and for radii where all is flat."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm, Normalize

    if color == "deviation":
        most = rounded_up(max(float(np.abs(panel.deviation).max()) for panel in scene.panels))
        return ScalarMappable(Normalize(-most, most), colour_map(DIVERGING))
    if color in OF_SEAMS:
        found = [_along(scene, color, place).max() for place in range(len(scene.seams))]
        return ScalarMappable(Normalize(0.0, rounded_up(float(max(found, default=0.0)))), colour_map(SEQUENTIAL))
    radii = [panel.radius for panel in scene.panels if panel.radius is not None]
    if color == "radius" and radii:
        return ScalarMappable(LogNorm(min(radii), max(max(radii), 1.001 * min(radii))), colour_map(SEQUENTIAL))
    return None


def _along(scene: Scene, color: Colour, place: int) -> Array:
    values: Array = getattr(scene.seams[place].profile, color)
    return np.degrees(values) if color == "kink" else values


def _panel_faces(scene: Scene, color: Colour, scale: ScalarMappable | None, frame: Array) -> _Faces:
    from matplotlib.colors import to_rgba

    features = feature_colours(scene)
    corners, depth, colours = [], [], []
    for panel in scene.panels:
        seen = panel.points @ frame.T
        triangles = seen[panel.triangles]
        areas = _doubled_areas(panel)
        light = _DARKEST + (1.0 - _DARKEST) * np.abs(areas @ frame[2]) / np.maximum(norm(areas), 1e-12)
        if color == "deviation" and scale is not None:
            own = np.asarray(scale.to_rgba(panel.deviation[panel.triangles].mean(axis=1)))
        elif color == "radius":
            flat = panel.radius is None or scale is None
            own = np.array([to_rgba(FLAT) if flat else scale.to_rgba(panel.radius)])  # type: ignore[union-attr, arg-type]
        else:
            own = np.array([to_rgba(features[panel.feature] if color == "feature" else NEUTRAL)])
        shaded = np.broadcast_to(own, (len(triangles), 4)).copy()
        shaded[:, :3] *= light[:, None]
        corners.append(triangles[:, [0, 1, 2, 2], :2])
        depth.append(triangles[..., 2].mean(axis=1))
        colours.append(shaded)
    return _Faces(*(np.concatenate(parts) for parts in (corners, depth, colours)))


def _seam_faces(scene: Scene, color: Colour, scale: ScalarMappable | None, frame: Array, across: float) -> _Faces:
    """Each step along a seam as a thin strip, a little nearer than the panels that it lies between."""
    from matplotlib.colors import to_rgba

    parts = [(np.empty((0, 4, 2)), np.empty(0), np.empty((0, 4)))]
    thick = color in OF_SEAMS
    for place, seam in enumerate(scene.seams):
        seen = seam.profile.points @ frame.T
        start, stop = seen[:-1], seen[1:]
        way = stop[:, :2] - start[:, :2]
        length = np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
        half = 0.5 * across * (_THICK if thick else _THIN)
        side = half * np.column_stack([-way[:, 1], way[:, 0]]) / length
        ahead = (0.5 * half if thick else 0.0) * way / length
        low, high = start[:, :2] - ahead, stop[:, :2] + ahead
        strip = np.stack([low - side, high - side, high + side, low + side], axis=1)
        values = _along(scene, color, place) if thick else np.zeros(len(seen))
        middle = 0.5 * (values[:-1] + values[1:])
        own = np.asarray(to_rgba(LINE) if scale is None or not thick else scale.to_rgba(middle))
        parts.append((strip, seen[1:, 2] + _NEARER * across, np.broadcast_to(own, (len(strip), 4))))
    return _Faces(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def feature_colours(scene: Scene) -> dict[str, str]:
    """A colour for each feature, by its name."""
    names = sorted({panel.feature for panel in scene.panels})
    return {name: CATEGORIES[place % len(CATEGORIES)] for place, name in enumerate(names)}


def _legend(figure: Figure, axes: Axes, scene: Scene, color: Colour, scale: ScalarMappable | None) -> None:
    from matplotlib.patches import Patch

    if scale is not None:
        bar = figure.colorbar(scale, ax=axes, orientation="horizontal", shrink=0.5, aspect=36, pad=0.02)
        if color == "radius":
            _tell_radii(bar, scale)
        bar.set_label(_LABELS[color])
        bar.outline.set_visible(False)
        return
    keys = feature_colours(scene) if color == "feature" else {"all panels are flat": FLAT}
    handles = [Patch(color=colour, label=words) for words, colour in keys.items()]
    axes.legend(
        handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=min(len(handles), _KEYS), frameon=False
    )


def _tell_radii(bar: Colorbar, scale: ScalarMappable) -> None:
    """Least, middle and largest, as the page tells them: whoever rolls sheet reads no powers of ten."""
    least, most = scale.get_clim()
    told = {f"{value:.0f}": value for value in (least, float(np.sqrt(least * most)), most)}
    bar.set_ticks(list(told.values()), labels=list(told))
    bar.ax.minorticks_off()
