"""Triangles of a solid are closed, within the chord of it, and look outwards."""

import numpy as np
import pytest

from cadpanel.brep.building.mass_properties import area_and_centroid
from cadpanel.brep.building.meshing import triangles_of
from cadpanel.brep.building.sheet import build_solid, volume_of
from cadpanel.geometry.triangles import is_closed, merged
from tests.shapes import CHAINS, random_panel
from tests.thorough import thorough


@pytest.mark.parametrize("chain", sorted(CHAINS))
@pytest.mark.parametrize("concave", [False, True])
def test_a_solid_as_triangles_is_closed_and_has_its_volume_within_the_chord(chain, concave):
    solid = build_solid(random_panel(5, chain=chain, concave=concave, mitre=0.3), 3.0)
    volume, (area, _) = volume_of(solid), area_and_centroid(solid)
    errors = []
    for chord in (2.0, 0.2):
        found = triangles_of(solid, chord)
        _, place = merged(found.points, 1e-5)
        assert is_closed(place[found.corners])
        errors.append(abs(found.volume() - volume))
        assert errors[-1] <= area * chord
        sides = found.points[found.corners]
        facets = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
        facing = np.einsum("ij,ikj->ik", facets, found.normals[found.corners])
        assert (facing > 0.0).all()
        assert np.linalg.norm(found.normals, axis=-1) == pytest.approx(np.ones(len(found.normals)))
    assert errors[1] <= errors[0] + 1e-6 * volume


@thorough
def test_the_solid_is_left_as_it_was():
    solid = build_solid(random_panel(5), 3.0)
    coarse = len(triangles_of(solid, 1.0).corners)
    assert len(triangles_of(solid, 0.001).corners) > coarse
    assert len(triangles_of(solid, 1.0).corners) == coarse
