"""Ends that are too oblique to be built are told for all panels at once, as the builder tells them one by one."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.features.catalogue import feature
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.terms.limits.obliqueness import Obliqueness, ObliquenessTerm
from tests.chains import FEATURES, made_problem, mixed_unknowns
from tests.instances import random_polygon, random_shapes

LIMIT = Obliqueness()


def kept(shapes):
    return LIMIT.kept(cast("Any", SimpleNamespace(shapes=shapes)), LIMIT.default)


def leaned(shape, angle, about):
    """The panel with its first cut plane leaned by an angle about an axis through the plane's point."""
    normals = shape.cut_normals.copy()
    m = normals[0]
    way = np.cross(about, m)
    way /= np.linalg.norm(way)
    normals[0] = np.cos(angle) * m + np.sin(angle) * way
    return replace(shape, cut_normals=normals)


def refused(shape):
    try:
        shape.check()
    except PanelError as error:
        return "too oblique" in str(error) or "nearly parallel" in str(error)
    return False


def test_panels_that_can_be_built_are_not_too_oblique():
    shapes = [*random_shapes(feature("plane-cone-plane"), 4, 5), *random_shapes(feature("tri-cone"), 4, 5)]
    assert kept([random_polygon(4, 5), *shapes]).all()


@pytest.mark.parametrize("name", ["cone", "plane-cone-plane", "plane-cone-cone-plane", "cylinder"])
def test_it_says_what_the_builder_says_however_far_an_end_leans(name):
    shapes = random_shapes(feature(name), 7, 3)
    cases = [
        leaned(shape, angle, axis)
        for shape in shapes
        for angle in np.linspace(0.0, 1.5, 31)
        for axis in (shape.normals[0], shape.binormals()[0])
    ]
    told = [refused(case) for case in cases]
    found = ~kept(cases)
    assert any(told)
    assert not all(told)
    # Another fault may be refused before: then it is told of obliqueness all the same.
    assert found[np.array(told)].all()
    for case, oblique in zip(cases, found, strict=True):
        if oblique:
            with pytest.raises(PanelError):
                case.check()


@pytest.mark.parametrize("name", ["plane-cone-plane", "cylinder", "tri-cone"])
def test_what_is_held_is_what_is_measured_a_little_squarer(name):
    """Of panels cut ever more obliquely none that is refused is held, and of those not held few would pass."""
    problem = made_problem(FEATURES[name], 5, panels=60)
    unknowns = mixed_unknowns(problem.layout, 5)
    (of,) = {group.feature for group in problem.layout.groups}
    slopes = [list(of.free).index(number) for number in of.cut_numbers[:, 1:].reshape(-1) if number in of.free]
    random = np.random.default_rng(2)
    unknowns[:, slopes] = np.linspace(0.0, 12.0, 60)[:, None] * random.uniform(-1.0, 1.0, (60, len(slopes)))
    (term,) = (one for one in problem.limits(FitSettings()) if isinstance(one, ObliquenessTerm))
    held = (term.hold.ratio(term.vectors(problem.state(unknowns))) <= 1.0).all(axis=1)
    built = kept(panel_shapes(problem, unknowns))
    assert 5 < held.sum() < 55
    assert built[held].all()
    assert (built & ~held).sum() <= 6


@pytest.mark.parametrize(
    "name", ["plane-cone-plane", "planar-quadrilateral", "tri-cone", "cone-plane, cut square", "own double fold"]
)
def test_the_terms_jacobian_agrees_with_finite_differences(name):
    problem = made_problem(FEATURES[name], 5, panels=2)
    unknowns = mixed_unknowns(problem.layout, 5)
    (term,) = (one for one in problem.limits(FitSettings()) if isinstance(one, ObliquenessTerm))
    values, (exact,) = term.linear(problem.state(unknowns, derivatives=True))
    assert values == pytest.approx(term.vectors(problem.state(unknowns)), abs=1e-14)
    for column, step in enumerate(1e-6 * np.eye(unknowns.shape[1])):
        ahead, behind = (term.vectors(problem.state(unknowns + side * step)) for side in (1.0, -1.0))
        assert exact[..., column] == pytest.approx((ahead - behind) / 2e-6, abs=1e-8)


def test_an_end_that_is_cut_square_has_no_greater_angle_than_a_right_one():
    """Also where rounding makes the sine of it more than 1."""
    random = np.random.default_rng(1)
    ways = random.normal(size=(50, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    way = ways[np.argmax(np.einsum("gx,gx->g", ways, ways))]
    assert way @ way > 1.0
    (shape,) = random_shapes(feature("cylinder"), 1, 1)
    square = replace(shape, directions=np.tile(way, (2, 1)), cut_normals=np.tile(way, (2, 1)))
    measured = LIMIT.measure(cast("Any", SimpleNamespace(shapes=[square])))
    assert measured == pytest.approx([90.0], abs=1e-12)
