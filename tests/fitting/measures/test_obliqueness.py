"""Ends that are too oblique to be built are told for all panels at once, as the builder tells them one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.features.catalogue import feature
from cadpanel.fitting.measures.obliqueness import too_oblique
from tests.instances import random_polygon, random_shapes


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
    assert not too_oblique([random_polygon(4, 5), *shapes]).any()


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
    found = too_oblique(cases)
    assert any(told)
    assert not all(told)
    # Another fault may be refused before: then it is told of obliqueness all the same.
    assert found[np.array(told)].all()
    for case, oblique in zip(cases, found, strict=True):
        if oblique:
            with pytest.raises(PanelError):
                case.check()


def test_a_cone_of_more_than_its_share_is_the_smallest_that_is_refused():
    (shape,) = random_shapes(feature("cone"), 1, 1)
    angles = np.linspace(0.0, 1.56, 400)
    found = too_oblique([leaned(shape, angle, shape.binormals()[0]) for angle in angles])
    assert not found[0]
    assert found[-1]
