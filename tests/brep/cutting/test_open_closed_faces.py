"""Faces that meet themselves are halved, in each way in which they do, and keep their area; others stay as they are."""

import numpy as np
import pytest
from OCP.Geom import Geom_ToroidalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt

from cadpanel.brep.cutting.open_closed_faces import opened
from cadpanel.brep.splitting.splitter import area_of
from tests.cuts import surface_of
from tests.known_faces import arc_face, face_on


def torus():
    return face_on(Geom_ToroidalSurface(gp_Ax3(gp_Pnt(), gp_Dir(0.0, 0.0, 1.0)), 900.0, 300.0))


@pytest.mark.parametrize(
    ("face", "parts"),
    [(arc_face(500.0, 0.0, 360.0), 2), (torus(), 4), (arc_face(500.0, 0.0, 355.0), 1)],
    ids=["tube", "torus", "open"],
)
def test_a_face_has_as_many_parts_as_it_closes_ways_and_none_of_them_closes(face, parts):
    surface = surface_of(face)
    found = opened(surface, "roof.step")
    assert len(found.faces) == parts
    assert (found is surface) == (parts == 1)
    assert not any(one.patch.closed(axis) for one in found.faces for axis in (0, 1))
    assert sum(area_of(one.patch.face) for one in found.faces) == pytest.approx(area_of(face), rel=1e-6)
    assert {one.number for one in found.faces} == {1}
    if parts > 1:
        assert found.contacts == ()


def test_halves_of_a_reversed_tube_keep_its_side():
    found = opened(surface_of(arc_face(500.0, 0.0, 360.0).Reversed()), "roof.step")
    assert [one.patch.side for one in found.faces] == [-1.0, -1.0]
    spans = sorted(one.patch.bounds[0].tolist() for one in found.faces)
    np.testing.assert_allclose(spans, [(0.0, np.pi), (np.pi, 2.0 * np.pi)])
