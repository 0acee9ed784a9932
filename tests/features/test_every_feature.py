"""The laws that the walk of every shape feature obeys: of those in the catalogue and those that a user may compose."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.features.cut_planes import cut_planes
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.features.rulings import Rulings
from cadpanel.features.walk import arc_rulings, end_points
from cadpanel.geometry.cone import Skins, plane_distance
from cadpanel.geometry.vectors import cross, dot
from tests.chains import CHAINS, FEATURES, random_values, rulings_of, slopes

pytestmark = pytest.mark.each_value_once

# Lengths in panel lengths, angles in radians.
ROUNDING = 1e-12

few = settings(max_examples=5)
seeds = st.integers(0, 2**32 - 1)
every_feature = pytest.mark.parametrize("name", sorted(FEATURES))
every_chain = pytest.mark.parametrize("name", sorted(CHAINS))


def seen_from_anchor(walked, rulings):
    """The rulings' frames in the coordinates of the anchor ruling."""
    p, b, t, n = (getattr(walked.anchor, axis)[:, 0] for axis in "pbtn")
    axes = np.stack([b, t, n], axis=-1)[:, None]
    vectors = [getattr(rulings, axis) for axis in "btn"]
    return [(v[..., None, :] @ axes)[..., 0, :] for v in (rulings.p - p[:, None], *vectors)]


@every_feature
@few
@given(seed=seeds)
def test_frames_stay_right_handed_and_orthonormal(name, seed):
    walked = FEATURES[name].walk(random_values(FEATURES[name], seed), derivatives=False)
    for rulings in rulings_of(walked).values():
        axes = np.stack([rulings.b, rulings.t, rulings.n], axis=-1)
        assert np.swapaxes(axes, -1, -2) @ axes == pytest.approx(np.broadcast_to(np.eye(3), axes.shape), abs=ROUNDING)
        assert rulings.b == pytest.approx(cross(rulings.t, rulings.n), abs=ROUNDING)


@every_feature
@few
@given(seed=seeds)
def test_moving_the_anchor_moves_the_whole_panel_rigidly(name, seed):
    of = FEATURES[name]
    values = random_values(of, seed)
    place = sum(number.name.startswith(("anchor:", "plane:")) for number in of.numbers)
    moved = values.copy()
    moved[:, :place] += np.random.default_rng(seed).uniform(-0.5, 0.5, (len(values), place))
    before, after = (of.walk(v, derivatives=False) for v in (values, moved))
    for which, rulings in rulings_of(before).items():
        same = zip(seen_from_anchor(before, rulings), seen_from_anchor(after, rulings_of(after)[which]), strict=True)
        for one, other in same:
            assert one == pytest.approx(other, abs=ROUNDING)
    assert not np.allclose(before.anchor.p, after.anchor.p)
    if of.cuts == "square":
        # Cuts that stand square on the anchor ruling go with it, as a polygon's corners go with its plane.
        one, other = (
            seen_from_anchor(walked, SimpleNamespace(**dict.fromkeys("pbtn", of.corners(walked).position)))[0]
            for walked in (before, after)
        )
        assert one == pytest.approx(other, abs=1e-10)


def tangent_faults(walked, edges):
    """The largest distance of points on the inner rulings from the patches at either side, and the largest kink."""
    distance, kink = 0.0, 0.0
    feature_ = walked.feature
    for ruling in range(1, len(feature_.patches)):
        for along in (-0.5, -0.2, 0.0, 0.3, 0.5):
            x = (edges.p[:, ruling] + along * edges.t[:, ruling]).T[:, :, None]
            for patch in (ruling - 1, ruling):
                p, t, n = (getattr(walked.carriers, axis)[:, patch] for axis in "ptn")
                if feature_.patches[patch].kind == "plane":
                    apart, normal = plane_distance(x, p, n), n
                else:
                    radius, half_angle, _ = walked.dimensions[patch].values.T
                    cone = Skins.of_panels(p, t, n, radius, half_angle)
                    apart, normal = cone.distance(x), cone.normals(x)[..., 0].T
                distance = max(distance, np.abs(apart).max())
                kink = max(kink, np.linalg.norm(cross(normal, edges.n[:, ruling]), axis=-1).max())
    return distance, kink


@every_chain
@few
@given(seed=seeds)
def test_neighbouring_patches_share_their_tangent_plane_along_the_whole_ruling(name, seed):
    walked = FEATURES[name].walk(random_values(FEATURES[name], seed), derivatives=False)
    distance, kink = tangent_faults(walked, walked.edges)
    assert distance <= ROUNDING
    assert kink <= ROUNDING


def test_a_ruling_that_leaves_its_tangent_plane_by_a_little_is_found():
    walked = FEATURES["plane-cone-plane"].walk(random_values(FEATURES["plane-cone-plane"], 1), derivatives=False)
    tilted, turned = walked.edges.frames.copy(), walked.edges.frames.copy()
    tilted[:, :, 1] += 1e-9 * walked.edges.n
    assert tangent_faults(walked, Rulings(tilted, None))[0] > ROUNDING
    turned[:, :, 2] += 1e-9 * walked.edges.b
    assert tangent_faults(walked, Rulings(turned, None))[1] > ROUNDING


@every_chain
@few
@given(seed=seeds)
def test_corners_and_arc_points_lie_on_the_cut_planes_and_on_their_rulings(name, seed):
    walked = FEATURES[name].walk(random_values(FEATURES[name], seed), derivatives=False)
    m, s = cut_planes(walked)
    for rulings in (walked.edges, arc_rulings(walked)):
        points = end_points(walked, rulings)
        assert points.jacobian is None
        count = rulings.p.shape[1]
        by_end = points.position.reshape(len(m), 2, count, 3)
        assert dot(m[:, :, None], by_end) == pytest.approx(
            np.broadcast_to(s[..., None], by_end.shape[:-1]), abs=ROUNDING
        )
        off = cross(by_end - rulings.p[:, None], np.broadcast_to(rulings.t[:, None], by_end.shape))
        assert off == pytest.approx(0.0, abs=ROUNDING)


@every_chain
@few
@given(seed=seeds)
def test_arc_points_lie_inside_the_curved_patches(name, seed):
    walked = FEATURES[name].walk(random_values(FEATURES[name], seed), derivatives=False)
    curved = [i for i, one in enumerate(FEATURES[name].curved) if one]
    inside = arc_rulings(walked)
    assert inside.p.shape[1] == len(curved) * len(ARC_SHARES)
    for k, patch in enumerate(curved):
        normals = inside.n[:, k * len(ARC_SHARES) : (k + 1) * len(ARC_SHARES)]
        first, last = walked.edges.n[:, patch, None], walked.edges.n[:, patch + 1, None]
        chain = np.concatenate([first, normals, last], axis=1)
        turned = np.linalg.norm(np.diff(chain, axis=1), axis=-1)
        # Equal shares of the sweep, in the order of the walk.
        assert turned == pytest.approx(np.broadcast_to(turned[:, :1], turned.shape), rel=1e-9)


@every_feature
def test_walking_without_derivatives_gives_the_same_panels(name):
    values = random_values(FEATURES[name], 11)
    with_, without = (FEATURES[name].walk(values, derivatives=wanted) for wanted in (True, False))
    for which, rulings in rulings_of(with_).items():
        assert np.array_equal(rulings.p, rulings_of(without)[which].p)
        assert np.array_equal(rulings.n, rulings_of(without)[which].n)
    assert without.edges.twist is None


@every_feature
@few
@given(seed=seeds)
def test_panels_of_a_batch_do_not_touch_each_other(name, seed):
    values = random_values(FEATURES[name], seed, panels=4)
    corners = FEATURES[name].corners(FEATURES[name].walk(values, derivatives=True))
    for i in range(4):
        own = FEATURES[name].corners(FEATURES[name].walk(values[i : i + 1], derivatives=True))
        assert np.abs(corners.position[i] - own.position[0]).max() <= ROUNDING
        assert np.abs(slopes(corners)[i] - slopes(own)[0]).max() <= 1e-10


@every_feature
def test_every_corner_and_arc_point_lies_on_the_edges_that_name_it(name):
    of = FEATURES[name]
    assert len({edge.name for edge in of.edges}) == len(of.edges)
    assert {corner for edge in of.edges for corner in edge.corners} == set(range(of.corner_count))
    walked = of.walk(random_values(of, 2), derivatives=False)
    arcs = [arc for edge in of.edges for arc in edge.arcs]
    assert sorted(arcs) == list(range(of.arcs(walked).position.shape[1]))
    for edge in of.edges:
        assert len(edge.corners) == len(edge.curved) + 1
        assert len(edge.arcs) == len(ARC_SHARES) * sum(edge.curved)
        assert edge.straight == (edge.curved == (False,))


@every_chain
def test_ends_lie_on_their_cut_planes_and_sides_on_their_rulings(name):
    of = CHAINS[name]
    walked = of.walk(random_values(of, 4), derivatives=False)
    (m, s), corners, arcs = cut_planes(walked), of.corners(walked).position, of.arcs(walked).position
    ends, sides = of.edges[:2], of.edges[2:]
    for end, edge in enumerate(ends):
        for points in (corners[:, edge.corners], arcs[:, edge.arcs]):
            assert dot(m[:, end, None], points) == pytest.approx(
                s[:, end, None] + np.zeros(points.shape[:2]), abs=1e-12
            )
    for ruling, edge in zip((0, -1), sides, strict=True):
        along = corners[:, edge.corners[1]] - corners[:, edge.corners[0]]
        # From end 0 to end 1, along the ruling.
        assert dot(along, walked.edges.t[:, ruling]) == pytest.approx(np.linalg.norm(along, axis=-1), abs=ROUNDING)
