"""The axis about which normals turn."""

import numpy as np
import pytest

from cadpanel.features.catalogue import feature
from cadpanel.fitting.samples import SampleArrays
from cadpanel.fitting.start.axes import turning_axes
from tests.instances import random_shapes
from tests.known_panels import alone


def test_normals_of_a_cone_enclose_one_angle_with_its_axis_and_a_flat_panel_has_its_way():
    cones, flat = (alone(*random_shapes(feature(name), 3, 4)) for name in ("cone", "planar-rectangle"))
    samples = SampleArrays.of(cones)
    axes = turning_axes(cones.panels, samples)
    assert np.ptp(np.einsum("pmx,px->pm", samples.normals, axes), axis=1) == pytest.approx(0.0, abs=1e-9)
    for axis, panel in zip(turning_axes(flat.panels, SampleArrays.of(flat)), flat.panels, strict=True):
        corners = panel.corners
        way = (corners[1] - corners[0]).mean(axis=0)
        assert axis @ way > 0.7 * np.linalg.norm(way)
