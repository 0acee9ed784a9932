"""What is seen to be the same at once is what `difference` finds to be the same, shape by shape."""

from dataclasses import replace

import numpy as np

from cadpanel.brep.building.sheet import build_panel
from cadpanel.brep.proof.boundary import Boundary, difference
from cadpanel.brep.proof.inspection import boundary_of
from cadpanel.brep.proof.same_boundaries import same_boundaries
from tests.boundaries import SHAPES, shuffled


def wanted():
    """Solids and skins of every kind of panel."""
    built = [build_panel(shape, 3.0) for shape in SHAPES.values()]
    return [boundary_of(shape) for panel in built for shape in (panel.solid, panel.skin)]


def changes(own):
    """The same boundary with one thing about it changed by more than is one."""
    vertices, edges, faces, surfaces = (
        own.vertices.copy(), own.edges.copy(), own.edge_faces.copy(), own.surfaces.copy(),
    )  # fmt: skip
    vertices[0, 2] += 1e-5
    edges[1, 1, 0] += 1e-5  # neither an end nor the middle
    faces[[0, -1]] = faces[[-1, 0]]
    surfaces[-1, 8] *= -1.0
    moved = own.surfaces.copy()
    moved[0, :3] += 1e-5 * moved[0, 3:6]
    unknown = own.surfaces.copy()
    unknown[0] = np.nan
    yield from (replace(own, vertices=vertices), replace(own, edges=edges), replace(own, edge_faces=faces))
    yield from (replace(own, surfaces=surfaces), replace(own, surfaces=moved), replace(own, surfaces=unknown))


def test_all_in_any_order_are_the_same():
    own = wanted()
    assert same_boundaries(own, own).all()
    assert same_boundaries([shuffled(one, seed) for seed, one in enumerate(own)], own).all()


def test_every_change_of_one_is_seen_in_that_one_alone():
    own = wanted()
    for place, one in enumerate(own):
        for changed in changes(one):
            found = [*own[:place], changed, *own[place + 1 :]]
            alike = [difference(first, second) is None for first, second in zip(found, own, strict=True)]
            assert same_boundaries(found, own).tolist() == alike


def test_what_has_other_numbers_of_parts_or_none_is_left_to_difference():
    solid, skin = wanted()[:2]
    empty = Boundary(
        vertices=np.empty((0, 3)), edges=np.empty((0, 5, 3)),
        edge_faces=np.empty((0, 2), dtype=np.intp), surfaces=np.empty((0, 9)),
    )  # fmt: skip
    assert not same_boundaries([solid, empty], [skin, empty]).any()
    assert same_boundaries([], []).tolist() == []
