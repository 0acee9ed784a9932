"""The laws that every shape feature obeys: those of the catalogue and those that a user may compose."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import CATALOGUE, feature
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Cylinder, Plane
from cadpanel.features.walk import ARC_SHARES, Rulings, cut_planes, pierce, walk
from cadpanel.fitting.shapes import end_curves, panel_shapes
from cadpanel.geometry.cone import cone_distance, cone_normal, plane_distance
from cadpanel.geometry.frames import cross, dot
from cadpanel.geometry.shape import ConePatch
from tests.chains import COMPOSED, FEATURES, made_problem, random_unknowns, random_values, slopes

# Lengths in panel lengths, angles in radians.
ROUNDING = 1e-12
# Central differences of functions of size 1 with this step agree to the tolerance, relative to the largest derivative.
STEP = 1e-6
DIFFERENCES = 1e-6
# A direction of the unknowns that moves nothing has a singular value below this share of the largest.
NO_MOTION = 1e-8
# Millimetres, at coordinates of some metres.
SAME_POINT = 1e-9

few = settings(max_examples=5)
seeds = st.integers(0, 2**32 - 1)
every_feature = pytest.mark.parametrize("name", sorted(FEATURES))


def rulings_of(walked):
    return {"anchor": walked.anchor, "edges": walked.edges, "carriers": walked.carriers, "arcs": walked.arcs}


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
    walked = walk(FEATURES[name], random_values(FEATURES[name], seed), derivatives=False)
    for rulings in rulings_of(walked).values():
        axes = np.stack([rulings.b, rulings.t, rulings.n], axis=-1)
        assert np.swapaxes(axes, -1, -2) @ axes == pytest.approx(np.broadcast_to(np.eye(3), axes.shape), abs=ROUNDING)
        assert rulings.b == pytest.approx(cross(rulings.t, rulings.n), abs=ROUNDING)


@every_feature
@few
@given(seed=seeds)
def test_moving_the_anchor_moves_the_whole_chain_rigidly(name, seed):
    values = random_values(FEATURES[name], seed)
    moved = values.copy()
    moved[:, :5] += np.random.default_rng(seed).uniform(-0.5, 0.5, (len(values), 5))
    before, after = (walk(FEATURES[name], v, derivatives=False) for v in (values, moved))
    for which, rulings in rulings_of(before).items():
        same = zip(seen_from_anchor(before, rulings), seen_from_anchor(after, rulings_of(after)[which]), strict=True)
        for one, other in same:
            assert one == pytest.approx(other, abs=ROUNDING)
    assert not np.allclose(before.edges.p, after.edges.p)


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
                    at = feature_.patch_slice(patch).start
                    cone = p, t, n, walked.values[:, at], walked.values[:, at + 1]
                    apart, normal = cone_distance(x, *cone), cone_normal(x, *cone)[:, 0]
                distance = max(distance, np.abs(apart).max())
                kink = max(kink, np.linalg.norm(cross(normal, edges.n[:, ruling]), axis=-1).max())
    return distance, kink


@every_feature
@few
@given(seed=seeds)
def test_neighbouring_patches_share_their_tangent_plane_along_the_whole_ruling(name, seed):
    walked = walk(FEATURES[name], random_values(FEATURES[name], seed), derivatives=False)
    distance, kink = tangent_faults(walked, walked.edges)
    assert distance <= ROUNDING
    assert kink <= ROUNDING


def test_a_ruling_that_leaves_its_tangent_plane_by_a_little_is_found():
    walked = walk(FEATURES["plane-cone-plane"], random_values(FEATURES["plane-cone-plane"], 1), derivatives=False)
    e = walked.edges
    tilted = e.t + 1e-9 * e.n
    assert tangent_faults(walked, Rulings(e.p, e.b, tilted, e.n, None))[0] > ROUNDING
    turned = e.n + 1e-9 * e.b
    assert tangent_faults(walked, Rulings(e.p, e.b, e.t, turned, None))[1] > ROUNDING


@every_feature
@few
@given(seed=seeds)
def test_corners_and_arc_points_lie_on_the_cut_planes_and_on_their_rulings(name, seed):
    walked = walk(FEATURES[name], random_values(FEATURES[name], seed), derivatives=False)
    m, s = cut_planes(walked)
    for rulings in (walked.edges, walked.arcs):
        points = pierce(walked, rulings)
        assert points.jacobian is None
        assert dot(m[:, :, None], points.position) == pytest.approx(
            np.broadcast_to(s[..., None], points.position.shape[:-1]), abs=ROUNDING
        )
        off = cross(points.position - rulings.p[:, None], np.broadcast_to(rulings.t[:, None], points.position.shape))
        assert off == pytest.approx(0.0, abs=ROUNDING)


@every_feature
@few
@given(seed=seeds)
def test_arc_points_lie_inside_the_curved_patches(name, seed):
    walked = walk(FEATURES[name], random_values(FEATURES[name], seed), derivatives=False)
    curved = [i for i, patch in enumerate(FEATURES[name].patches) if patch.kind != "plane"]
    assert walked.arcs.p.shape[1] == len(curved) * len(ARC_SHARES)
    for k, patch in enumerate(curved):
        normals = walked.arcs.n[:, k * len(ARC_SHARES) : (k + 1) * len(ARC_SHARES)]
        first, last = walked.edges.n[:, patch, None], walked.edges.n[:, patch + 1, None]
        chain = np.concatenate([first, normals, last], axis=1)
        turned = np.linalg.norm(np.diff(chain, axis=1), axis=-1)
        # Equal shares of the sweep, in the order of the walk.
        assert turned == pytest.approx(np.broadcast_to(turned[:, :1], turned.shape), rel=1e-9)


def differences(of, values, function):
    """Central differences (..., N) by all numbers of each array that `function` makes of a walk, in one batch."""
    panels, count = values.shape
    steps = STEP * np.concatenate([np.eye(count), -np.eye(count)])
    batch = (values[:, None] + steps).reshape(-1, count)
    both = [part.reshape(panels, 2, count, *part.shape[1:]) for part in function(walk(of, batch, derivatives=False))]
    return [np.moveaxis((part[:, 0] - part[:, 1]) / (2.0 * STEP), 1, -1) for part in both]


def relative(one, other):
    return np.abs(one - other).max() / max(1.0, np.abs(other).max())


def corners_and_arc_points(walked):
    return [pierce(walked, walked.edges).position, pierce(walked, walked.arcs).position]


@every_feature
@few
@given(seed=seeds)
def test_derivatives_of_corners_and_arc_points_agree_with_finite_differences(name, seed):
    values = random_values(FEATURES[name], seed)
    walked = walk(FEATURES[name], values, derivatives=True)
    numeric = differences(FEATURES[name], values, corners_and_arc_points)
    for rulings, expected in zip((walked.edges, walked.arcs), numeric, strict=True):
        assert relative(slopes(pierce(walked, rulings)), expected) <= DIFFERENCES


def frames_of(walked):
    return [getattr(rulings, axis) for rulings in rulings_of(walked).values() for axis in "pbtn"]


@every_feature
@few
@given(seed=seeds)
def test_twists_of_all_rulings_agree_with_finite_differences(name, seed):
    values = random_values(FEATURES[name], seed)
    exact = []
    for rulings in rulings_of(walk(FEATURES[name], values, derivatives=True)).values():
        assert rulings.twist is not None
        omega, v = rulings.twist[..., :3, :], rulings.twist[..., 3:, :]
        exact.append(v + np.cross(omega, rulings.p[..., None], axisa=-2, axisb=-2, axisc=-2))
        for axis in "btn":
            exact.append(np.cross(omega, getattr(rulings, axis)[..., None], axisa=-2, axisb=-2, axisc=-2))
    for one, other in zip(exact, differences(FEATURES[name], values, frames_of), strict=True):
        assert relative(one, other) <= DIFFERENCES


def test_a_wrong_derivative_is_found():
    of = FEATURES["plane-cone-plane"]
    values = random_values(of, 3)
    walked = walk(of, values, derivatives=True)
    jacobian = slopes(pierce(walked, walked.edges)).copy()
    jacobian[0, 0, 0, 0, 0] += 1e-5
    assert relative(jacobian, differences(of, values, corners_and_arc_points)[0]) > DIFFERENCES


@every_feature
def test_walking_without_derivatives_gives_the_same_panels(name):
    values = random_values(FEATURES[name], 11)
    with_, without = (walk(FEATURES[name], values, derivatives=wanted) for wanted in (True, False))
    for which, rulings in rulings_of(with_).items():
        assert np.array_equal(rulings.p, rulings_of(without)[which].p)
        assert np.array_equal(rulings.n, rulings_of(without)[which].n)
    assert without.edges.twist is None


@every_feature
@few
@given(seed=seeds)
def test_panels_of_a_batch_do_not_touch_each_other(name, seed):
    values = random_values(FEATURES[name], seed, panels=4)
    together = walk(FEATURES[name], values, derivatives=True)
    corners = pierce(together, together.edges)
    for i in range(4):
        alone = walk(FEATURES[name], values[i : i + 1], derivatives=True)
        own = pierce(alone, alone.edges)
        assert np.abs(corners.position[i] - own.position[0]).max() <= ROUNDING
        assert np.abs(slopes(corners)[i] - slopes(own)[0]).max() <= 1e-10


def motions(of, values):
    """(panels, rows, free) how points and normals of the skin follow the unknowns, at rulings and inside arcs."""
    walked = walk(of, values, derivatives=True)
    rows = []
    for rulings in (walked.edges, walked.arcs):
        points = pierce(walked, rulings)
        assert rulings.twist is not None
        turning = np.cross(rulings.twist[..., :3, :], rulings.n[..., None], axisa=-2, axisb=-2, axisc=-2)
        rows += [slopes(points).reshape(len(values), -1, values.shape[1])]
        rows += [turning.reshape(len(values), -1, values.shape[1])]
    return np.concatenate(rows, axis=1)[..., of.free]


def dependent(of, values):
    """Whether some combination of the unknowns moves nothing."""
    singular = np.linalg.svd(motions(of, values), compute_uv=False)
    return bool(np.any(singular[:, -1] <= NO_MOTION * singular[:, 0]))


@every_feature
@few
@given(seed=seeds)
def test_no_unknown_is_dependent_on_the_others(name, seed):
    assert not dependent(FEATURES[name], random_values(FEATURES[name], seed))


def test_unknowns_that_the_panel_does_not_show_are_found():
    """A cone that sweeps by nothing shows neither its radius nor its half angle."""
    of = FEATURES["plane-cone-plane"]
    values = random_values(of, 5)
    values[:, of.patch_slice(1).stop - 1] = 0.0
    assert dependent(of, values)


@pytest.mark.parametrize(
    ("name", "tilt", "count"),
    [
        ("plane-cone-plane", "free", 18),
        ("plane-cylinder-plane", "free", 17),
        ("plane-cone-plane", "fixed", 16),
        ("plane-cylinder-plane", "fixed", 15),
    ],
)
def test_catalogue_features_have_the_papers_numbers_without_the_spare_one(name, tilt, count):
    of = feature(name, tilt=tilt)
    assert len(of.free) == count
    assert of.patches[1].kind == name.split("-")[1]


@every_feature
def test_numbers_have_unique_names_and_every_patch_and_cut_finds_its_own(name):
    of = FEATURES[name]
    names = [number.name for number in of.numbers]
    assert len(set(names)) == len(names)
    for i, patch in enumerate(of.patches):
        assert names[of.patch_slice(i)] == [f"patch {i}: {number.name}" for number in patch.numbers()]
    for end in (0, 1):
        assert names[of.cut_slice(end)] == [f"cut {end}: {what}" for what in ("position", "skew", "tilt")]


@every_feature
def test_expanding_unknowns_keeps_them_and_fills_in_the_fixed_numbers(name):
    of = FEATURES[name]
    unknowns = np.random.default_rng(0).normal(size=(2, len(of.free)))
    values = of.expand(unknowns)
    assert np.array_equal(values[:, of.free], unknowns)
    for i, number in enumerate(of.numbers):
        if number.fixed is not None:
            assert np.all(values[:, i] == number.fixed)


@every_feature
@few
@given(seed=seeds)
def test_panels_are_smooth_through_half_angle_zero(name, seed):
    of = FEATURES[name]
    at = [i for i, number in enumerate(of.numbers) if number.name.endswith("half_angle")]
    values = random_values(of, seed)
    values[:, at] = 0.0
    walked = walk(of, values, derivatives=True)
    corners = pierce(walked, walked.edges)
    slope = slopes(corners)
    rate = slope[..., at].sum(axis=-1)
    for half_angle in [sign * 10.0**-k for k in range(12, 1, -2) for sign in (1.0, -1.0)]:
        bent = values.copy()
        bent[:, at] = half_angle
        there = walk(of, bent, derivatives=True)
        points = pierce(there, there.edges)
        # What is left after the tangent is of second order, down to rounding.
        curved = points.position - corners.position - half_angle * rate
        assert np.abs(curved).max() <= 50.0 * half_angle**2 + ROUNDING
        assert np.abs(slopes(points) - slope).max() <= 100.0 * abs(half_angle) + 1e-11


def names_only(problem):
    """As much of a reference as `panel_shapes` asks for."""
    return SimpleNamespace(panels=[SimpleNamespace(name=f"panel {i}") for i in range(problem.panels)])


@every_feature
@few
@given(seed=st.integers(0, 10_000))
def test_panel_shapes_have_the_corners_of_the_walk(name, seed):
    problem = made_problem(FEATURES[name], seed)
    unknowns = random_unknowns(FEATURES[name], seed, problem.panels)
    place, state = problem.place, problem.state(unknowns)
    shapes = panel_shapes(problem, names_only(problem), unknowns)
    world = place.to_world(state.corners.position) * place.length + place.centre
    curves = [end_curves(problem, state.walked, state.corners.position, end) for end in (0, 1)]
    for i, shape in enumerate(shapes):
        assert shape.name == f"panel {i}"
        assert shape.feature == FEATURES[name].name
        assert shape.corners() == pytest.approx(world[i], abs=SAME_POINT)
        for end in (0, 1):
            assert curves[end].corners[i] + place.centre == pytest.approx(shape.corners()[end], abs=SAME_POINT)
            assert shape.cut_normals[end] @ shape.directions[0] > 0.0
            assert np.linalg.norm(shape.cut_normals[end]) == pytest.approx(1.0, abs=ROUNDING)


@every_feature
@few
@given(seed=st.integers(0, 10_000))
def test_panel_shapes_carry_each_ruling_to_the_next(name, seed):
    """Turning a ruling about the axis that its patch tells of gives the next ruling, as the solids assume."""
    problem = made_problem(FEATURES[name], seed)
    unknowns = random_unknowns(FEATURES[name], seed, problem.panels)
    for shape in panel_shapes(problem, names_only(problem), unknowns):
        for i, (patch, spec) in enumerate(zip(shape.patches, FEATURES[name].patches, strict=True)):
            assert patch.kind == spec.kind
            if not isinstance(patch, ConePatch):
                assert shape.normals[i] == pytest.approx(shape.normals[i + 1], abs=ROUNDING)
                continue
            p, t, n = shape.points[i], shape.directions[i], shape.normals[i]
            axis = np.cos(patch.half_angle) * t - np.sin(patch.half_angle) * n
            centre = p - patch.radius * n
            to_next = shape.points[i + 1] - centre

            def turned(v, axis=axis, sweep=patch.sweep):
                return v * np.cos(sweep) + np.cross(axis, v) * np.sin(sweep) + axis * (axis @ v) * (1 - np.cos(sweep))

            assert turned(p - centre) == pytest.approx(to_next, abs=SAME_POINT)
            assert turned(t) == pytest.approx(shape.directions[i + 1], abs=ROUNDING)
            assert turned(n) == pytest.approx(shape.normals[i + 1], abs=ROUNDING)


def test_an_unknown_feature_is_refused_with_those_that_exist():
    with pytest.raises(SettingsError, match="plane-cone-plane"):
        feature("plane-sphere-plane")


def test_an_unknown_tilt_is_refused():
    loose: Any = "loose"
    with pytest.raises(SettingsError, match="'free' or 'fixed'"):
        feature("plane-cone-plane", tilt=loose)


def test_a_feature_without_a_fold_is_refused_by_its_name():
    with pytest.raises(SettingsError, match="flat"):
        Feature("flat", (Plane(), Plane()))


def test_the_anchor_is_the_curved_patch_nearest_to_the_middle():
    assert [Feature("", patches).anchor for patches in COMPOSED.values()] == [1, 0, 1, 1]
    assert all(feature(name).anchor == 1 for name in CATALOGUE)


def test_a_number_that_a_feature_fixes_is_no_unknown():
    of = Feature("roof edge", (Plane(width=0.3), Cone(radius=0.2), Plane(turn=0.0)))
    assert len(of.free) == 18 - 3
    values = of.expand(np.zeros((1, len(of.free))))
    assert values[0, of.patch_slice(0).start] == 0.3
    assert values[0, of.patch_slice(1).start] == 0.2


def test_a_cylinder_is_the_cone_of_half_angle_zero():
    assert Cylinder() == Cone(half_angle=0.0)
    assert Cylinder(radius=1.0).kind == "cylinder"
    assert Cone().kind == "cone"
