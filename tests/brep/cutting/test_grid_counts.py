"""Grids by the size of their panels."""

import numpy as np
import pytest
from OCP.Geom import Geom_CylindricalSurface
from OCP.gp import gp_Ax3

from cadpanel.brep.cutting.grid_counts import counts_within
from cadpanel.brep.faces.face_patch import lengths_along
from tests.cuts import assert_covers, model_of, panels_of, reference_of, surface_of
from tests.known_faces import face_on, flat
from tests.reference_shapes import kernel_face
from tests.thorough import cases, thorough


def sheet(x, width, length=4000.0, bend=0.0):
    """A sheet from x on, of a width along u and a length along v, that bends along v."""

    def surface(u, v):
        y = length * v
        return np.stack([x + width * u, y, bend * np.sin(np.pi * v)], axis=-1)

    return kernel_face(surface, (0.0, 1.0), poles=16)


@pytest.mark.parametrize("by", ["length", "parameter"])
@pytest.mark.parametrize(
    "size", cases([(501.0, 799.0)], [(500.0, 800.0), (501.0, 799.0), (250.0, 5000.0), (3000.0, 300.0)])
)
@thorough
def test_panels_are_the_fewest_of_which_none_is_larger_either_way(size, by):
    face = sheet(0.0, 1500.0, bend=900.0)
    ((u, v),) = counts_within(surface_of(face), size, by, "roof.step")
    panels = panels_of(model_of(face), panel_size=size, by=by)
    assert len(panels) == u * v
    assert_covers(panels, [face])
    for counts, fits in (((u, v), True), ((u - 1, v), u == 1), ((u, v - 1), v == 1)):
        if min(counts) < 1:
            continue
        pieces = panels_of(model_of(face), grid=counts, by=by)
        ends = np.array([0.0, 0.5, 1.0])
        widest = [
            max(
                float(lengths_along(one.patch, axis, ends)[:, -1].max())
                for p in pieces
                for one in surface_of(*p.faces).faces
            )
            for axis in (0, 1)
        ]
        assert (widest[0] <= size[0] * 1.001 and widest[1] <= size[1] * 1.001) == fits


def test_faces_beside_each_other_have_as_many_along_their_border_and_each_its_own_across(tmp_path):
    faces = [sheet(0.0, 900.0), sheet(900.0, 200.0)]
    assert counts_within(surface_of(*faces), (500.0, 1000.0), "length", "roof.step") == [(2, 4), (1, 4)]
    reference = reference_of(tmp_path, *faces, panel_size=(500.0, 1000.0))
    assert len(reference.panels) == 12
    assert len(reference.seams) == 3 * 3 + 2 * 4  # within the three rows, and between them


def test_the_smaller_size_counts_where_u_runs_along_v():
    turned = kernel_face(lambda u, v: np.stack([900.0 + 600.0 * v, 4000.0 * u, 0.0 * u], axis=-1), (0.0, 1.0), poles=8)
    counts = counts_within(surface_of(sheet(0.0, 900.0), turned), (500.0, 1000.0), "length", "roof.step")
    assert counts == [(2, 8), (8, 1)]


def test_a_closed_face_has_as_many_as_it_needs_to_have_corners():
    tube = face_on(Geom_CylindricalSurface(gp_Ax3(), 300.0), (0.0, 2.0 * np.pi), (0.0, 1000.0))
    assert counts_within(surface_of(tube), (1e4, 1e4), "length", "roof.step") == [(2, 1)]


def test_a_trimmed_face_is_counted_by_its_whole_range():
    triangle = flat([(0, 0, 0), (2000, 0, 0), (0, 1000, 0)])
    ((u, v),) = counts_within(surface_of(triangle), (600.0, 600.0), "length", "roof.step")
    assert sorted((u, v)) == [2, 4]
