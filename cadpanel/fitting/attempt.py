"""Fits of one reference under one set of settings, with these features or with those."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

from cadpanel.arrays import Array
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.baselines import Baselines
from cadpanel.fitting.measures.fit import largest_deviations, measure
from cadpanel.fitting.measures.verdict import keeps_limits
from cadpanel.fitting.methods.catalogue import LOCAL, method_for
from cadpanel.fitting.methods.concurrent import Concurrent
from cadpanel.fitting.methods.local import fit_local, refuse_hopeless
from cadpanel.fitting.methods.method import Fitted, Method
from cadpanel.fitting.methods.method import Progress as Told
from cadpanel.fitting.methods.trial import Trial
from cadpanel.fitting.problem import Problem, pose
from cadpanel.fitting.result import FitResult, Progress
from cadpanel.fitting.rules.rule import Posed
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.settling import settle
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import Reference
from cadpanel.solver.stop import Stop


class Attempts:
    """Fits of one reference.

    Attributes:
        reference: what is approximated.
        settings: how.
        over: whether the time is over, or somebody said so.
    """

    def __init__(
        self, reference: Reference, settings: FitSettings, progress: Progress | None, time_limit: float | None
    ) -> None:
        """The clock starts now."""
        self.reference, self.settings, self.over = reference, settings, False
        self._progress, self._began = progress, time.perf_counter()
        self._deadline = None if time_limit is None else self._began + time_limit

    def posed(self, features: Sequence[PanelFeature]) -> tuple[Problem, tuple[Array, ...]]:
        """The panels with these features; see `fitting.problem.pose`."""
        return pose(self.reference, features, self.settings.blend)

    def ruled(self, features: Sequence[PanelFeature]) -> tuple[Posed, ...]:
        """The rules for single panels and seams, for panels with these features.

        Raises:
            SettingsError: a rule names what is not there, or has no meaning for a panel.
        """
        return () if self.settings.rules is None else self.settings.rules.pose(self.reference, features)

    def fit(self, features: Sequence[PanelFeature], after: FitResult | None = None) -> FitResult:
        """Fit panels that have these features, from their local fits, and from another fit of theirs if there is one.

        Raises:
            PanelError: a panel is nothing that its feature could approximate.
        """
        rules = self.ruled(features)
        problem, starts = self.posed(features)
        alone = fit_local(problem, self.reference, starts, self.settings)
        if method_for(self.settings) == LOCAL:
            return self._result(problem, alone.unknowns, alone, rules)
        if after is not None:
            begin = [alone.unknowns, after.unknowns, *starts]
            return self._together(problem, begin, Concurrent(goes_on=True), rules)
        return self._together(problem, [alone.unknowns, *starts], method_for(self.settings), rules)

    def fit_together(self, problem: Problem, alone: Array, steps: int | None = None) -> FitResult:
        """Fit panels whose local fits (panels, size) are known, in so many steps at most if it goes step by step.

        Raises:
            PanelError: a panel's local fit is no approximation of it.
        """
        refuse_hopeless(problem, self.reference, alone)
        return self._together(problem, [alone], method_for(self.settings), steps=steps)

    def try_together(self, problem: Problem, alone: Array, steps: int | None = None) -> FitResult:
        """Show whether the features of panels whose local fits (panels, size) are known will do.

        Args:
            problem: the panels.
            alone: their local fits.
            steps: how many may be spent on it; as many as it takes if not given.

        Raises:
            PanelError: a panel's local fit is no approximation of it.
        """
        refuse_hopeless(problem, self.reference, alone)
        method = method_for(self.settings)
        if method == Concurrent():
            method = Trial(self._too_far, steps)
        return self._together(problem, [alone], method)

    def closed(self, problem: Problem, alone: Array, tried: FitResult, steps: int) -> FitResult:
        """Go on with a trial whose seams were left open between the points at which they are held."""
        found = Trial(lambda _: False, steps, goes_on=True).fit(problem, [tried.unknowns], self.settings, self._tell)
        return self._result(problem, alone, replace(found, iterations=tried.iterations + found.iterations))

    def _together(
        self,
        problem: Problem,
        begin: Sequence[Array],
        method: Method,
        rules: tuple[Posed, ...] = (),
        steps: int | None = None,
    ) -> FitResult:
        posed = problem.ruled(rules) if rules else problem
        told = self._tell if steps is None else _AtMost(steps, self._tell)
        fitted = method.fit(posed, begin, self.settings, told)
        if fitted.stopped is Stop.TOLD and not self.over:
            fitted = replace(fitted, stopped=Stop.STEP_LIMIT)
        if rules and not self.over:
            fitted = settle(posed, fitted, begin, self.settings, self._tell)
        return self._result(problem, begin[0], fitted, rules)

    def _result(self, problem: Problem, alone: Array, fitted: Fitted, rules: tuple[Posed, ...] = ()) -> FitResult:
        how = self.settings
        met = fitted.measured()
        if met is None:
            measures = measure(panel_shapes(problem, fitted.unknowns), self.reference)
        else:
            measures = measure(met.shapes, self.reference, edges=met.edges, met=met.along)
        outcomes = tuple(rule.outcome(measures) for rule in rules)
        return FitResult(
            reference=self.reference,
            settings=how,
            shapes=measures.shapes,
            measures=measures,
            unknowns=fitted.unknowns,
            baselines=Baselines(
                reference=self.reference, settings=how, problem=problem, alone=alone, measured={how.method: measures}
            ),
            tolerance_met=keeps_limits(measures, how) and all(outcome.kept for outcome in outcomes),
            starts=fitted.starts,
            agreed=fitted.agreed,
            iterations=fitted.iterations,
            stopped=fitted.stopped,
            outcomes=outcomes,
            prices=fitted.prices,
            seam_prices=fitted.seam_prices,
            seconds=time.perf_counter() - self._began,
        )

    def _too_far(self, shapes: Sequence[Panel]) -> bool:
        most = self.settings.max_deviation
        return most is not None and float(largest_deviations(shapes, self.reference).max()) > most

    def _tell(self, step: int, excess: float, rms: float) -> bool:
        """Tell of a step; whether to go on."""
        if self._progress is not None:
            answer = self._progress(self.settings.method, step, excess, rms)
            self.over |= answer is not None and not answer
        self.over |= self._deadline is not None and time.perf_counter() > self._deadline
        return not self.over


class _AtMost:
    """Ends what tells of its steps after so many of them."""

    def __init__(self, steps: int, tell: Told) -> None:
        self._left, self._tell = steps, tell

    def __call__(self, step: int, excess: float, rms: float) -> bool:
        self._left -= 1
        return self._tell(step, excess, rms) and self._left > 0
