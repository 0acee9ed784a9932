"""What is widest along whole seams hangs neither on how curves are cut into pieces, nor takes many looks to find."""

import numpy as np
import pytest

from cadpanel.geometry import widest_place
from cadpanel.geometry.closest_points import closest_points
from cadpanel.geometry.conic_chains import ConicChains, conic_chains
from cadpanel.geometry.end_curves import as_chains
from cadpanel.geometry.widest_place import INTERVALS, widest
from tests.seams import KINDS, backwards
from tests.thorough import cases

SEAMS = 40
# Of what is found, of the gap for its parts, and mm or radians.
GAP, KINK, ROUNDING = 1e-5, 2e-4, 1e-9
# Of strangers, and where the closest point leaps from end to end, parts leap with it.
PARTS = 1e-3
LEAPING = ("strangers", "straight_against_curved", "unlike")


def pair(kind, seed=20, count=SEAMS) -> tuple[ConicChains, ConicChains]:
    first, second = KINDS[kind](np.random.default_rng(seed), count)
    origin = 0.5 * (first.corners[:, 0] + second.corners[:, 0])
    return as_chains(first, origin), as_chains(second, origin)


def cut(chains: ConicChains, parts: int) -> ConicChains:
    """The same curves, every piece of which is told as several ones."""
    share = np.tile(np.arange(parts) / parts, chains.curves.shape[1])
    constant, cosine, sine, weights, span = np.repeat(chains.curves[:15], parts, axis=1).reshape(5, 3, -1)
    start, turn = np.repeat(chains.curves[15:], parts, axis=1)

    def rows(vectors):
        return vectors.reshape(3, chains.count, -1).transpose(1, 2, 0)

    def numbers(values):
        return values.reshape(chains.count, -1)

    return conic_chains(
        constant=rows(constant + share * span * weights[0]),
        cosine=rows(cosine + share * span * weights[1]),
        sine=rows(sine + share * span * weights[2]),
        weights=rows(weights),
        span=rows(span / parts),
        start=numbers(start + share * turn),
        turn=numbers(turn / parts),
        normals=[rows(of) for of in np.repeat(chains.normals, parts, axis=1).reshape(3, 3, -1)],
    )


def assert_same(found, wanted, parts=PARTS):
    allowed = np.stack([GAP * wanted[0], KINK * wanted[1], parts * wanted[0], parts * wanted[0]])
    assert (np.abs(np.subtract(found, wanted)) <= allowed + ROUNDING).all()


@pytest.mark.parametrize("kind", cases([*KINDS][::3], [*KINDS]))
def test_the_widest_place_is_the_same_however_curves_are_cut_into_pieces(kind):
    first, second = pair(kind)
    wanted = np.array(widest(cut(first, 3), cut(second, 3)))
    parts = np.inf if kind in LEAPING else PARTS
    assert_same(widest(first, second), wanted, parts)
    assert_same(widest(cut(first, 2), second), wanted, parts)


@pytest.mark.parametrize("turn", [lambda curves: curves, backwards], ids=["onwards", "backwards"])
def test_normals_are_compared_wherever_the_closest_point_leaps_from_whichever_end_it_is_seen(turn):
    """Of six hundred strangers one has its largest angle just beyond a leap."""
    first, second = (turn(of) for of in KINDS["strangers"](np.random.default_rng(21), 600))
    origin = 0.5 * (first.corners[:, 0] + second.corners[:, 0])
    one, other = as_chains(first, origin), as_chains(second, origin)
    assert_same(widest(one, other), np.array(widest(cut(one, 3), cut(other, 3))), parts=np.inf)


@pytest.mark.parametrize(
    ("kinds", "count", "most"), [(list(KINDS), SEAMS, 1.71), (["strangers"], 400, 1.26), (["unlike"], 400, 1.44)]
)
def test_few_places_are_looked_at_beyond_those_it_begins_with(monkeypatch, kinds, count, most):
    """So many times as many, on average; of curves far apart the closest point leaps, which is another matter."""
    looked = []

    def noted(on, of, points):
        looked.append(len(of))
        return closest_points(on, of, points)

    monkeypatch.setattr(widest_place, "closest_points", noted)
    shares = []
    for kind in kinds:
        looked.clear()
        first, second = pair(kind, count=count)
        widest(first, second)
        pieces = 2 * count * max(first.pieces, second.pieces)
        shares.append(sum(looked) / (pieces * (INTERVALS + 1)))
    assert np.mean(shares) <= most, shares


@pytest.mark.parametrize("kind", KINDS)
def test_curves_that_are_the_same_are_seen_to_be_so_at_once(monkeypatch, kind):
    """Where rounding is all that there is of a gap, nothing is looked for."""
    looked = []

    def noted(on, of, points):
        looked.append(len(of))
        return closest_points(on, of, points)

    monkeypatch.setattr(widest_place, "closest_points", noted)
    chains, _ = pair(kind)
    widest(chains, chains)
    assert sum(looked) == 2 * SEAMS * chains.pieces * (INTERVALS + 1)
