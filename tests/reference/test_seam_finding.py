import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.errors import PanelError, ReferenceFileError, SettingsError
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import RawPanel
from tests.reference_shapes import Lip, lens, moved, raw_panel, raw_strip, ring, sampled_face, shuffled, strip

STRIP = raw_strip(strip(6))
RINGS = {2: raw_strip(lens()), 3: raw_strip(ring(3)), 8: raw_strip(ring(8))}


def named_seams(reference):
    """Return each seam as a set of (panel name, edge)."""
    return {
        frozenset((reference.panels[panel].name, edge) for panel, edge in zip(seam.panels, seam.edges, strict=True))
        for seam in reference.seams
    }


def assert_seams_close(reference, tolerance=1.0):
    for seam in reference.seams:
        first, second = (
            reference.panels[panel].edges[edge] for panel, edge in zip(seam.panels, seam.edges, strict=True)
        )
        np.testing.assert_allclose(first, second[::-1] if seam.reversed else second, atol=tolerance)


@given(order=st.permutations(range(6)))
@settings(max_examples=20, deadline=None)
def test_file_order_changes_nothing_but_the_order(order):
    straight, mixed = assemble(STRIP, "a.step"), assemble([STRIP[k] for k in order], "a.step")
    assert [panel.name for panel in mixed.panels] == [STRIP[k].name for k in order]
    assert named_seams(straight) == named_seams(mixed)
    by_name = {panel.name: panel for panel in mixed.panels}
    for panel in straight.panels:
        np.testing.assert_array_equal(panel.corners, by_name[panel.name].corners)


def test_along_a_strip_end_1_meets_end_0_of_the_next():
    reference = assemble(STRIP, "a.step")
    assert [(seam.panels, seam.edges, seam.reversed) for seam in reference.seams] == [
        ((k, k + 1), (1, 0), False) for k in range(5)
    ]
    assert_seams_close(reference)
    assert reference.source == "a.step"


@pytest.mark.parametrize("count", sorted(RINGS))
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=10, deadline=None)
def test_ring_closes_in_any_file_order(count, seed):
    order = np.random.default_rng(seed).permutation(count)
    reference = assemble([RINGS[count][k] for k in order], "ring.step")
    assert len(reference.seams) == count
    assert all(set(seam.edges) == {0, 1} and not seam.reversed for seam in reference.seams)
    assert_seams_close(reference)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=10, deadline=None)
def test_two_panels_that_lie_over_each_other_have_their_outer_faces_away_from_each_other(order, seed):
    """A lens turns back on itself at its ends: one half is convex outwards, the other is the hollow under it."""
    random = np.random.default_rng(seed)
    reference = assemble([shuffled(RINGS[2][k], random) for k in order], "lens.step")
    upper, lower = sorted(reference.panels, key=lambda panel: panel.name)
    assert upper.turning is not None
    assert lower.turning is not None
    assert np.degrees([upper.turning.across, lower.turning.across]) == pytest.approx([90.0, -90.0], abs=1.0)
    apart = np.average(upper.points, axis=0, weights=upper.weights) - np.average(
        lower.points, axis=0, weights=lower.weights
    )
    assert apart @ (upper.weights @ upper.normals) > 0.0 > apart @ (lower.weights @ lower.normals)


def test_halves_of_a_flat_ring_meet_at_their_short_ends():
    """Both ends of a half point the same way, and the way across has no direction."""

    def half(first):
        def surface(u, v):
            angle, radius = np.pi * (first + u), 1000.0 + 2000.0 * v
            return np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.0 * u * v], axis=-1)

        return RawPanel(name=f"half {first}", faces=(sampled_face(surface, (0.0, 1.0)),))

    with np.errstate(all="raise"):
        reference = assemble([half(0), half(1)], "ring.step")
    assert [set(seam.edges) for seam in reference.seams] == [{0, 1}] * 2


def test_panels_that_do_not_touch_have_no_seam():
    panels = [STRIP[0], STRIP[2], STRIP[4]]
    assert assemble(panels, "a.step").seams == ()


def test_one_panel_has_no_seam():
    assert assemble(STRIP[:1], "a.step").seams == ()


def test_gap_up_to_the_tolerance_is_a_seam_and_beyond_it_none():
    apart = [STRIP[0], moved(STRIP[1], np.eye(3), np.array([0.9, 0.0, 0.0]))]
    assert len(assemble(apart, "a.step").seams) == 1
    assert len(assemble(apart, "a.step", seam_tolerance=0.8).seams) == 0


def test_ends_sampled_at_other_places_of_one_curve_are_a_seam():
    def slow(u, v):
        # Two faces whose border lies elsewhere: the same curve, but not the same points on it.
        return Lip(start=2000.0)(u, v)

    assert len(assemble([STRIP[0], raw_panel(slow, "slow", cuts=(0.0, 0.3, 1.2, 3.0))], "a.step", 2.0).seams) == 1


def test_ends_with_common_corners_but_different_curves_are_no_seam():
    first = Lip(twist=0.0, taper=0.0)

    def bulging(u, v):
        points = Lip(twist=0.0, taper=0.0, start=2000.0)(u, v)
        return points + 5.0 * np.sin(np.pi * u / 3.0)[..., None] * np.array([0.0, 0.6, 0.8])

    assert assemble([raw_panel(first, "a"), raw_panel(bulging, "b", cuts=(0.0, 3.0))], "a.step").seams == ()


def test_ends_that_meet_only_in_part_are_no_seam():
    short = raw_panel(Lip(start=2000.0), "short", cuts=(0.0, 1.0, 2.0, 2.5))
    assert assemble([STRIP[0], short], "a.step").seams == ()


def test_third_panel_at_one_edge_is_refused_with_all_names():
    lip = Lip(start=2000.0, twist=6.0, taper=0.1)

    def branch(u, v):
        points = lip(u, v)
        return points + 300.0 * (v**2)[..., None] * np.array([0.0, 0.0, 1.0])

    panels = [STRIP[0], STRIP[1], raw_panel(branch, "branch")]
    with pytest.raises(PanelError, match=r"along one and the same edge: a seam joins two") as caught:
        assemble(panels, "a.step")
    assert all(f"'{name}'" in str(caught.value) for name in ("lip 0", "lip 1", "branch"))
    assert len(assemble([STRIP[0], panels[2]], "a.step").seams) == 1


def test_duplicated_panel_is_refused_with_both_names_however_it_is_cut():
    for cuts in ((0.0, 1.0, 2.0, 3.0), (0.0, 1.0, 3.0)):
        copy = raw_panel(Lip(start=4000.0), "copy", cuts)
        with pytest.raises(PanelError, match=r"Panel 'copy': in 'a.step', it lies on panel 'lip 2' to within 1 mm"):
            assemble([*STRIP, copy], "a.step")


@pytest.mark.parametrize("tolerance", [0.0, -1.0, float("nan"), float("inf")])
def test_tolerance_must_be_a_positive_length(tolerance):
    with pytest.raises(SettingsError, match="seam tolerance must be a positive length"):
        assemble(STRIP, "a.step", seam_tolerance=tolerance)


@pytest.mark.parametrize("tolerance", ["1", None])
def test_tolerance_that_is_no_number_is_refused(tolerance):
    with pytest.raises(SettingsError, match="must be a positive length in mm, not"):
        assemble(STRIP, "a.step", seam_tolerance=tolerance)


def test_tolerance_as_large_as_a_panel_is_refused_with_the_largest_that_is_not():
    with pytest.raises(SettingsError, match=r"too large for panel 'lip \d'.*at most [\d.]+ mm"):
        assemble(STRIP, "a.step", seam_tolerance=2000.0)


def test_no_panels_are_refused():
    with pytest.raises(ReferenceFileError, match=r"'a\.step' holds no faces"):
        assemble([], "a.step")
