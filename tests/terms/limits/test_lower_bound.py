"""What a length lacks of a least one is held, and pulls only where there is something lacking."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cadpanel.solver.blocks import Normal
from cadpanel.terms.limits.lower_bound import LackTerm

LEAST = 2.0
# So much more than the least length is asked for.
ASKED = 1.1 * LEAST
PANELS = np.array([2, 0])


class Known(LackTerm):
    """Lengths that follow numbers as they are given."""

    def lengths(self, walked, corners, *, derivatives):
        del corners
        return walked.lengths, walked.slopes if derivatives else np.zeros((*walked.lengths.shape, 0))


def made(lengths, slopes) -> tuple[Known, Any]:
    feature = SimpleNamespace(by_unknowns=lambda rates: rates)
    group: Any = SimpleNamespace(panels=PANELS, feature=feature)
    state = SimpleNamespace(
        walks=[SimpleNamespace(lengths=lengths, slopes=slopes)],
        own_corners=[None],
        layout=SimpleNamespace(size=slopes.shape[-1] + 1),
    )
    return Known(group, 0, 3, LEAST, lengths.shape[1]), state


@pytest.mark.parametrize("lack", [1e-6, 0.1, 0.3, 1.0, 5.0])
def test_however_little_is_lacking_it_is_held_and_pulls(lack):
    slopes = np.random.default_rng(1).normal(size=(2, 2, 3))
    term, state = made(ASKED - lack * np.array([[1.0, 0.5], [2.0, 1.0]]), slopes)
    (rows,) = term.rows(state)
    roots = np.sqrt(term.hold.weight)
    wanted = lack * np.array([[1.0, 0.5], [2.0, 1.0]])
    assert term.vectors(state)[..., 0] == pytest.approx(wanted, abs=1e-14)
    assert rows.residual == pytest.approx(roots * wanted, abs=1e-14)
    (jacobian,) = rows.jacobians
    assert jacobian[..., :3] == pytest.approx(-roots[..., None] * slopes)
    assert np.all(jacobian[..., 3] == 0.0)
    cost = np.zeros(3)
    cost[PANELS] = 0.5 * np.sum((roots * wanted) ** 2, axis=1)
    assert term.cost(state) == pytest.approx(cost, rel=1e-9, abs=1e-13)
    normal = Normal.zero(3, 4, 0)
    assert term.add_to(normal, state) == pytest.approx(cost, rel=1e-9, abs=1e-13)
    assert normal.gradient[PANELS] == pytest.approx(np.einsum("pq,pqx->px", rows.residual, jacobian))


@pytest.mark.parametrize("spare", [0.0, 1e-12, 0.3, 1e9])
def test_what_lacks_nothing_neither_costs_nor_pulls(spare):
    term, state = made(np.full((2, 2), ASKED + spare), np.ones((2, 2, 3)))
    (rows,) = term.rows(state)
    assert not rows.residual.any()
    assert not rows.jacobians[0].any()
    assert not term.cost(state).any()
    normal = Normal.zero(3, 4, 0)
    assert not term.add_to(normal, state).any()
    assert not normal.diagonal.any()
    assert np.all(term.vectors(state)[..., 0] == pytest.approx(-spare, abs=1e-12))
