"""Names sort as the panels lie, and a middle lies in the middle."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.brep.cutting.cut_panel import along_name, along_panels, grid_name, middle_of
from tests.known_faces import flat


@given(count=st.integers(1, 2000))
def test_names_along_a_strip_sort_in_its_order_and_all_differ(count):
    names = [along_name("S1", place, count) for place in range(count)]
    assert names == sorted(set(names))
    assert names[0] == "S1-" + "1".zfill(max(2, len(str(count))))


@pytest.mark.parametrize(
    ("place", "name"), [((0, 0), "roof-R01-C001"), ((8, 9), "roof-R09-C010"), ((11, 99), "roof-R12-C100")]
)
def test_names_of_a_grid_have_as_many_digits_as_their_rows_and_columns(place, name):
    assert grid_name("roof", place[0], place[1], (12, 100)) == name


def test_panels_take_their_groups_of_faces_in_order():
    faces = [flat([(x, 0, 0), (x + 100, 0, 0), (x + 100, 50, 0), (x, 50, 0)]) for x in (0, 100, 200)]
    panels = along_panels("S1", [faces[:2], faces[2:]])
    assert [(panel.name, panel.faces) for panel in panels] == [("S1-01", tuple(faces[:2])), ("S1-02", (faces[2],))]
    np.testing.assert_allclose(middle_of(faces[:2]), (100.0, 25.0, 0.0))
    np.testing.assert_allclose(middle_of(faces[2:]), (250.0, 25.0, 0.0))
