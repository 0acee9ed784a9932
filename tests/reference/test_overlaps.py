"""Panels that cover each other are refused, however little of them does; panels that only meet never are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.errors import PanelError
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import RawPanel
from cadpanel.reference.oriented_panel import Sheet, sheet
from cadpanel.reference.outline import find_outline
from cadpanel.reference.outline_sides import EVEN_PARTS, Side
from cadpanel.reference.overlaps import _loop, refuse_overlaps
from tests.reference_shapes import (
    Lip,
    lens,
    moved,
    polygon_face,
    raw_grid,
    raw_honeycomb,
    raw_panel,
    raw_strip,
    ring,
    sampled_face,
    sheet_of,
    strip,
    tile,
)
from tests.thorough import thorough

SADDLE = sheet_of(lambda x, y: 900.0 * (x - 0.5) ** 2 - 1200.0 * (y - 0.4) ** 2, 12_000.0, 12_000.0)
FOLD = Lip(length=4000.0, twist=3.0, taper=0.05)


def check(*panels, tolerance=1.0):
    refuse_overlaps([sheet(raw, find_outline(raw, "roof.step")) for raw in panels], "roof.step", tolerance)


def patch(surface, name, u_range, v_range):
    return RawPanel(name=name, faces=(sampled_face(surface, u_range, v_range),))


@pytest.mark.parametrize(
    "panels",
    [
        raw_grid(SADDLE, 7, 5),
        raw_honeycomb(SADDLE, 3),
        raw_strip(strip(6)),
        raw_strip(ring(6)),
        raw_strip(ring(3)),
        raw_strip(lens()),
        raw_strip([Lip(fold=170.0, radius=20.0, flange=400.0, start=2000.0 * k) for k in range(2)]),
        [tile("A", 0.0, 0.0, 2000.0), tile("B", 0.0, 1000.0), tile("C", 1000.0, 1000.0)],
        [tile("A", 0.0, 0.0), tile("B", 999.1, 0.0)],
    ],
    ids=["grid", "honeycomb", "strip", "ring", "ring of three", "lens", "hairpins", "bond", "within the tolerance"],
)
def test_panels_that_only_meet_cover_nothing(panels):
    check(*panels)


@thorough
@given(
    place=st.tuples(st.floats(0.05, 0.7), st.floats(0.05, 0.7)),
    size=st.tuples(st.floats(0.004, 0.25), st.floats(0.004, 0.25)),
    seed=st.integers(0, 1000),
)
@settings(max_examples=60, deadline=None)
def test_a_panel_inside_another_is_refused_wherever_it_lies_and_however_small(place, size, seed):
    rotation, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    inner = [(low, low + part) for low, part in zip(place, size, strict=True)]
    panels = [patch(SADDLE, "outer", (0.0, 1.0), (0.0, 1.0)), patch(SADDLE, "inner", *inner)]
    turned = [moved(panel, rotation, np.array([1e4, -2e4, 5e3])) for panel in panels]
    for order in (turned, turned[::-1]):
        with pytest.raises(PanelError, match=r"Panel 'inner': in 'roof.step', a part of it covers panel 'outer' to"):
            check(*order)


@given(width=st.floats(1.2, 600.0), shift=st.floats(0.0, 0.8), part=st.floats(0.1, 0.2))
@settings(max_examples=60, deadline=None)
def test_a_strip_of_any_width_that_two_panels_share_is_refused(width, shift, part):
    over = patch(SADDLE, "B", (0.5 - width / 12_000.0, 0.9), (shift, shift + part))
    with pytest.raises(PanelError, match=r"a part of it covers panel '(A|B)'") as caught:
        check(patch(SADDLE, "A", (0.1, 0.5), (0.0, 1.0)), over)
    assert ("seam tolerance of more than" in str(caught.value)) == (width < 4.9) or 4.9 < width < 5.1


@pytest.mark.parametrize("overlap", [0.9, 1.5, 30.0, 900.0])
def test_folds_that_run_over_each_other_along_are_refused(overlap):
    """Also over their bend, and though they go on in one another."""
    longer = Lip(start=FOLD.start + FOLD.length - overlap, length=2000.0, twist=3.0, taper=0.05)
    panels = [raw_panel(FOLD, "A"), raw_panel(longer, "B")]
    if overlap < 1.0:
        check(*panels)
        return
    with pytest.raises(PanelError, match=r"covers panel '(A|B)' to within 1 mm, up to"):
        check(*panels)


def test_panels_that_share_an_edge_and_their_ground_are_refused():
    with pytest.raises(PanelError, match=r"Panel 'B': .* a part of it covers panel 'A' to within 1 mm, up to 300 mm"):
        check(tile("A", 0.0, 0.0), tile("B", 0.0, 0.0, 1000.0, 300.0))


def test_a_narrow_overlap_is_within_the_tolerance_that_the_refusal_names():
    panels = tile("A", 0.0, 0.0), tile("B", 998.0, 0.0)
    with pytest.raises(
        PanelError, match=r"up to 2 mm inside its outline: .*, or give a seam tolerance of more than 2 mm"
    ):
        check(*panels)
    assert len(assemble(panels, "roof.step", 2.1).seams) == 1


@pytest.mark.parametrize("at", [0.0, 100.0, 150.0, 200.0])
def test_long_bars_that_cross_are_refused_though_few_points_of_their_outlines_meet(at):
    bars = tile("A", 0.0, 0.0, 20_000.0, 400.0), tile("B", 9000.0 + at, -9000.0 - at, 400.0, 20_000.0)
    with pytest.raises(PanelError, match=r"covers panel '(A|B)' to within 1 mm"):
        check(*bars)


@pytest.mark.parametrize(("height", "refused"), [(0.0, True), (0.9, True), (1.1, False), (50.0, False)])
def test_panels_above_each_other_are_told_apart_by_the_tolerance(height, refused):
    panels = tile("A", 0.0, 0.0), tile("B", 100.0, 200.0, 300.0, 400.0, height)
    if refused:
        with pytest.raises(PanelError, match="covers panel 'A' to within 1 mm"):
            check(*panels)
    else:
        check(*panels)


@pytest.mark.parametrize("lean", [90.0, 45.0, 25.0])
def test_a_fin_that_stands_on_a_panel_does_not_cover_it(lean):
    up = np.array([0.0, np.cos(np.radians(lean)), np.sin(np.radians(lean))])

    def fin(u, v):
        return (
            np.array([200.0, 400.0, 0.0]) + 500.0 * u[..., None] * np.array([1.0, 0.0, 0.0]) + 300.0 * v[..., None] * up
        )

    check(tile("A", 0.0, 0.0), patch(fin, "fin", (0.0, 1.0), (0.0, 1.0)))


def sides_of(corners):
    """The sides of a flat polygon, (n, 2) corners in mm."""
    points = np.pad(corners, ((0, 0), (0, 1)))
    up = np.broadcast_to([0.0, 0.0, 1.0], (len(EVEN_PARTS), 3))
    return tuple(
        Side(points=one + EVEN_PARTS[:, None] * (other - one), normals=up, length=float(np.linalg.norm(other - one)))
        for one, other in zip(points, np.roll(points, -1, axis=0), strict=True)
    )


@given(seed=st.integers(0, 10_000), corners=st.integers(3, 12), stretch=st.sampled_from([1.0, 0.1, 0.01]))
@settings(max_examples=80, deadline=None)
def test_inside_an_outline_is_where_a_ray_leaves_it_an_odd_number_of_times(seed, corners, stretch):
    """Whatever its corners: long sides next to short ones, sharp tips and notches."""
    random = np.random.default_rng(seed)
    angles = np.sort(random.uniform(0.0, 2.0 * np.pi, corners))
    if np.ptp(angles) < np.pi or np.diff(angles).max() > 3.0:
        angles = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    reach = 10.0 ** random.uniform(1.5, 4.0, (corners, 1))
    outline = reach * np.stack([np.cos(angles), np.sin(angles)], axis=-1) * [1.0, stretch]
    points = random.normal(size=(300, 2)) * 10.0 ** random.uniform(1.0, 4.0, (300, 1)) * [1.0, stretch]
    after = np.roll(outline, -1, axis=0)
    crosses = (outline[:, 1] > points[:, None, 1]) != (after[:, 1] > points[:, None, 1])
    steps = np.where(crosses, after[:, 1] - outline[:, 1], 1.0)
    at = outline[:, 0] + (points[:, None, 1] - outline[:, 1]) / steps * (after[:, 0] - outline[:, 0])
    odd = (crosses & (at > points[:, None, 0])).sum(axis=1) % 2 == 1
    flat = np.pad(outline, ((0, 0), (0, 1)))
    panel = Sheet(name="A", points=flat, normals=flat, weights=np.ones(corners), sides=sides_of(outline))
    assert (_loop(panel).contains(np.pad(points, ((0, 0), (0, 1)))) == odd).all()


def split(polygon, point, angle):
    """A convex polygon, (n, 2), parted by a line."""
    heights = (polygon - point) @ [-np.sin(angle), np.cos(angle)]
    halves: list[list[np.ndarray]] = [[], []]
    for one, other, high, low in zip(polygon, np.roll(polygon, -1, axis=0), heights, np.roll(heights, -1), strict=True):
        halves[int(high > 0.0)].append(one)
        if (high > 0.0) != (low > 0.0):
            for half in halves:
                half.append(one + high / (high - low) * (other - one))
    return [np.array(half) for half in halves]


def is_sound(polygon):
    steps = np.roll(polygon, -1, axis=0) - polygon
    lengths = np.linalg.norm(steps, axis=1)
    before = np.roll(steps, 1, axis=0)
    turns = (before[:, 0] * steps[:, 1] - before[:, 1] * steps[:, 0]) / (lengths * np.roll(lengths, 1))
    # A corner of 3 degrees, or one that is hardly one, is what other tests are for.
    return len(polygon) >= 3 and lengths.min() > 100.0 and turns.min() > np.sin(np.radians(3.0))


@given(seed=st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
@thorough
def test_parts_of_one_plate_cover_nothing_however_it_is_cut(seed):
    random = np.random.default_rng(seed)
    parts = [np.array([[0.0, 0.0], [20_000.0, 0.0], [20_000.0, 9000.0], [0.0, 9000.0]])]
    for _ in range(14):
        cut = parts.pop(int(random.integers(len(parts))))
        point = random.dirichlet(np.ones(len(cut))) @ cut
        halves = split(cut, point, random.uniform(0.0, np.pi))
        parts += halves if all(map(is_sound, halves)) else [cut]
    flat = sheet_of(lambda x, _: 0.0 * x, 1.0, 1.0)
    check(*[RawPanel(name=f"P{n}", faces=(polygon_face(flat, part),)) for n, part in enumerate(parts)])


@pytest.mark.parametrize("half_width", [10.0, 50.0, 200.0, 2000.0])
def test_small_panels_beside_the_tip_of_a_long_wedge_do_not_cover_it(half_width):
    flat = sheet_of(lambda x, _: 0.0 * x, 1.0, 1.0)
    slope = 4.0 * half_width / 20_000.0
    wedge = np.array([[0.0, 0.0], [20_000.0, -slope * 20_000.0], [20_000.0, slope * 20_000.0]])
    columns = [
        np.array([[x, slope * x], [x + 100.0, slope * (x + 100.0)], [x + 100.0, 500.0], [x, 500.0]])
        for x in (100.0, 200.0, 300.0, 400.0)
    ]
    parts = [RawPanel(name=f"P{n}", faces=(polygon_face(flat, part),)) for n, part in enumerate([wedge, *columns])]
    check(*parts)
    with pytest.raises(PanelError, match="covers panel"):
        check(*parts, RawPanel(name="over", faces=(polygon_face(flat, columns[0] - [0.0, 30.0]),)))


@pytest.mark.parametrize("turns", [0.25, 0.75, 1.0, 1.3, 2.0])
@pytest.mark.parametrize("count", [2, 3])
def test_bands_that_wind_round_a_tube_do_not_cover_each_other(turns, count):
    """After a whole turn the normals of a band face all ways alike, and it has no side that faces a viewer."""

    def tube(u, v):
        angle = 2.0 * np.pi * (u + turns * v)
        return np.stack([1000.0 * np.cos(angle), 1000.0 * np.sin(angle), 5000.0 * v], axis=-1)

    check(*[patch(tube, f"P{n}", (n / count, (n + 1) / count), (0.0, 1.0)) for n in range(count)])
