"""Gaps and overlaps between the faces of a panel are bridged up to the seam tolerance, and no farther."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cadpanel.brep.read import read_reference
from cadpanel.errors import PanelError
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline import bridged_gap, find_outline, outline_and_gap
from cadpanel.reference.settings import ReferenceSettings
from tests.reference_shapes import (
    Lip,
    compound,
    kernel_face,
    moved,
    raw_panel,
    sampled_face,
    shuffled,
    write_plain,
    write_products,
)

STRAIGHT = Lip(length=9000.0, twist=0.0, taper=0.0)


def apart(gap: float, lip: Lip = STRAIGHT) -> RawPanel:
    """A panel whose second flange hangs lower by the gap, or higher where that is less than 0, mm."""
    flange = RawPanel(name="x", faces=(sampled_face(lip, (2.0, 3.0)),))
    lower = moved(flange, np.eye(3), np.array([0.0, 0.0, -gap])).faces
    return RawPanel(name="lip", faces=(sampled_face(lip, (0.0, 1.0)), sampled_face(lip, (1.0, 2.0)), *lower))


@given(size=st.floats(0.01, 9.99), tolerance=st.floats(1.0, 10.0), sign=st.sampled_from([-1.0, 1.0]))
@settings(max_examples=40, deadline=None)
def test_a_gap_is_bridged_exactly_where_it_is_within_the_tolerance(size, tolerance, sign):
    assume(abs(size - tolerance) > 1e-6)
    panel = apart(sign * size)
    if size > tolerance:
        with pytest.raises(PanelError, match=r"the nearest other one is .* mm away|trim faces that overlap"):
            find_outline(panel, "roof.step", tolerance)
        assert outline_and_gap(panel, "roof.step", tolerance) == (None, bridged_gap(panel, tolerance))
        return
    found, whole = (assemble([one], "roof.step", tolerance).panels[0] for one in (panel, raw_panel(STRAIGHT)))
    np.testing.assert_allclose(found.corners, whole.corners, atol=size + 1e-6)
    assert bridged_gap(panel, tolerance) == pytest.approx(size, rel=1e-6)
    outline, gap = outline_and_gap(panel, "roof.step", tolerance)
    assert gap == bridged_gap(panel, tolerance)
    assert outline is not None
    for side, same in zip(outline.sides, find_outline(panel, "roof.step", tolerance).sides, strict=True):
        np.testing.assert_array_equal(side.points, same.points)


def test_a_panel_without_faces_has_neither_outline_nor_gap():
    assert outline_and_gap(RawPanel(name="none", faces=()), "roof.step", 5.0) == (None, 0.0)


@pytest.mark.parametrize("tolerance", [0.5, 1.0, 5.0])
def test_a_small_panel_keeps_its_narrow_faces_whatever_the_tolerance(tolerance):
    # Its blend is 1.6 mm wide: within 5 mm its two edges, and those of both flanges, would be one.
    lip = Lip(length=60.0, flange=20.0, radius=1.0, twist=0.0, taper=0.0)
    outline = find_outline(raw_panel(lip), "roof.step", tolerance)
    assert sorted(round(side.length, 1) for side in outline.sides) == [41.6, 41.6, 60.0, 60.0]
    with pytest.raises(PanelError, match=r"the nearest other one is 0\.7 mm away"):
        find_outline(apart(0.7, lip), "roof.step", tolerance)


@pytest.mark.each_value_once
@pytest.mark.parametrize("gap", [-3.0, -1.5, 1.5, 3.0])
@pytest.mark.parametrize(
    ("how", "count"), [({"divide": 5}, 5), ({"stations": (2000.0,)}, 2), ({"grid": (1, 4)}, 12), ({}, 3)]
)
def test_a_strip_with_gaps_is_cut_within_a_tolerance_that_bridges_them(tmp_path, gap, how, count):
    lip = Lip(length=9000.0)

    def hung(u, v):
        return lip(u, v) - np.array([0.0, 0.0, gap])

    faces = [kernel_face(lip, (0.0, 1.0)), kernel_face(lip, (1.0, 2.0)), kernel_face(hung, (2.0, 3.0))]
    reference = read_reference(
        write_plain(tmp_path / "roof.step", *faces), ReferenceSettings(seam_tolerance=abs(gap) + 0.1, **how)
    )
    assert len(reference.panels) == count
    assert len(reference.seams) >= count - 1


def test_a_ready_made_panel_says_what_gap_inside_it_is_bridged(tmp_path):
    lip = Lip()

    def hung(u, v):
        return lip(u, v) - np.array([0.0, 0.0, 2.4])

    panel = compound([kernel_face(lip, (0.0, 2.0)), kernel_face(hung, (2.0, 3.0))])
    path = write_products(tmp_path / "roof.step", [("A", panel)])
    said = "Faces of panel 'A' of 'roof.step' gape, by 2.4 mm; that is within the tolerance of 4 mm."
    for chosen in (None, ("1-2",)):
        assert read_reference(path, ReferenceSettings(seam_tolerance=4.0, faces=chosen)).notes == (said,)
    with pytest.raises(PanelError, match=r"the nearest other one is 2\.4 mm away"):
        read_reference(path)


def leading_edge(half_angle: float, sweep: float, taper: float, bulge: float) -> RawPanel:
    """Two faces that meet in a crease, which leans from the square of the panel's flat ends, angles in degrees."""

    def surface(u, v):
        off, y = np.abs(u - 1.0) * (1.0 - taper * v), 1500.0 * v
        across, back = 150.0 * np.sin(np.radians(half_angle)), 150.0 * np.cos(np.radians(half_angle))
        x = np.sign(u - 1.0) * (across * off + bulge * off * (1.0 - np.abs(u - 1.0)))
        return np.stack([x, y, -back * off - np.tan(np.radians(sweep)) * y], axis=-1)

    return RawPanel(name="nose", faces=(sampled_face(surface, (0.0, 1.0)), sampled_face(surface, (1.0, 2.0))))


@given(
    half_angle=st.floats(24.0, 55.0),
    sweep=st.floats(-45.0, 45.0),
    taper=st.floats(0.0, 0.4),
    bulge=st.floats(0.0, 10.0),
    seed=st.integers(0, 999),
)
@settings(max_examples=25, deadline=None)
def test_a_swept_leading_edge_has_four_corners_and_one_outer_face_however_sharp(half_angle, sweep, taper, bulge, seed):
    plain = leading_edge(half_angle, sweep, taper, bulge)
    mirror = np.diag([1.0, -1.0 if seed % 2 else 1.0, 1.0])
    panel = shuffled(moved(plain, mirror, np.zeros(3)), np.random.default_rng(seed))
    found = assemble([panel], "wing.step").panels[0]
    assert found.four_sided
    tips = np.array([plain.faces[face].edges[side][[0, -1]] for face, side in ((0, 3), (1, 1))]) @ mirror
    away = np.linalg.norm(found.corners.reshape(4, 1, 3) - tips.reshape(1, 4, 3), axis=-1)
    np.testing.assert_allclose(away.min(axis=0), 0.0, atol=1e-6)
    assert (found.normals[:, 2] > 0.0).all()
