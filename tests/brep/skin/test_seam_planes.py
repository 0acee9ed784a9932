"""Which planes divide a strip: square to it, level, or turned."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.brep.skin.seam_planes import LEAST_RISE, level_planes, seam_planes
from cadpanel.brep.skin.strip import Strip, find_strip
from cadpanel.errors import ReferenceFileError
from tests.cuts import surface_of
from tests.roof_edges import roof_edge

WHAT = "the surface of face 1 of 'tower.step'"


def rising(degrees, length=6000.0, sway=0.0):
    """A strip that rises by an angle, faster and slower by another one in turn, degrees."""
    x = np.linspace(0.0, length, 400)
    angle = np.radians(degrees + sway * np.sin(x / 600.0))
    step = x[1] - x[0]
    middle = np.stack([np.cos(angle), 0.0 * x, np.sin(angle)], axis=-1).cumsum(axis=0) * step
    return Strip(edges=(middle, middle + np.array([0.0, 800.0, 0.0])), girth=800.0)


@settings(max_examples=15)
@given(degrees=st.floats(30.0, 90.0), sway=st.floats(0.0, 8.0), count=st.integers(2, 12), down=st.booleans())
def test_level_planes_are_level_and_at_equal_heights(degrees, sway, count, down):
    strip = rising(degrees, sway=sway)
    if down:
        strip = Strip(edges=(strip.edges[0][::-1], strip.edges[1][::-1]), girth=strip.girth)
    cuts = level_planes(strip, WHAT)(count)
    side = -1.0 if down else 1.0
    np.testing.assert_allclose(cuts.normals, np.tile([0.0, 0.0, side], (count - 1, 1)))
    heights = np.concatenate([[strip.edges[0][0, 2]], cuts.origins[:, 2], [strip.edges[0][-1, 2]]])
    np.testing.assert_allclose(np.diff(heights), np.diff(heights).mean(), rtol=1e-3)
    assert (np.diff(cuts.places) >= 0.0).all()
    assert (cuts.reach >= 0.5 * strip.girth).all()


def test_a_strip_that_is_too_flat_somewhere_is_refused_with_its_slope():
    assert level_planes(rising(LEAST_RISE + 1.0), WHAT)(3).normals.shape == (2, 3)
    with pytest.raises(ReferenceFileError, match=r"^The surface .* rises by 19 degrees where it is flattest"):
        level_planes(rising(LEAST_RISE - 1.0), WHAT)
    with pytest.raises(ReferenceFileError, match="rises by -2 degrees"):
        level_planes(rising(3.0, sway=5.0), WHAT)


@pytest.mark.parametrize("kind", ["square", "conjugate"])
def test_planes_stand_midway_between_the_edges_at_equal_parts(kind):
    surface = surface_of(*roof_edge())
    strip = find_strip(surface, "roof.step", 1.0)
    cuts = seam_planes(kind, strip, surface, np.radians(15.0), WHAT)(6)
    parts = np.arange(1, 6) / 6
    np.testing.assert_allclose(cuts.origins, strip.points(parts).mean(axis=0))
    turned = np.degrees(np.arccos(np.clip(np.sum(cuts.normals * strip.frames(parts)[:, 0], axis=1), -1.0, 1.0)))
    if kind == "square":
        np.testing.assert_allclose(turned, 0.0, atol=1e-5)
    else:
        assert ((turned > 10.0) & (turned < 15.0 + 1e-6)).all()


def test_panels_lengths_are_those_between_the_planes_along_both_edges():
    strip = rising(90.0)
    flat = Strip(edges=(strip.edges[0], strip.edges[1]), girth=strip.girth)
    np.testing.assert_allclose(
        flat.lengths_between(flat.planes(np.array([0.25, 0.5]))), [[1500.0, 1500.0, 3000.0]] * 2, rtol=5e-3
    )
    turn = np.radians(20.0)
    normals = np.array([[0.0, np.sin(turn), np.cos(turn)]])
    lengths = strip.lengths_between(strip.planes(np.array([0.5]), normals))
    off = 400.0 * np.tan(turn)
    np.testing.assert_allclose(lengths[:, 0], [3000.0 + off, 3000.0 - off], rtol=5e-3)
    np.testing.assert_allclose(lengths.sum(axis=1), strip.length)
