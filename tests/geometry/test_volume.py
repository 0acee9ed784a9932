"""Areas and volumes against closed forms and laws."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.volume import patch_areas, quadratic_area, sheet_volume
from tests.joined import leaning
from tests.shapes import CHAINS, folded_panel, moved, random_panel

RELATIVE = 1e-13

panels = st.builds(
    random_panel,
    st.integers(0, 10_000),
    chain=st.sampled_from(sorted(CHAINS)),
    concave=st.booleans(),
    mitre=st.just(0.5),
)


def test_a_folded_cylinder_has_the_volume_of_two_plates_and_a_sector():
    expected = 1000.0 * (2 * 200.0 * 3.0 + 0.5 * 1.0 * (200.0**2 - 197.0**2))
    assert sheet_volume(folded_panel(), 3.0) == pytest.approx(expected, rel=RELATIVE)
    outside = 1000.0 * (2 * 200.0 * 3.0 + 0.5 * 1.0 * (203.0**2 - 200.0**2))
    assert sheet_volume(folded_panel(), 3.0, "inner") == pytest.approx(outside, rel=RELATIVE)


def test_a_frustum_has_the_area_of_its_development():
    half_angle, sweep = 0.2, 1.2
    shape = folded_panel(chain="c", widths=(), turns=(), radius=400.0, half_angle=half_angle, sweep=sweep)
    axis = np.array([math.cos(half_angle), 0.0, -math.sin(half_angle)])
    shape = replace(shape, cut_normals=np.array([axis, axis]))
    distances = [400.0 / math.tan(half_angle) + height for height in (-500.0, 500.0)]
    expected = 0.5 * sweep * math.sin(half_angle) * (distances[1] ** 2 - distances[0] ** 2)
    assert shape.area() == pytest.approx(expected, rel=RELATIVE)


@given(panels)
def test_a_sheet_has_one_volume_from_whichever_skin_it_is_measured(shape):
    assert sheet_volume(shape, 5.0) == pytest.approx(sheet_volume(shape.offset(-5.0), 5.0, "inner"), rel=1e-12)


@given(panels)
def test_moving_a_panel_keeps_its_area_and_volume(shape):
    away = moved(shape, (1234.5, -99.0, 7.0))
    assert away.area() == pytest.approx(shape.area(), rel=1e-12)
    assert sheet_volume(away, 3.0) == pytest.approx(sheet_volume(shape, 3.0), rel=1e-11)


@given(panels)
def test_a_thin_sheet_has_the_volume_of_its_skin_times_its_thickness(shape):
    assert sheet_volume(shape, 1e-4) == pytest.approx(1e-4 * shape.area(), rel=1e-5)


@given(st.integers(0, 1000))
def test_the_area_is_continuous_where_the_cone_becomes_a_cylinder(seed):
    areas = [random_panel(seed, chain="cone", half_angle=angle).area() for angle in (0.0, 1e-12, -1e-12)]
    assert areas == pytest.approx([areas[0]] * 3, rel=1e-10)


@given(panels)
def test_every_patch_has_area(shape):
    areas = patch_areas(shape)
    assert len(areas) == len(shape.patches)
    assert min(areas) > 0.0
    assert all(isinstance(patch, ConePatch) or area > 1.0 for patch, area in zip(shape.patches, areas, strict=True))


@given(*4 * [st.floats(-10.0, 10.0)])
def test_of_a_quadratic_both_ends_and_the_mean_tell_all(constant, slope, bend, share):
    near, far, mean = constant, constant + slope + bend, constant + slope / 2.0 + bend / 3.0
    assert quadratic_area(near, far, mean, share) == pytest.approx(constant + slope * share + bend * share**2, abs=1e-9)


def test_under_a_leaning_side_a_bent_cylinder_is_as_large_as_many_thin_layers():
    shape = folded_panel(chain="c", widths=(), turns=(), radius=60.0, sweep=1.2)
    planes = {f"side {side}": leaning(shape, f"side {side}", 5.0, 1.2 - 1.5 * side) for side in (0, 1)}
    cut = shape.cut_back(planes, 40.0)
    steps = 40.0 * (np.arange(4000) + 0.5) / 4000
    layers = sum(cut.offset(float(step)).area() for step in steps) * 40.0 / 4000
    assert sheet_volume(cut, 40.0, "inner") == pytest.approx(layers, rel=1e-9)
