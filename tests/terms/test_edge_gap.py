"""Two panels that meet along edges that are not alike: each follows both panels as finite differences say."""

import pytest

from cadpanel.features.catalogue import feature
from cadpanel.features.polygon import Polygon
from cadpanel.terms.edge_gap import MixedGap
from tests.chains import mixed_unknowns, problem_of
from tests.terms.models import DIFFERENCES, Case, Together, jacobian_fault


@pytest.mark.parametrize(
    ("features", "edges"),
    [((feature("cylinder"), Polygon(4)), (1, 2)), ((feature("planar-quadrilateral"), feature("cone")), (1, 0))],
    ids=["end to edge", "straight end to arc"],
)
def test_a_straight_edge_and_a_curved_one_follow_both_panels(features, edges):
    problem = problem_of(features, 3, [(0, 1)], [edges])
    terms = problem.curve_gaps(1.0)
    assert [type(term) for term in terms] == [MixedGap]
    case = Case(problem, mixed_unknowns(problem.layout, 3))
    assert jacobian_fault(Together(problem, terms), case) <= DIFFERENCES
