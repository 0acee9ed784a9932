"""What the fixtures deliver stays what it was, to 1e-9 mm, on any processor and through any change of the house."""

import pytest

from tests.delivered_numbers import CLOSE, FIXTURES, Tree, delivered, differences, kept


@pytest.mark.parametrize("fixture", FIXTURES)
def test_delivered_numbers_are_those_that_were_kept(fixture):
    moved = {place: by for place, by in differences(kept()[fixture], delivered(fixture)) if by > CLOSE}
    assert moved == {}


def test_differences_are_found_wherever_they_are():
    old: Tree = {"a": [1.0, {"b": 2.0}], "c": "x", "d": 1}
    assert max(by for _, by in differences(old, old)) == 0.0
    moved: Tree = {"a": [1.0, {"b": 2.0 + 1e-6}], "c": "x", "d": 1}
    assert dict(differences(old, moved))["/a/1/b"] == pytest.approx(5e-7)
    assert dict(differences(old, {"a": [1.0], "c": "y", "e": 1})) == dict.fromkeys(("/a", "/c", "/d"), float("inf"))
