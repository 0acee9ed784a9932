"""Panels that a feature is not made for are refused when it is asked for, not when they are read."""

import numpy as np
import pytest

from cadpanel.errors import PanelError
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import PanelReference, RawPanel
from cadpanel.reference.suitability import GENTLE, LEAST_FOLD, LEAST_ROLL, check_corners, check_fold
from tests.reference_shapes import Lip, raw_panel, sampled_face, sheet_of


def one(panel: RawPanel) -> PanelReference:
    return assemble([panel], "test.step").panels[0]


def as_fold(raw: RawPanel, *, flanged: bool = True, folds: int = 1) -> PanelReference:
    """The panel, if a fold (or a roll, or a double fold) may be fitted to it."""
    panel = one(raw)
    check_fold(panel, "test.step", flanged=flanged, folds=folds)
    return panel


def vault(degrees):
    """A sheet rolled by so many degrees."""
    angle = np.radians(degrees)
    radius = 2000.0 / angle

    def surface(u, v):
        turn = angle * (u - 0.5)
        return np.stack([radius * np.sin(turn), 3000.0 * v, radius * (np.cos(turn) - 1.0)], axis=-1)

    return RawPanel(name="vault", faces=(sampled_face(surface, (0.0, 1.0)),))


def square(height):
    """Return a surface of 2 m by 2 m with the given height over x and y from -1 to 1."""

    def surface(u, v):
        x, y = 2.0 * u - 1.0, 2.0 * v - 1.0
        return np.stack([1000.0 * x, 1000.0 * y, 1000.0 * height(x, y)], axis=-1)

    return surface


@pytest.mark.parametrize(
    "height",
    [
        lambda x, y: np.sqrt(9.0 - x**2 - y**2),
        lambda x, y: np.sqrt(9.0 - x**2 - (0.5 * y) ** 2 - 0.75 * y**2),
        lambda x, y: 0.3 * (x**2 - y**2),
        lambda x, y: 0.3 * x * y,
        lambda x, y: 0.25 * (x**2 + 0.8 * y**2),
    ],
)
def test_sphere_and_saddle_are_refused_by_name(height):
    panel = RawPanel(name="dome", faces=(sampled_face(square(height), (0.0, 1.0)),))
    with pytest.raises(PanelError, match=r"Panel 'dome': in 'test.step', it curves both ways like a sphere or"):
        as_fold(panel)


@pytest.mark.parametrize("aspect", [1.0, 2.0, 3.0])
def test_sphere_is_refused_whatever_its_aspect(aspect):
    def surface(u, v):
        east, north = np.radians(20.0) * aspect * (u - 0.5), np.radians(20.0) * (v - 0.5)
        return 3000.0 * np.stack([np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)], axis=-1)

    with pytest.raises(PanelError, match="like a sphere or a saddle"):
        as_fold(RawPanel(name="globe", faces=(sampled_face(surface, (0.0, 1.0)),)))


def test_cylinder_over_the_same_square_passes():
    panel = RawPanel(name="vault", faces=(sampled_face(square(lambda x, _: np.sqrt(9.0 - x**2)), (0.0, 1.0)),))
    assert as_fold(panel).length == pytest.approx(2000.0)


def test_flat_sheet_is_refused():
    with pytest.raises(PanelError, match="it is flat"):
        as_fold(RawPanel(name="flat", faces=(sampled_face(square(lambda x, _: 0.0 * x), (0.0, 1.0)),)))


def test_sheet_that_bends_to_and_fro_is_not_called_flat():
    with pytest.raises(PanelError, match=r"bends to and fro like an S .* divide it where the bend changes sides"):
        as_fold(raw_panel(wave))


def test_outline_with_a_notch_is_refused_with_its_corners():
    cells = [sampled_face(Lip(), u, v) for u in ((0.0, 1.0), (1.0, 3.0)) for v in ((0.0, 0.6), (0.6, 1.0))]
    panel = one(RawPanel(name="lip", faces=tuple(cells[1:])))
    assert (panel.four_sided, len(panel.edges), panel.turning) == (False, 6, None)
    with pytest.raises(
        PanelError, match=r"has 6 corners \(at .* where a plane-cone-plane panel has 4, and it is bent too much"
    ):
        check_corners(panel, "test.step", "plane-cone-plane")
    check_corners(one(RawPanel(name="lip", faces=tuple(cells))), "test.step", "plane-cone-plane")


def wave(u, v):
    """An S: it turns by 77 degrees and back."""
    return np.stack([2000.0 * v, 500.0 * u, 200.0 * np.sin(2.0 * np.pi * u / 3.0)], axis=-1)


def test_sheet_that_bends_to_and_fro_may_be_a_double_fold():
    assert as_fold(raw_panel(wave), folds=2).four_sided


def zed(degrees, taper, twist):
    """A Z profile of five stretches of 400 mm, folded to and fro by so many degrees, tapered and twisted."""
    along = np.linspace(0.0, 5.0, 2001)
    angle = np.radians(degrees) * (np.clip(along - 1.0, 0.0, 1.0) - np.clip(along - 3.0, 0.0, 1.0) - 0.5)
    ways = np.stack([np.cos(angle), -np.sin(angle)])
    steps = 0.5 * (ways[:, 1:] + ways[:, :-1]) * 400.0 * np.diff(along)
    profile = np.concatenate([np.zeros((2, 1)), np.cumsum(steps, axis=1)], axis=1)

    def surface(u, v):
        y, z = ((1.0 - taper * v) * np.interp(u, along, values) for values in profile)
        return np.stack([2000.0 * v + 0.0 * y, y, z + twist * v * y], axis=-1)

    return raw_panel(surface, "zed", cuts=(0.0, 1.0, 2.0, 3.0, 4.0, 5.0))


@pytest.mark.parametrize("degrees", [17.0, 57.0, 86.0])
@pytest.mark.parametrize(("taper", "twist"), [(0.0, 0.0), (0.1, 0.0), (0.1, 0.02)])
def test_a_zed_whose_bends_cancel_knows_its_ends(degrees, taper, twist):
    panel = as_fold(zed(degrees, taper, twist), folds=2)
    for end in panel.edge_normals[:2]:
        assert np.degrees(np.arccos((end @ end.T).min())) == pytest.approx(degrees, abs=2.0)
    assert abs(panel.corners[1, 0, 0] - panel.corners[0, 0, 0]) == pytest.approx(2000.0)


@pytest.mark.parametrize(("degrees", "refused"), [(170.0, False), (180.0, True), (200.0, True)])
def test_what_goes_round_by_half_a_turn_is_to_be_cut_along_its_bend(degrees, refused):
    if not refused:
        as_fold(vault(degrees), flanged=False)
        return
    with pytest.raises(PanelError, match=r"one roll or fold reaches round 174: cut it along its bend"):
        as_fold(vault(degrees), flanged=False)


def test_a_fold_that_turns_by_a_little_less_than_the_least_is_flat_and_by_a_little_more_it_is_not():
    for least, flanged in ((LEAST_FOLD, True), (LEAST_ROLL, False)):
        assert as_fold(vault(1.05 * least), flanged=flanged).four_sided
        with pytest.raises(PanelError, match=f"it is flat .* a fold needs {least:g}"):
            as_fold(vault(0.95 * least), flanged=flanged)


def test_a_sheet_without_flanges_may_curve_both_ways_if_it_does_so_gently():
    def pillow(degrees):
        rise = 2000.0 * np.radians(degrees) / 2.0
        surface = sheet_of(lambda u, v: -rise * ((u - 0.5) ** 2 + (v - 0.5) ** 2), 2000.0, 2000.0)
        return RawPanel(name="pillow", faces=(sampled_face(surface, (0.0, 1.0)),))

    assert as_fold(pillow(0.9 * GENTLE), flanged=False).four_sided
    for degrees, flanged in ((1.1 * GENTLE, False), (0.9 * GENTLE, True)):
        with pytest.raises(PanelError, match="like a sphere or a saddle"):
            as_fold(pillow(degrees), flanged=flanged)


def test_lips_of_building_size_pass():
    for twist in (0.0, 10.0, 25.0):
        for fold in (60.0, 90.0, 120.0):
            assert as_fold(raw_panel(Lip(fold=fold, twist=twist))).four_sided


def test_panels_that_are_refused_as_folds_are_read_all_the_same():
    assert one(RawPanel(name="flat", faces=(sampled_face(square(lambda x, _: 0.0 * x), (0.0, 1.0)),))).four_sided
    assert one(raw_panel(wave)).four_sided
