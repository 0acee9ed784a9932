"""Every feature lies flat as a sheet does: lengths and areas are kept, and folding it back gives the panel."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.errors import PanelError, SettingsError
from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.unroll import neutral_offset, unroll, unroll_all, unroller
from tests.chains import CHAINS, FEATURES
from tests.flat_panels import folded, panels
from tests.known_panels import end_curve
from tests.shapes import folded_panel, random_panel

pytestmark = pytest.mark.each_value_once

AREA = 1e-9  # relative
LENGTH = 1e-6  # mm
OFFSETS = (0.0, -1.5, 3.0)

every_feature = pytest.mark.parametrize("name", sorted(FEATURES))
every_chain = pytest.mark.parametrize("name", sorted(CHAINS))


def length_in_space(shape: PanelShape, end: int, patch: int) -> float:
    """Of a patch's edge, by Richardson's rule from 1000 and 2000 chords; the curve follows its sweep evenly."""
    sums = []
    for chords in (1000, 2000):
        points = end_curve(shape, end).follow(patch + np.linspace(0.0, 1.0, chords + 1)[None] * (1.0 - 1e-15))[0][0]
        sums.append(float(np.linalg.norm(np.diff(points, axis=0), axis=-1).sum()))
    return sums[1] + (sums[1] - sums[0]) / 3.0


@every_feature
@pytest.mark.parametrize("offset", OFFSETS)
def test_areas_are_kept(name: str, offset: float) -> None:
    shapes = panels(name, 3)
    for shape, size in zip(shapes, flat_sizes(unroll_all(shapes, np.full(len(shapes), offset))), strict=True):
        assert size.area == pytest.approx(shape.offset(offset).area(), rel=AREA)


@every_chain
@pytest.mark.parametrize("offset", OFFSETS)
def test_lengths_of_every_piece_of_every_edge_are_kept(name: str, offset: float) -> None:
    for skin in panels(name, 4)[:2]:
        shape = skin.offset(offset)
        assert isinstance(shape, PanelShape)
        (size,) = flat_sizes([unroll(skin, offset)])
        count, corners = len(shape.patches), shape.corners()
        for patch in range(count):
            assert size.pieces[patch] == pytest.approx(length_in_space(shape, 0, patch), abs=LENGTH)
            assert size.pieces[2 * count - patch] == pytest.approx(length_in_space(shape, 1, patch), abs=LENGTH)
        for side, ruling in (("side 0", 0), ("side 1", -1)):
            length = np.linalg.norm(corners[1, ruling] - corners[0, ruling])
            assert size.edges[side] == pytest.approx(length, abs=LENGTH)
        assert size.edges["end 1"] == pytest.approx(sum(size.pieces[count + 1 : -1]), abs=LENGTH)


@every_feature
def test_pieces_join_to_a_closed_outline_round_to_the_left(name: str) -> None:
    for pattern in unroll_all(panels(name, 5), np.full(4, -1.5)):
        curves = pattern.curves
        ends = curves.points(np.tile([0.0, 1.0], (len(curves), 1)))
        assert np.abs(ends[:, 0] - curves.start).max() < LENGTH
        assert np.abs(ends[:, 1] - curves.stop).max() < LENGTH
        assert np.abs(np.roll(curves.start, -1, axis=0) - curves.stop).max() < LENGTH
        assert flat_sizes([pattern])[0].area > 0.0


@every_chain
def test_folding_the_outline_back_gives_the_skin(name: str) -> None:
    for shape in panels(name, 6):
        assert isinstance(shape, PanelShape)
        pattern, count = unroll(shape), len(shape.patches)
        shares = np.linspace(0.0, 1.0, 9)
        for bend in pattern.bends:
            for end, row in enumerate(bend.at_ends):
                points = pattern.rulings(bend, shares)[:, end]
                known = end_curve(shape, end).follow((bend.patch + shares * (1.0 - 1e-14))[None])[0][0]
                assert np.abs(folded(shape, pattern.curves, row, bend.patch, points) - known).max() < LENGTH
            inside = pattern.rulings(bend, shares).mean(axis=1)
            known = np.mean(
                [end_curve(shape, end).follow((bend.patch + shares * (1.0 - 1e-14))[None])[0][0] for end in (0, 1)],
                axis=0,
            )
            assert np.abs(folded(shape, pattern.curves, bend.at_ends[0], bend.patch, inside) - known).max() < LENGTH
        assert len(pattern.tangents) == count - 1
        drawn = np.linalg.norm(pattern.tangents[:, 1] - pattern.tangents[:, 0], axis=-1)
        corners = shape.corners()
        assert drawn == pytest.approx(np.linalg.norm(corners[1] - corners[0], axis=-1)[1:-1], abs=LENGTH)


@every_feature
def test_moving_and_turning_a_panel_changes_nothing(name: str) -> None:
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    shift = np.array([3000.0, -2000.0, 700.0])
    for shape in panels(name, 7)[:1]:
        other: Panel
        if isinstance(shape, PolygonShape):
            other = replace(shape, outline=shape.outline @ turn.T + shift, normal=turn @ shape.normal)
        else:
            assert isinstance(shape, PanelShape)
            other = replace(
                shape,
                points=shape.points @ turn.T + shift,
                cut_points=shape.cut_points @ turn.T + shift,
                **{of: getattr(shape, of) @ turn.T for of in ("directions", "normals", "cut_normals")},
            )
        for one, two in zip(
            *(unroll(of).curves.points(np.full((len(unroll(of).curves), 1), 0.3)) for of in (shape, other)), strict=True
        ):
            assert np.abs(one - two).max() < LENGTH


def test_a_half_angle_of_nothing_is_approached_smoothly() -> None:
    places = [
        unroll(random_panel(2, half_angle=angle), -1.5).curves.points(np.full((8, 3), [0.1, 0.5, 0.9]))
        for angle in (0.0, 1e-12, 1e-9, 1e-6)
    ]
    for angle, place in zip((1e-12, 1e-9, 1e-6), places[1:], strict=True):
        assert np.abs(place - places[0]).max() < 1e-7 + 1e4 * angle


def test_what_is_right_of_the_walk_lies_to_the_right_seen_from_outside() -> None:
    shape = folded_panel(chain="p", widths=(200.0,), turns=(0.0,))
    # Its first ruling runs along x and the walk goes towards -y, with the outside above.
    assert unroll(shape).curves.start == pytest.approx(
        np.array([[0.0, 0.0], [200.0, 0.0], [200.0, 1000.0], [0.0, 1000.0]]), abs=1e-9
    )


def test_a_quarter_cylinder_is_as_wide_as_its_arc() -> None:
    shape = folded_panel(chain="c", radius=200.0, sweep=0.5 * math.pi, widths=(), turns=())
    for k_factor, radius in ((0.5, 198.5), (0.4, 198.2), (1.0, 200.0)):
        (size,) = flat_sizes([cp.unroll(shape, thickness=3.0, k_factor=k_factor)])
        assert size.edges["end 0"] == pytest.approx(0.5 * math.pi * radius, abs=1e-9)


def test_the_k_factor_counts_from_the_inner_face_of_the_bend() -> None:
    convex, concave = (folded_panel(radius=radius, sweep=math.copysign(1.0, radius)) for radius in (200.0, -200.0))
    assert neutral_offset(convex, 3.0, "outer", 0.4) == pytest.approx(-1.8)
    assert neutral_offset(convex, 3.0, "inner", 0.4) == pytest.approx(1.2)
    assert neutral_offset(concave, 3.0, "outer", 0.4) == pytest.approx(-1.2)
    assert neutral_offset(concave, 3.0, "inner", 0.4) == pytest.approx(1.8)


def test_a_panel_that_bends_both_ways_has_no_neutral_surface_but_the_middle() -> None:
    shape = random_panel(1, chain="plane-cone-cone-plane", concave=True)
    assert len({np.sign(patch.radius) for patch in shape.patches if isinstance(patch, ConePatch)}) == 2
    assert neutral_offset(shape, 3.0) == -1.5
    with pytest.raises(PanelError, match=r"bends both ways.*give a K-factor of 0\.5"):
        cp.unroll(shape, k_factor=0.45)


def test_a_share_that_is_none_is_refused() -> None:
    for k_factor in (-0.1, 1.1, math.nan):
        with pytest.raises(SettingsError, match="K-factor must be between 0 and 1"):
            cp.unroll(random_panel(1), k_factor=k_factor)


def test_panels_of_a_batch_do_not_touch_each_other() -> None:
    mixed = [random_panel(1), panels("polygon of 5", 1)[0], random_panel(2, chain="cone"), random_panel(3)]
    for shape, pattern in zip(mixed, unroll_all(mixed, np.array([0.0, 1.0, -1.0, 2.0])), strict=True):
        assert pattern.name == shape.name
    together, alone = unroll_all(mixed, np.zeros(4))[3], unroll(mixed[3])
    assert np.abs(together.curves.start - alone.curves.start).max() < 1e-9


def test_where_a_kind_has_no_entry_it_says_so() -> None:
    with pytest.raises(TypeError, match="register one for its class"):
        unroller(object())  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["plane-cone-plane", "plane-cylinder-plane", "cone-spline-4"])
def test_where_on_its_ruling_a_point_is_told_changes_nothing(name: str) -> None:
    shape = panels(name, 1)[0]
    assert isinstance(shape, PanelShape)
    # A cone's radius is told where the point of its first ruling lies; any other may lie anywhere.
    slid = np.array([[70.0], [-40.0], [25.0], [10.0], [-15.0]])[: len(shape.points)]
    slid[[index for index, patch in enumerate(shape.patches) if isinstance(patch, ConePatch)]] = 0.0
    other = replace(shape, points=shape.points + slid * shape.directions)
    for share in ([[0.0]], [[0.4]], [[1.0]]):
        at = np.tile(share, (len(unroll(shape).curves), 1))
        assert unroll(other).curves.points(at) == pytest.approx(unroll(shape).curves.points(at), abs=1e-8)
