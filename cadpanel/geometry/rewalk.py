"""A chain of numbers that were written down, each with its last digit, as one walk from ruling to ruling again."""

from __future__ import annotations

from dataclasses import replace
from functools import singledispatch

import numpy as np

from cadpanel.geometry.chain_checks import carried_ruling
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.vectors import unit


@singledispatch
def rewalked(shape: Panel) -> Panel:
    """The same panel, as a walk that can be built; one that is no chain of patches is one as it is."""
    return shape


@rewalked.register
def _chain(shape: PanelShape) -> PanelShape:
    """The same chain, every patch of which carries its ruling exactly to the next one.

    Corners hundreds of metres from the origin, and apexes as far away, leave 1e-8 mm between a patch and the ruling at
    which it should end. Beginning at the first ruling each next one is put where its patch ends: a cone or a cylinder
    carries it there, and in a plane it keeps its own direction.
    """
    normals = shape.normals.copy()
    normals[0] -= (normals[0] @ shape.directions[0]) * shape.directions[0]
    normals[0] = unit(normals[0])
    found = replace(shape, normals=normals)
    for index, patch in enumerate(shape.patches):
        point, direction, normal = carried_ruling(found, index)
        if not isinstance(patch, ConePatch):
            own, along = found.points[index + 1], found.directions[index + 1]
            point = own - ((own - point) @ normal) * normal
            direction = unit(along - (along @ normal) * normal)
        points, directions, normals = (np.array(of) for of in (found.points, found.directions, found.normals))
        points[index + 1], directions[index + 1], normals[index + 1] = point, direction, normal
        found = replace(found, points=points, directions=directions, normals=normals)
    return found
