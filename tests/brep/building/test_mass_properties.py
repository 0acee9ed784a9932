"""The kernel's integrals of shapes whose volumes, areas and centroids are known."""

import numpy as np
import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone
from OCP.gp import gp_Pnt

from cadpanel.brep.building.mass_properties import (
    area_and_centroid,
    areas_and_centroids,
    middle_of,
    volume_and_centroid,
)
from cadpanel.brep.kernel.shapes import faces_of


def test_a_box_and_a_cone_are_what_textbooks_say():
    box = BRepPrimAPI_MakeBox(gp_Pnt(1.0, 2.0, 3.0), 10.0, 20.0, 30.0).Solid()
    volume, middle = volume_and_centroid(box)
    assert volume == pytest.approx(6000.0)
    assert middle == pytest.approx([6.0, 12.0, 18.0])
    area, centre = area_and_centroid(box)
    assert area == pytest.approx(2200.0)
    assert centre == pytest.approx([6.0, 12.0, 18.0])
    cone = BRepPrimAPI_MakeCone(3.0, 0.0, 4.0).Solid()
    volume, middle = volume_and_centroid(cone)
    assert volume == pytest.approx(12.0 * np.pi)
    assert middle == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    areas, centroids = areas_and_centroids(faces_of(cone))
    assert sorted(areas) == pytest.approx([9.0 * np.pi, 15.0 * np.pi])
    assert centroids[np.argmax(areas)] == pytest.approx([0.0, 0.0, 4.0 / 3.0], abs=1e-9)


def test_nothing_has_no_middle():
    assert np.isnan(middle_of(np.zeros(0), np.zeros((0, 3)))).all()
