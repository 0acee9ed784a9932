"""A polygon starts in the plane of its samples, with its corners where they are, on the side that faces out."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.polygon import Polygon
from cadpanel.fitting.samples import SampleArrays
from cadpanel.fitting.start.frames import Given
from cadpanel.fitting.start.polygons import start_polygons
from tests.instances import random_polygon
from tests.known_panels import alone

LENGTH = 1000.0


@settings(max_examples=20)
@given(seed=st.integers(0, 10_000))
def test_the_corners_of_a_flat_panel_are_found_exactly(seed):
    reference = alone(random_polygon(seed, 5))
    (panel,) = reference.panels
    told = Given(
        panels=[panel],
        source=reference.source,
        samples=SampleArrays.of(reference),
        length=LENGTH,
        stretches=np.full((1, 2, 2), np.nan),
        ways=1,
    )
    frames = start_polygons(Polygon(5), told)
    origin, axes, (numbers,) = frames.origins[0], frames.axes[0], frames.values
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) > 0.0
    flat = np.column_stack([numbers[0, 3:].reshape(-1, 2), np.zeros(len(panel.corners))])
    np.testing.assert_allclose(origin + LENGTH * flat @ axes.T, panel.corners, atol=1e-6)
    assert numbers[0, :3].tolist() == [0.0, 0.0, 0.0]
