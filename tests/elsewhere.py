"""Panels somewhere else, and in other units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.reference.model import PanelReference, Reference


def turn(seed: int) -> Array:
    """(3, 3) a random rotation."""
    axes, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    rotation: Array = axes * np.sign(np.linalg.det(axes))
    return rotation


def elsewhere(shape: Panel, rotation: Array, shift: Array) -> Panel:
    """The panel turned and shifted by mm."""
    if isinstance(shape, PolygonShape):
        return replace(shape, outline=shape.outline @ rotation.T + shift, normal=rotation @ shape.normal)
    assert isinstance(shape, PanelShape)
    return replace(
        shape,
        points=shape.points @ rotation.T + shift,
        directions=shape.directions @ rotation.T,
        normals=shape.normals @ rotation.T,
        cut_points=shape.cut_points @ rotation.T + shift,
        cut_normals=shape.cut_normals @ rotation.T,
    )


def shaken(shapes: Sequence[Panel], seed: int, by: float = 3.0) -> list[Panel]:
    """The panels moved by some mm each, so that there is something to measure."""
    random = np.random.default_rng(seed)
    return [elsewhere(shape, np.eye(3), by * random.normal(size=3)) for shape in shapes]


def scaled(shape: Panel, by: float) -> Panel:
    """The panel with all its lengths times a factor."""
    if isinstance(shape, PolygonShape):
        return replace(shape, outline=by * shape.outline)
    assert isinstance(shape, PanelShape)
    patches = tuple(
        replace(patch, radius=by * patch.radius) if isinstance(patch, ConePatch) else patch for patch in shape.patches
    )
    return replace(shape, points=by * shape.points, cut_points=by * shape.cut_points, patches=patches)


def scaled_reference(reference: Reference, by: float) -> Reference:
    """The reference with all its lengths times a factor."""

    def panel(of: PanelReference) -> PanelReference:
        edges = tuple(by * edge for edge in of.edges)
        return replace(of, points=by * of.points, weights=by**2 * of.weights, edges=edges)

    return replace(reference, panels=tuple(panel(of) for of in reference.panels))
