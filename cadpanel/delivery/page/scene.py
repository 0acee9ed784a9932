"""What there is to see of a fit: meshes of the panels, how far the reference is from them, and how they meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array, IntArray
from cadpanel.delivery.page.ghosts import Ghost, ghost, outline_of
from cadpanel.delivery.records.from_shape import patch_models
from cadpanel.delivery.records.patches import ConePatchModel, CylinderPatchModel
from cadpanel.fitting.measures.deviation import deviations
from cadpanel.fitting.measures.profiles import SeamProfile, seam_profiles
from cadpanel.fitting.result import FitResult
from cadpanel.geometry.drilled_mesh import drilled_mesh
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.skin_mesh import skin_mesh

_NEAREST = 4
"""Samples that a vertex's deviation is taken from."""
_NO_HOLES = np.empty((2, 0, 3, 3))
_AT_ONE = 1e-6
"""mm: vertices this close to a sample have its deviation."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelScene:
    """One panel.

    Attributes:
        name: its name.
        feature: name of its shape feature.
        radius: smallest radius of its skin, mm; None where it is flat.
        points: (v, 3) vertices of the skin, mm.
        other: (v, 3) the same ones on the sheet's other face.
        triangles: (f, 3) counterclockwise seen from outside.
        deviation: (v,) how far the reference lies outside of the fitted skin there, mm: between the samples nearby.
        ghost: what it approximates.
    """

    name: str
    feature: str
    radius: float | None
    points: Array
    other: Array
    triangles: IntArray
    deviation: Array
    ghost: Ghost


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamScene:
    """One seam: the names of its panels, the one that comes first in the file first, and how they meet along it."""

    panels: tuple[str, str]
    profile: SeamProfile


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """All panels that are shown, and the seams of at least one of them."""

    panels: tuple[PanelScene, ...]
    seams: tuple[SeamScene, ...]


def scene_of(
    result: FitResult, skins: Sequence[Panel], others: Sequence[Panel], rims: Sequence[Array] | None = None
) -> Scene:
    """What is to be seen of some panels of a fit.

    Args:
        result: the fit, by which deviations and seams are told.
        skins: the panels to show, as they are built, under the names that the fit knows them by.
        others: the other faces of their sheets.
        rims: (2, h, k, 3) of each panel round its holes, on the skin and on the other face; None where there are none.
    """
    drilled = [_NO_HOLES] * len(skins) if rims is None else rims
    places = {panel.name: place for place, panel in enumerate(result.reference.panels)}
    shown = [places[skin.name] for skin in skins]
    measured = _measured(result, shown)
    panels = []
    for place, skin, other, own, (points, values) in zip(shown, skins, others, drilled, measured, strict=True):
        mesh = skin_mesh(skin)
        made = drilled_mesh(mesh, skin_mesh(other).points, own)
        panels.append(
            PanelScene(
                name=skin.name,
                feature=skin.feature,
                radius=_smallest_radius(skin),
                points=made.points,
                other=made.other,
                triangles=made.triangles,
                deviation=_between(made.points, points, values),
                ghost=ghost(result.reference.panels[place], mesh),
            )
        )
    return Scene(panels=tuple(panels), seams=_seams(result, set(shown)))


def _seams(result: FitResult, shown: set[int]) -> tuple[SeamScene, ...]:
    reference = result.reference
    found = seam_profiles(result.shapes, reference.seams)
    return tuple(
        SeamScene(
            panels=(reference.panels[min(seam.panels)].name, reference.panels[max(seam.panels)].name), profile=profile
        )
        for seam, profile in zip(reference.seams, found, strict=True)
        if shown & set(seam.panels)
    )


def _smallest_radius(skin: Panel) -> float | None:
    rounds = [patch for patch in patch_models(skin) if isinstance(patch, ConePatchModel | CylinderPatchModel)]
    return min((patch.radius_min for patch in rounds), default=None)


def _measured(result: FitResult, shown: Sequence[int]) -> list[tuple[Array, Array]]:
    """Of each panel the points of its reference, samples and outline, and their signed distances from the skin."""
    own = [
        np.concatenate([result.reference.panels[place].points, outline_of(result.reference.panels[place])])
        for place in shown
    ]
    most = max(map(len, own))
    padded = np.stack([np.concatenate([points, np.tile(points[:1], (most - len(points), 1))]) for points in own])
    found = deviations([result.shapes[place] for place in shown], padded)
    return [(points, values[: len(points)]) for points, values in zip(own, found, strict=True)]


def _between(places: Array, points: Array, values: Array) -> Array:
    """(v,) values at places (v, 3), from the nearest of the points where they are known, nearer ones counting more."""
    distance, nearest = cKDTree(points).query(places, k=min(_NEAREST, len(points)))
    weight = 1.0 / np.maximum(distance, _AT_ONE) ** 2
    return np.asarray((weight * values[nearest]).sum(axis=1) / weight.sum(axis=1))
