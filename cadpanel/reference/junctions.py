"""Sides parted where corners of other panels lie on them, as in a brick bond, so that each part can meet one panel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.geometry.polyline import arc_length
from cadpanel.geometry.vectors import norm, unit
from cadpanel.reference.inner_edges import Edge, positions_on
from cadpanel.reference.outline import Outline
from cadpanel.reference.outline_sides import EVEN_PARTS, FOUR, Side


def part_sides(outlines: Sequence[Outline], tolerance: float) -> list[Outline]:
    """Part the sides of panels at the corners of other panels.

    Args:
        outlines: of all panels.
        tolerance: how far from a side a corner lies on it, mm; one this close to the side's end parts nothing.

    Returns:
        The outlines, those with junctions with more sides and so with more corners, which turn by nothing. A triangle
        with a single junction stays whole.
    """
    corners = np.array([side.points[0] for one in outlines for side in one.sides])
    owners = np.repeat(np.arange(len(outlines)), [len(one.sides) for one in outlines])
    tree = cKDTree(corners)
    parted = []
    for panel, one in enumerate(outlines):
        sides: list[Side] = []
        for side in one.sides:
            middle = side.points.mean(axis=0)
            reach = float(norm(side.points - middle).max()) + tolerance
            near = np.array(tree.query_ball_point(middle, reach), dtype=np.intp)
            sides += _parts(side, corners[near[owners[near] != panel]], tolerance)
        # A triangle with one junction would pass for a panel of two ends and two sides.
        keep = len(sides) == len(one.sides) or len(sides) == FOUR
        parted.append(one if keep else replace(one, sides=tuple(sides)))
    return parted


def _parts(side: Side, corners: Array, tolerance: float) -> list[Side]:
    """A side cut where (m, 3) corners lie on it."""
    edge = Edge(0, side.points, side.normals, arc_length(side.points))
    cuts = positions_on(edge, corners, tolerance) if len(corners) else []
    if not cuts:
        return [side]
    parts = []
    for start, stop in pairwise([0.0, *cuts, edge.length]):
        points, normals = edge.at(start + EVEN_PARTS * (stop - start))
        parts.append(Side(points=points, normals=unit(normals), length=float(arc_length(points)[-1])))
    return parts
