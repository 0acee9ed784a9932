"""Where a bend is several cones, a fit may begin from those along the strip through the panel's tangent planes."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.features.catalogue import feature
from cadpanel.fitting.problem import pose
from cadpanel.fitting.samples import SampleArrays
from cadpanel.fitting.start.cone_strips import bends_in_cones, cone_strips
from cadpanel.fitting.start.frames import Given
from cadpanel.geometry.shape import PanelShape
from tests.instances import random_shapes
from tests.known_panels import alone

LENGTH = 2048.0


def given(reference, stretches=None):
    count = len(reference.panels)
    held = np.full((count, 2, 2), np.nan) if stretches is None else stretches
    samples = SampleArrays.of(reference)
    return Given(panels=reference.panels, source="arrays", samples=samples, length=LENGTH, stretches=held, ways=2)


def along(shapes: list[PanelShape]):
    return np.array([shape.directions[len(shape.directions) // 2] for shape in shapes])


@pytest.mark.parametrize("name", ["cone-spline-4", "plane-cone-cone-plane"])
def test_cones_along_the_strip_begin_nearer_than_what_is_rolled_between_the_ends(name):
    of = feature(name)
    problem, starts = pose(alone(*random_shapes(of, 5, 40)), [of] * 40)
    rolled, strip = (np.linalg.norm(problem.deviations(start)[0]) for start in starts)
    assert strip < 0.4 * rolled


def test_a_panel_that_is_one_cone_begins_all_but_there():
    of = feature("cone-spline-2")
    problem, (_, strip) = pose(alone(*random_shapes(feature("cone"), 5, 8)), [of] * 8)
    assert problem.deviations(strip)[0].max() < 0.05


def test_a_panel_that_waves_and_one_whose_bend_is_told_have_none():
    of = feature("plane-cone-cone-plane")
    shapes = random_shapes(of, 5, 3)
    reference = alone(*shapes)
    told = np.full((3, 2, 2), np.nan)
    told[1] = 100.0, 300.0
    wave = reference.panels[0]
    across = np.cross(along(shapes)[0], wave.normals.mean(axis=0))
    normals = wave.normals.mean(axis=0) + 0.3 * np.sin(wave.points @ across / 50.0)[:, None] * across
    normals /= np.linalg.norm(normals, axis=-1)[:, None]
    waved = replace(reference, panels=(replace(wave, normals=normals), *reference.panels[1:]))
    assert [cones is None for cones in cone_strips(of, given(waved, told), along(shapes))] == [True, True, False]


def test_only_one_bend_of_cones_that_are_free_is_told_by_a_strip():
    found = {
        name: bends_in_cones(feature(name)) for name in ("cone-spline-2", "plane-cone-cone-plane", "cone-spline-6")
    }
    assert all(found.values())
    for name in ("cone", "tri-cone", "plane-cone-plane", "plane-cone-plane-cone-plane", "planar-quadrilateral"):
        assert not bends_in_cones(feature(name))
