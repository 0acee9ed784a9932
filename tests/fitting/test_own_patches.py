"""Patches of a user's own are fitted to their own surfaces: recovered, limited, built, written and read back."""

import numpy as np
import pytest

from cadpanel.errors import PanelError, SettingsError
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Cylinder, Patch, Plane
from cadpanel.fitting.bounds import natural_bounds
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.problem import pose
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.patches import ConePatch
from fixtures.arrays import reference as sampled_lip
from fixtures.lips import Lip
from tests.instances import random_shapes
from tests.known_panels import alone
from tests.own_patches import AngleFirst, ByGirth, ByRoot, CurvedBy
from tests.shapes import folded_panel

# Millimetres on panels of 2 m.
RECOVERED = 1e-9
# The same panels told by the package's numbers and by a user's: both fits stop where the cost no longer falls.
SAME_FIT = 0.05
LIP = sampled_lip(Lip(panels=3, twist=(2.0, 3.0), radius=(300.0, 260.0)))

# A chain told by a user's numbers, and the same one told by the package's.
CHAINS: dict[str, tuple[tuple[Patch, ...], tuple[Patch, ...]]] = {
    "cylinder by curvature": ((CurvedBy(),), (Cylinder(),)),
    "cylinder by curvature between flanges": ((Plane(), CurvedBy(), Plane()), (Plane(), Cylinder(), Plane())),
    "cone in another order": ((AngleFirst(),), (Cone(),)),
    "cone by girth between flanges by root": ((ByRoot(), ByGirth(), ByRoot()), (Plane(), Cone(), Plane())),
    "double fold": (
        (ByRoot(), AngleFirst(), Plane(), ByGirth(), Plane()),
        (Plane(), Cone(), Plane(), Cone(), Plane()),
    ),
    "two cones": ((Plane(), AngleFirst(), ByGirth(), Plane()), (Plane(), Cone(), Cone(), Plane())),
    "flat": ((ByRoot(turn=0.0),), (Plane(turn=0.0),)),
}
FOLDS = ["cylinder by curvature between flanges", "cone by girth between flanges by root"]
every_chain = pytest.mark.parametrize("name", sorted(CHAINS))


def both(name: str) -> tuple[Feature, Feature]:
    own, usual = CHAINS[name]
    return Feature(*own), Feature(*usual)


def corner_error(shapes, known):
    return max(
        np.linalg.norm(one.corners() - other.corners(), axis=-1).max() for one, other in zip(shapes, known, strict=True)
    )


@every_chain
def test_known_panels_are_recovered_from_their_samples(name):
    own, _ = both(name)
    known = random_shapes(own, 11, 8)
    reference = alone(*known)
    problem, starts = pose(reference, len(known) * [own])
    found = fit_local(problem, reference, starts).unknowns
    shapes = panel_shapes(problem, found)
    assert corner_error(shapes, known) <= RECOVERED
    measures = measure(shapes, reference)
    assert measures.max_deviation.max() <= RECOVERED
    for one, other in zip(shapes, known, strict=True):
        for patch, expected in zip(one.patches, other.patches, strict=True):
            if isinstance(patch, ConePatch) and isinstance(expected, ConePatch):
                assert patch.sweep == pytest.approx(expected.sweep, abs=1e-9)
                assert patch.half_angle == pytest.approx(expected.half_angle, abs=1e-9)


@every_chain
def test_the_start_and_its_bounds_are_those_of_the_same_chain_told_by_the_package(name):
    own, usual = both(name)
    reference = alone(*random_shapes(usual, 4, 3))
    (one, starts), (other, expected) = (pose(reference, 3 * [of]) for of in (own, usual))
    for begin, begin_usual in zip(starts, expected, strict=True):
        for walked, walked_usual in zip(one.state(begin).walks, other.state(begin_usual).walks, strict=True):
            assert walked.edges.p == pytest.approx(walked_usual.edges.p, abs=1e-12)
            assert walked.edges.t == pytest.approx(walked_usual.edges.t, abs=1e-12)
    for problem, begun in ((one, starts), (other, expected)):
        lower, upper = natural_bounds(problem.layout, begun, problem.place.length)
        for begin in begun:
            assert np.all(lower < begin)
            assert np.all(begin < upper)


def test_bounds_of_a_curvature_are_those_of_the_radius():
    own, usual = both("cylinder by curvature")
    reference = alone(*random_shapes(usual, 4, 3))
    (one, _), (other, _) = (pose(reference, 3 * [of]) for of in (own, usual))
    radius, curvature = 5, own.patch_slice(0).start + 1
    assert one.bounds[0][:, curvature] == pytest.approx(1.0 / other.bounds[1][:, radius])
    assert one.bounds[1][:, curvature] == pytest.approx(1.0 / other.bounds[0][:, radius])


@pytest.mark.parametrize("name", FOLDS)
def test_panels_alone_come_out_as_the_same_chain_told_by_the_package(name):
    """A cylinder told by (sweep, curvature) used to come out 41.8 mm from itself."""
    own, usual = (fit(LIP, FitSettings(feature=of, method="local")) for of in both(name))
    assert corner_error(own.shapes, usual.shapes) <= SAME_FIT
    assert own.measures.overall_rms == pytest.approx(usual.measures.overall_rms, rel=1e-6)


@pytest.mark.parametrize("method", ["two_stage", "concurrent"])
@pytest.mark.parametrize("name", FOLDS)
def test_a_strip_comes_out_as_close_and_as_tight_as_the_same_chain_told_by_the_package(name, method):
    """Where the optimum is flat, the two ways to it may end in different places of it."""
    own, usual = (fit(LIP, FitSettings(feature=of, method=method)) for of in both(name))
    assert own.tolerance_met == usual.tolerance_met == (method == "concurrent")
    assert own.measures.overall_rms == pytest.approx(usual.measures.overall_rms, rel=5e-2)


@pytest.mark.parametrize(
    ("patch", "radius"),
    [(CurvedBy(curvature=1 / 280.0), 280.0), (AngleFirst(radius=280.0), 280.0), (ByGirth(radius=280.0), 280.0)],
    ids=repr,
)
def test_what_an_author_holds_is_kept(patch, radius):
    for shape in fit(LIP, FitSettings(feature=Feature(Plane(), patch, Plane()), gap_tolerance=10.0)).shapes:
        cone = shape.patches[1]
        assert isinstance(cone, ConePatch)
        assert cone.radius == pytest.approx(radius, rel=1e-13)


def test_a_curvature_that_an_author_bounds_stays_within():
    of = Feature(Plane(), CurvedBy(curvature=(1 / 220.0, 1 / 150.0)), Plane())
    for shape in fit(LIP, FitSettings(feature=of, gap_tolerance=10.0)).shapes:
        cone = shape.patches[1]
        assert isinstance(cone, ConePatch)
        assert 150.0 * (1.0 - 1e-9) <= cone.radius <= 220.0 * (1.0 + 1e-9)


def least_radius(shapes):
    """The tightest radius at any corner of the curved patches, mm."""
    found = []
    for shape in shapes:
        for i, patch in enumerate(shape.patches):
            if isinstance(patch, ConePatch):
                heights = np.einsum("ex,x->e", shape.corners()[:, i] - shape.points[i], shape.directions[i])
                found.append((patch.radius + heights * np.tan(patch.half_angle)).min())
    return min(found)


@pytest.mark.parametrize("patch", [CurvedBy(), AngleFirst(), ByGirth()], ids=repr)
def test_the_least_radius_is_respected_whatever_the_patch_is_told_by(patch):
    of = Feature(Plane(), patch, Plane())
    loose, tight = (fit(LIP, FitSettings(feature=of, min_radius=least)) for least in (10.0, 290.0))
    assert least_radius(loose.shapes) < 290.0
    assert least_radius(tight.shapes) >= 290.0 * (1.0 - 1e-6)


def test_a_curvature_tighter_than_the_least_radius_is_refused():
    of = Feature(Plane(), CurvedBy(curvature=(1 / 8.0, 1 / 4.0)), Plane())
    with pytest.raises(SettingsError, match=r"the radius of patch 1 .* is tighter than the least radius of 10 mm"):
        FitSettings(feature=of)
    FitSettings(feature=of, min_radius=7.0)


def test_a_patch_that_cannot_be_told_by_what_a_panel_asks_for_is_refused_by_the_panel():
    """Logarithms know no concave fold."""

    class ByLogarithm(CurvedBy):
        def numbers_for(self, dimensions):
            with np.errstate(invalid="ignore"):
                return CurvedBy.numbers_for(self, np.where(dimensions > 0.0, dimensions, np.nan))

    concave, convex = (
        alone(folded_panel(chain="c", radius=sign * 300.0, sweep=sign * 1.0, length=2000.0)) for sign in (-1.0, 1.0)
    )
    settings = FitSettings(feature=Feature(ByLogarithm()), method="local")
    with pytest.raises(PanelError, match=r"panel 1.*patch 0 of 'cylinder' has no numbers for .*radius -"):
        fit(concave, settings)
    assert fit(convex, settings).measures.max_deviation.max() <= RECOVERED
