"""Folded flat panels lie flat by their bend allowances, and every place folds back to where it was."""

from __future__ import annotations

import numpy as np
import pytest

from cadpanel.geometry.fixings import FixingRule, fixings
from cadpanel.geometry.flat_places import flat_places
from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.unroll import neutral_offset, unroll
from cadpanel.geometry.unroll_trays import of_corner
from tests.trays import RULE, THICKNESS, tray


@pytest.mark.parametrize("edges", [None, ("edge 1",), ("edge 0", "edge 1")])
@pytest.mark.parametrize("k_factor", [0.3, 0.5])
def test_a_blank_has_the_area_of_the_surface_that_keeps_its_lengths(
    edges: tuple[str, ...] | None, k_factor: float
) -> None:
    shape = tray(edges=edges)
    offset = neutral_offset(shape, THICKNESS, "outer", k_factor)
    assert offset == pytest.approx((k_factor - 1.0) * THICKNESS)
    pattern = unroll(shape, offset)
    (size,) = flat_sizes([pattern])
    assert size.area == pytest.approx(shape.offset(offset).area(), rel=1e-12)
    # Each piece begins where the last one ends, and edges are told without what belongs to reliefs.
    assert np.abs(np.roll(pattern.curves.start, -1, axis=0) - pattern.curves.stop).max() < 1e-9
    assert list(size.edges) == [f"edge {edge}" for edge in range(4)]
    folds = len(shape.returns)
    assert [bend.patch for bend in pattern.bends] == list(range(1, 2 * folds, 2))
    for bend in pattern.bends:
        allowance = bend.sweep * (RULE.inner_radius + k_factor * THICKNESS)
        assert [size.pieces[piece] for piece in bend.at_ends] == pytest.approx([allowance, allowance], rel=1e-12)


def test_places_on_the_blank_fold_back_onto_the_skin() -> None:
    shape = tray()
    pattern = unroll(shape, -1.2)
    places = flat_places(shape, pattern, -1.2)
    assert len(places) == len(shape.patches) == 9
    own = shape.vertices()
    share = np.array([[0.0, 1.0]])
    found = [
        places[owner].on_skin(pattern.curves.take(slice(row, row + 1)).points(share)[0])[0]
        for row, owner in enumerate(pattern.owners)
    ]
    apart = np.linalg.norm(np.concatenate(found)[:, None] - own, axis=-1)
    assert apart.min(axis=1).max() < 1e-9
    assert apart.min(axis=0).max() < 1e-9


def test_holes_stand_in_legs_and_never_along_reliefs() -> None:
    pattern = unroll(tray(), -1.5)
    found = fixings(pattern, FixingRule(diameter=5.0, pitch=300.0, distance=9.0))
    assert found.holes
    assert not any(of_corner(hole.edge) for hole in found.holes)
    assert {hole.patch for hole in found.holes} == {2, 4, 6, 8}
