"""The free outline as a line: what is held, how it follows the unknowns, what is measured of it."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.measures.free_outline import outline_drift
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.free_edges import free_edges
from cadpanel.terms.limits.outline_drift import DriftOutline, OutlineTerm
from tests.delivered import fitted, strip
from tests.known_panels import posed
from tests.terms.models import DIFFERENCES, STEP


def test_the_edges_on_no_seam_are_free_and_go_on_straight() -> None:
    free = free_edges(strip())
    assert list(zip(free.panels.tolist(), free.edges.tolist(), strict=True)) == [
        (0, 0), (0, 2), (0, 3), (1, 2), (1, 3), (2, 1), (2, 2), (2, 3)
    ]  # fmt: skip
    drawn = strip().panels[1].edges[2]
    line = free.lines[3]
    assert np.array_equal(line[1 : len(drawn) + 1], drawn)
    for end, (beyond, first, second) in enumerate(((line[0], drawn[0], drawn[1]), (line[-1], drawn[-1], drawn[-2]))):
        ahead = (first - second) / np.linalg.norm(first - second)
        length = np.linalg.norm(beyond - first)
        assert 400.0 < length < 600.0, end
        assert beyond == pytest.approx(first + length * ahead)


def test_derivatives_are_exact() -> None:
    problem, (begin, *_) = posed(strip(), FitSettings())
    term = OutlineTerm(problem.outline.line, problem.lengths)
    vectors, (rates,) = term.linear(problem.state(begin, derivatives=True))
    assert np.array_equal(vectors, term.vectors(problem.state(begin)))
    for column in range(begin.shape[1]):
        step = np.zeros(begin.shape)
        step[:, column] = STEP
        ahead, behind = (term.vectors(problem.state(begin + way * step)) for way in (1, -1))
        off = np.abs((ahead - behind) / (2.0 * STEP) - rates[..., column])
        # A foot that passes a corner of the line meanwhile goes on another way.
        assert np.quantile(off, 0.99) <= DIFFERENCES * max(1.0, np.abs(rates).max())


def test_the_line_is_held_where_corners_alone_would_leave_it() -> None:
    free = fitted()
    allowed = 0.008 * free.measures.lengths
    assert (free.measures.outline_drift > 1.1 * allowed).any()
    held = fit(strip(), FitSettings(drift_outline=0.008))
    assert held.tolerance_met
    assert (held.measures.outline_drift <= allowed).all()
    assert held.prices["drift_outline"] > 0.0


def test_it_is_held_within_its_share_less_a_margin_and_not_at_all_at_the_most() -> None:
    problem, _ = posed(strip(), FitSettings())
    held = [
        DriftOutline().held(problem, {"drift_outline": share}, margin) for share, margin in ((0.02, 0.0), (0.02, 0.1))
    ]
    (plain,), (less,) = held
    assert less.hold.radius == pytest.approx(0.9 * plain.hold.radius, rel=1e-15)
    assert DriftOutline().held(problem, {"drift_outline": DriftOutline.most}, 0.0) == []


def test_panels_without_free_edges_have_no_drift_of_the_outline() -> None:
    reference = strip()
    seams = [
        replace(reference.seams[0], panels=(panel, panel), edges=edges)
        for panel in range(3)
        for edges in ((0, 1), (2, 3))
    ]
    closed = replace(reference, seams=tuple(seams))
    assert outline_drift(PanelEdges.of(fitted().shapes), closed).tolist() == [0.0, 0.0, 0.0]
    assert outline_drift(PanelEdges.of(fitted().shapes), reference) == pytest.approx(fitted().measures.outline_drift)


def test_a_share_out_of_range_is_refused() -> None:
    with pytest.raises(SettingsError, match="drift of the free outline"):
        FitSettings(drift_outline=0.6)
