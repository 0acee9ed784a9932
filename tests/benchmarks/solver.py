"""The concurrent solve against scipy.optimize.least_squares, and against itself on ten times as many panels.

    python -m tests.benchmarks.solver scipy --panels 100 --panels 1000
    python -m tests.benchmarks.solver scaling --panels 1000 --panels 10000

Both minimise the same objective from the same local fit: the paper's (3), every squared corner gap as heavy as a
panel's mean squared deviation. scipy gets the exact sparse Jacobian. Both are timed until their cost is within 1e-3 of
the lowest that is known, which a long run of ours finds first.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import typer
from scipy.optimize import least_squares
from scipy.sparse import coo_array, csr_array, vstack

from cadpanel.arrays import Array
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.methods.weighted import weighted_objective
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import FitSettings, Weights
from cadpanel.solver.levenberg_marquardt import Solution, Stopping, levenberg_marquardt
from cadpanel.terms.rows import Rows
from fixtures.arrays import reference
from tests.benchmarks.strips import long_lip

app = typer.Typer(add_completion=False)

# Costs within this share of the lowest count as the same.
SAME_COST = 1e-3
# What the lowest cost is looked for with, and what the solve is timed with where nobody else is raced against.
LOWEST = Stopping(cost=1e-7, iterations=1000)
OURS = Stopping(cost=1e-4, iterations=200)


@dataclass(frozen=True, slots=True)
class Prepared:
    """A strip ready to be solved: the objective and where to start."""

    objective: Objective
    start: Array


def prepare(panels: int, gap_weight: float) -> Prepared:
    """A strip of panels, locally fitted."""
    settings = FitSettings()
    lip = reference(long_lip(panels))
    problem, begin = pose(lip, [settings.feature_for(4)] * panels)
    local = fit_local(problem, lip, begin, settings)
    return Prepared(weighted_objective(problem, Weights(gap=gap_weight, drift=1e-3), FitSettings()), local.unknowns)


def ours(prepared: Prepared, stopping: Stopping = OURS) -> tuple[Solution, float]:
    """Our solution and its seconds; the best of three, as the machine is shared."""
    best, solution = np.inf, None
    for _ in range(3):
        began = time.perf_counter()
        solution = levenberg_marquardt(prepared.objective, prepared.start, stopping)
        best = min(best, time.perf_counter() - began)
    assert solution is not None
    return solution, best


def ours_until(prepared: Prepared, target: float) -> tuple[Solution, float]:
    """The shortest solve of ours that gets down to `target`, and its seconds."""
    steps = 1
    while float(levenberg_marquardt(prepared.objective, prepared.start, _steps(steps)).cost.sum()) > target:
        steps += 1
    return ours(prepared, _steps(steps))


def _steps(count: int) -> Stopping:
    return Stopping(cost=0.0, iterations=count)


class _ReachedError(Exception):
    """scipy's cost is as low as ours."""


def scipys(
    prepared: Prepared,
    target: float,
    limit: float,
    *,
    scaled: bool,
    told: Callable[[float], None] = lambda _: None,
) -> tuple[float, float]:
    """Seconds until scipy's cost is down to `target`, or until `limit` seconds are over, and the cost it reached.

    Whoever is `told` hears of every lowest cost.
    """
    shape = prepared.start.shape
    began = time.perf_counter()
    lowest = np.inf

    last: tuple[bytes, list[Rows]] = (b"", [])

    def rows_at(flat: Array) -> list[Rows]:
        # scipy asks for the Jacobian where it has just asked for the residuals: worked out once for both.
        nonlocal last
        if last[0] != flat.tobytes():
            state = prepared.objective.problem.state(flat.reshape(shape), derivatives=True)
            last = (flat.tobytes(), [row for term in prepared.objective.terms for row in term.rows(state)])
        return last[1]

    def residuals(flat: Array) -> Array:
        nonlocal lowest
        rows = rows_at(flat)
        values = np.concatenate([row.residual.reshape(-1) for row in rows])
        lowest = min(lowest, 0.5 * float(values @ values))
        told(lowest)
        if lowest <= target or time.perf_counter() - began > limit:
            raise _ReachedError
        return values

    def jacobian(flat: Array) -> csr_array:
        return csr_array(vstack([_sparse(row, shape[0], shape[1]) for row in rows_at(flat)]))

    with suppress(_ReachedError):
        least_squares(
            residuals,
            prepared.start.reshape(-1),
            jac=jacobian,
            method="trf",
            tr_solver="lsmr",
            x_scale="jac" if scaled else 1.0,
            ftol=1e-15,
            xtol=1e-15,
            gtol=1e-15,
            max_nfev=100_000,
        )
    return time.perf_counter() - began, lowest


def _sparse(rows: Rows, panels: int, size: int) -> coo_array:
    groups, q = rows.residual.shape
    parts = []
    for index, jacobian in zip(rows.panels, rows.jacobians, strict=True):
        line = np.broadcast_to((np.arange(groups)[:, None] * q + np.arange(q))[..., None], jacobian.shape)
        column = np.broadcast_to((index[:, None] * size + np.arange(size))[:, None], jacobian.shape)
        parts.append((jacobian.reshape(-1), line.reshape(-1), column.reshape(-1)))
    values, lines, columns = (np.concatenate(part) for part in zip(*parts, strict=True))
    return coo_array((values, (lines, columns)), shape=(groups * q, panels * size))


@app.command()
def scipy(
    panels: Annotated[list[int], typer.Option(help="Strips to solve.")],
    gap_weight: Annotated[float, typer.Option(help="Weight of a squared corner gap.")] = 1.0,
    limit: Annotated[float, typer.Option(help="Seconds after which scipy is stopped.")] = 600.0,
    scaled: Annotated[bool, typer.Option(help="Let scipy scale the unknowns by the Jacobian.")] = False,
) -> None:
    """Time to the same cost: ours against scipy's trust region with LSMR and the exact sparse Jacobian."""
    print(f"{'panels':>7} {'ours, s':>9} {'steps':>6} {'scipy, s':>9} {'ratio':>7}  cost of scipy against the lowest")
    for count in panels:
        prepared = prepare(count, gap_weight)
        lowest = float(levenberg_marquardt(prepared.objective, prepared.start, LOWEST).cost.sum())
        target = lowest * (1.0 + SAME_COST)
        solution, seconds = ours_until(prepared, target)
        theirs, reached = scipys(prepared, target, limit, scaled=scaled)
        print(
            f"{count:7d} {seconds:9.3f} {solution.iterations:6d} {theirs:9.2f} {theirs / seconds:7.1f}  "
            f"{reached / lowest:.5f}",
            flush=True,
        )


@app.command()
def scaling(
    panels: Annotated[list[int], typer.Option(help="Strips to solve.")],
    gap_weight: Annotated[float, typer.Option(help="Weight of a squared corner gap.")] = 1.0,
) -> None:
    """Time of the solve per panel, on longer and longer strips."""
    print(f"{'panels':>7} {'solve, s':>9} {'steps':>6} {'ms a panel':>11} {'ms a panel and step':>20}")
    for count in panels:
        solution, seconds = ours(prepare(count, gap_weight))
        each = 1e3 * seconds / count
        print(
            f"{count:7d} {seconds:9.2f} {solution.iterations:6d} {each:11.3f} {each / solution.iterations:20.4f}",
            flush=True,
        )


if __name__ == "__main__":
    app()
