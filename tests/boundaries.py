"""Panels whose boundaries are compared, and the same boundary in another order."""

from dataclasses import replace

import numpy as np

from cadpanel.brep.proof.boundary import Boundary
from cadpanel.geometry.shape import PanelShape, PolygonShape
from tests.instances import random_polygon
from tests.shapes import folded_panel

SHAPES: dict[str, PanelShape | PolygonShape] = {
    "folded": folded_panel(),
    "conical": folded_panel(half_angle=0.2),
    "polygon": random_polygon(7, 5),
}


def shuffled(own: Boundary, seed: int = 1) -> Boundary:
    """The same with vertices, edges and faces in another order, and every edge the other way."""
    random = np.random.default_rng(seed)
    faces = random.permutation(len(own.surfaces))
    of = np.append(np.argsort(faces), -1)[own.edge_faces]
    edges = random.permutation(len(own.edges))
    return replace(
        own,
        vertices=random.permutation(own.vertices),
        edges=own.edges[edges, ::-1],
        edge_faces=of[edges],
        surfaces=own.surfaces[faces],
    )
