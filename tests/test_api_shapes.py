"""What is made of one shape is made of several, and of a result, as a list."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.brep.building.mass_properties import area_and_centroid, volume_and_centroid
from tests.delivered import fitted


def test_one_shape_gives_one_and_several_or_a_result_give_a_list_of_the_same() -> None:
    shapes = fitted().shapes
    flats, solids, skins = cp.unroll(shapes), cp.build_solid(list(shapes), 3.0), cp.build_skin(fitted())
    assert len(flats) == len(solids) == len(skins) == len(shapes)
    for shape, flat, solid, skin in zip(shapes, flats, solids, skins, strict=True):
        alone = cp.unroll(shape)
        assert np.allclose(alone.curves.start, flat.curves.start, atol=1e-9)
        assert volume_and_centroid(solid)[0] == volume_and_centroid(cp.build_solid(shape, 3.0))[0]
        assert area_and_centroid(skin)[0] == pytest.approx(shape.area(), rel=1e-9)
    (flat,) = cp.unroll(shapes[:1])
    assert flat.name == shapes[0].name


@pytest.mark.parametrize("make", [cp.unroll, cp.build_skin, lambda none: cp.build_solid(none, 3.0)])
def test_a_list_of_none_is_refused(make: Any) -> None:
    with pytest.raises(cp.SettingsError, match="there is no panel in the list"):
        make([])
