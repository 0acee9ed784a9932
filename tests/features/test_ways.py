"""The order in which chains are walked over."""

import numpy as np
import pytest

from cadpanel.features.carrying import carry, moves_over
from cadpanel.features.ways import plan_of

CHAINS = [(0, (True,)), (1, (False, True, False)), (1, (False, True, True, False)), (2, (True,) * 5)]


@pytest.mark.parametrize(("anchor", "curved"), CHAINS)
def test_every_ruling_is_reached_once_and_from_one_that_was_reached_before(anchor, curved):
    reached = [len(curved) + 1]
    for _, _, start, end in plan_of(anchor, curved).order:
        assert start in reached
        reached.append(end)
    assert sorted(reached) == list(range(len(curved) + 2))


@pytest.mark.parametrize(("anchor", "curved"), CHAINS)
def test_a_way_moves_what_is_reached_over_it(anchor, curved):
    for ways in plan_of(anchor, curved).kinds:
        for patch, share, end, beyond in zip(ways.patches, ways.shares, ways.ends, ways.beyond, strict=True):
            moved = np.arange(len(curved) + 2)[beyond].tolist()
            assert moved == (list(range(patch + 1, len(curved) + 1)) if share > 0.0 else list(range(patch + 1)))
            assert end == (patch + 1 if share > 0.0 else patch)


def test_halves_of_a_patch_lead_as_far_as_all_of_it():
    cone, start = np.array([0.3, 0.1, 0.8]), np.concatenate([np.eye(3), [[0.1, 0.2, 0.3]]])
    half, whole = (moves_over("cone", cone, np.array(way), derivatives=False).frames for way in (0.5, 1.0))
    # The radius is that of the ruling from which the patch is walked over: it stays as the axis and the angle do.
    assert carry(half, carry(half, start)) == pytest.approx(carry(whole, start), abs=1e-14)
    back = moves_over("cone", cone, np.array(-1.0), derivatives=False).frames
    assert carry(back, carry(whole, start)) == pytest.approx(start, abs=1e-14)
