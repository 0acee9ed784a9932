from __future__ import annotations

from pathlib import Path

from cadpanel.brep.isolation.processors import given_processors, processors, usable
from cadpanel.brep.isolation.requests import work_request
from cadpanel.reference.settings import ReferenceSettings


def test_work_keeps_as_many_processors_busy_as_it_is_given():
    assert processors() == usable() >= 1
    with given_processors(3):
        assert processors() == 3
        with given_processors(1):
            assert processors() == 1
        assert processors() == 3
    assert processors() == usable()


def test_what_is_asked_of_the_second_interpreter_says_how_many():
    with given_processors(7):
        assert work_request("panels", Path("one.step"), ReferenceSettings()).processors == 7
