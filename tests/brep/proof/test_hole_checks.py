"""Holes in a solid are seen where they are missing, too many, too wide, elsewhere, or too near to an edge."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from cadpanel.brep.building.sheet import build_panel
from cadpanel.brep.proof.hole_checks import ExpectedHoles, check_holes
from cadpanel.brep.proof.inspection import inspect
from cadpanel.delivery.settings import SheetSettings
from cadpanel.geometry.panel import Panel
from tests.drilled import fixed
from tests.flat_panels import panels

SHEET = SheetSettings()


@pytest.fixture(scope="module")
def panel() -> Panel:
    return panels("plane-cone-plane", 3)[0]


@pytest.fixture(scope="module")
def solid(panel: Panel) -> Any:
    return inspect("A", build_panel(panel, 3.0, "outer", fixed(panel, SHEET)[1]).solid)


@pytest.fixture(scope="module")
def expected(panel: Panel) -> ExpectedHoles:
    found, _ = fixed(panel, SHEET)
    return ExpectedHoles(
        pattern=found.pattern,
        places=found.places,
        patches=tuple(hole.patch for hole in found.found.holes),
        middles=found.middles,
        diameter=found.rule.diameter,
        distance=found.rule.distance,
        depth=-3.0,
        skin_area=found.skin_area,
    )


def test_the_holes_that_are_expected_are_found(expected: ExpectedHoles, solid: Any) -> None:
    failures: list[str] = []
    assert check_holes("A", expected, solid, failures) < 1e-9
    assert failures == []


def test_what_is_not_as_expected_is_said(expected: ExpectedHoles, solid: Any) -> None:
    moved = expected.middles.copy()
    moved[3] += [2e-6, 0.0]
    swapped = expected.middles.copy()
    swapped[0] = swapped[1]
    cases = (
        (None, solid, "rims of holes, expected 0"),
        (expected, replace(solid, rims=solid.rims[:-1]), "rims of holes, expected"),
        (replace(expected, diameter=30.0 + 4e-6), solid, "a hole in its solid lies"),
        (replace(expected, middles=moved), solid, "a hole in its solid lies"),
        (replace(expected, middles=swapped), solid, "a hole in its solid lies inf mm off"),
        (replace(expected, depth=-3.00001), solid, "a hole in its solid lies"),
        (replace(expected, distance=41.0), solid, "40 mm from an edge or a bend, 41 mm were asked for"),
    )
    for wanted, found, said in cases:
        failures: list[str] = []
        check_holes("A", wanted, found, failures)
        assert len(failures) == 1, said
        assert said in failures[0]
