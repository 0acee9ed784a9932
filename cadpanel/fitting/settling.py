"""Radii fixed where rules want them equal, of few kinds, or those of tools, and the rest solved again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.methods.concurrent import Concurrent
from cadpanel.fitting.methods.method import Fitted, Progress
from cadpanel.fitting.problem import Problem
from cadpanel.fitting.rules.bends import bends_of
from cadpanel.fitting.rules.rule import Bends
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.solver.stop import Stop


def settle(
    problem: Problem, fitted: Fitted, starts: Sequence[Array], settings: FitSettings, progress: Progress
) -> Fitted:
    """What rules make of a fit; the fit itself where none of them says anything of radii.

    Args:
        problem: the panels, under rules.
        fitted: where they are after they were fitted at once.
        starts: what that began from, the local fits first.
        settings: how it was fitted.
        progress: told of every step.
    """

    def solved(posed: Problem, begin: Fitted) -> Fitted:
        found = Concurrent(goes_on=True).fit(posed, [starts[0], begin.unknowns, *starts[1:]], settings, progress)
        return replace(
            found, iterations=begin.iterations + found.iterations, starts=fitted.starts, agreed=fitted.agreed
        )

    found = [grouping for rule in problem.rules for grouping in rule.groupings(_bends(problem, fitted).values)]
    if found:
        grouped = [problem.ruled((*grouping, *problem.rules)) for grouping in found]
        ends = [solved(one, fitted) for one in grouped]
        best = min(range(len(ends)), key=lambda i: (ends[i].stopped is not Stop.HELD, _deviation(problem, ends[i]), i))
        problem, fitted = grouped[best], ends[best]
    kept: Fitted | None = None
    tried: list[Bends] = []
    for choice in range(max((rule.choices for rule in problem.rules), default=0)):
        bends = _bends(problem, fitted)
        for rule in problem.rules:
            bends = rule.settled(bends, choice)
        bends.held[bends.frozen] = False
        if not bends.held.any():
            return fitted
        if any(bends.same(other) for other in tried):
            continue  # what did not hold once does not hold the second time
        tried.append(bends)
        trial = solved(problem.fixed(bends, fitted.unknowns), fitted)
        if trial.stopped is Stop.HELD:
            return trial
        kept = kept or trial
    return kept or fitted


def _deviation(problem: Problem, fitted: Fitted) -> float:
    """RMS in the solver's length, to digits that are the same on any processor."""
    return float(f"{problem.rms(problem.deviation.cost(problem.state(fitted.unknowns))):.6g}")


def _bends(problem: Problem, fitted: Fitted) -> Bends:
    values = bends_of(panel_shapes(problem, fitted.unknowns))
    frozen = np.zeros(problem.panels, dtype=bool)
    frozen[[panel for rule in problem.rules for panel in rule.frozen]] = True
    return Bends(values, np.zeros(values.shape, dtype=bool), frozen)
