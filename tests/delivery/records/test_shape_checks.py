"""What a record says of a panel's shape besides its surfaces is that of the shape."""

import pytest

from cadpanel.delivery.records.shape_checks import shape_faults
from cadpanel.delivery.records.to_shape import recorded_shape
from cadpanel.geometry.sheet_checks import sheet_depth
from tests.flat_parts import SHEET, strip_records

DEPTH = sheet_depth(SHEET.thickness, SHEET.skin_side)


@pytest.fixture
def record():
    return strip_records()[0][1]


def faults(record):
    return list(shape_faults(record, recorded_shape(record, DEPTH), DEPTH))


def test_what_was_recorded_holds(record):
    assert faults(record) == []


def test_an_area_that_is_not_the_panels_is_named(record):
    (said,) = faults(record.model_copy(update={"area": record.area * (1.0 + 1e-7)}))
    assert "the report's area is" in said


@pytest.mark.parametrize("key", ["radius_min", "radius_max"])
def test_a_radius_that_is_not_the_patchs_is_named(record, key):
    patches = list(record.patches)
    place = next(i for i, patch in enumerate(patches) if patch.kind != "plane")
    patches[place] = patches[place].model_copy(update={key: getattr(patches[place], key) + 1e-4})
    (said,) = faults(record.model_copy(update={"patches": tuple(patches)}))
    assert f"(patch {place + 1}) is not that of its rulings" in said


def test_a_cone_is_straightened_by_no_more_than_its_size_allows(record):
    without, beyond = faults(record.model_copy(update={"moved": 1.0}))
    assert "straightened, and it has no cylinder" in without
    assert "straightened by 1 mm, one of its size moves by 0.0" in beyond


@pytest.mark.parametrize(("row", "corner"), [(0, 0), (0, 1), (1, 2)])
def test_a_fitted_corner_off_its_cut_or_its_ruling_is_named(record, row, corner):
    rows = [[list(one) for one in own] for own in record.fitted.corners]
    rows[row][corner][0] += 1.0
    moved = record.fitted.model_copy(update={"corners": tuple(tuple(map(tuple, own)) for own in rows)})
    said = faults(record.model_copy(update={"fitted": moved}))
    assert ["of the report's fitted panel lies" in one for one in said] == [True]


def other_ruling(rulings, place, **update):
    return (*rulings[:place], rulings[place].model_copy(update=update), *rulings[place + 1 :])


@pytest.mark.parametrize("place", range(4))
@pytest.mark.parametrize("of", ["panel", "fitted"])
def test_a_ruling_that_is_not_the_panels_is_named(record, place, of):
    own = record if of == "panel" else record.fitted
    x, y, z = own.rulings[place].point
    other = own.model_copy(update={"rulings": other_ruling(own.rulings, place, point=(x + 1e-3, y + 1e-3, z - 2e-3))})
    assert faults(other if of == "panel" else record.model_copy(update={"fitted": other}))


@pytest.mark.parametrize("key", ["radius", "half_angle", "sweep"])
@pytest.mark.parametrize("of", ["panel", "fitted"])
def test_a_bend_that_is_not_the_panels_is_named(record, key, of):
    own = record if of == "panel" else record.fitted
    changed = other_ruling(own.rulings, 1, **{key: getattr(own.rulings[1], key) * (1.0 + 1e-6)})
    other = own.model_copy(update={"rulings": changed})
    assert faults(other if of == "panel" else record.model_copy(update={"fitted": other}))
