"""The paper's algorithm as it is printed, against scipy.optimize.least_squares and against ours: energy over time.

    python -m tests.benchmarks.annealing curves --out build/annealing
    python -m tests.benchmarks.annealing table1

All three minimise the paper's objective (3), every squared corner gap as heavy as a panel's mean squared deviation,
from the same local fits of a fixture; scipy gets the exact sparse Jacobian. `curves` writes a table, annealing.csv and
annealing.png. `table1` prints the largest corner gap at every seam, as Table 1 of the paper does, by every method.
Seconds are of the processor.
"""

from __future__ import annotations

import csv
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

import cadpanel as cp
from cadpanel.arrays import Array
from cadpanel.fitting.methods.annealing import descend, energy_scale
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.methods.weighted import weighted_objective
from cadpanel.fitting.objective import Objective
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import LIKE_THE_PAPER, FitSettings, Method, Weights
from cadpanel.solver.blocks import Normal
from cadpanel.solver.levenberg_marquardt import Stopping, levenberg_marquardt
from tests.benchmarks.solver import Prepared, scipys

app = typer.Typer(add_completion=False)
FIXTURES = ("kai_tak_se_south", "kai_tak_se_east", "kai_tak_nw")
WEIGHTS = Weights(drift=1e-3)
# Energies within these shares of the lowest are looked for.
NEAR = (0.1, 0.01, 0.001)
METHODS: tuple[Method, ...] = ("two_stage", "annealing", "concurrent")
Trace = list[tuple[float, float]]


class Watched(Objective):
    """An objective that notes what it has cost at best, and when."""

    def __init__(self, of: Objective) -> None:
        super().__init__(of.problem, of.terms, coupled=True)
        self._scale, self.trace, self._began = energy_scale(of, WEIGHTS), Trace(), time.process_time()

    def note(self, cost: float) -> None:
        """An energy that was reached."""
        energy = cost * self._scale
        if not self.trace or energy < self.trace[-1][1]:
            self.trace.append((time.process_time() - self._began, energy))

    def linearize(self, unknowns: Array) -> tuple[Array, Normal]:
        """See `Objective.linearize`."""
        cost, normal = super().linearize(unknowns)
        self.note(float(cost.sum()))
        return cost, normal


def prepared(fixture: str) -> Prepared:
    """The objective of a fixture, and its local fits."""
    reference = cp.read(f"fixtures/{fixture}.step")
    how = FitSettings()
    problem, begin = pose(reference, [how.feature_for(4)] * len(reference.panels))
    local = fit_local(problem, reference, begin, how).unknowns
    return Prepared(weighted_objective(problem, WEIGHTS, how), local)


def traces(of: Prepared, limit: float) -> dict[str, Trace]:
    """Energies over seconds of the three methods."""
    found: dict[str, Trace] = {}
    ours = Watched(of.objective)
    levenberg_marquardt(ours, of.start, Stopping(cost=1e-9, iterations=300))
    found["ours"] = ours.trace
    watched = Watched(of.objective)
    scipys(Prepared(watched, of.start), 0.0, limit, scaled=True, told=watched.note)
    found["scipy"] = watched.trace
    paper = Watched(of.objective)
    began = time.process_time()
    how = FitSettings(method="annealing", weights=WEIGHTS, tau=1e-12)
    unknowns = of.start
    while time.process_time() - began < limit:
        unknowns = descend(paper, unknowns, how, lambda *_: time.process_time() - began < limit).unknowns
    found["annealing"] = paper.trace
    return found


def reached(trace: Trace, energy: float) -> float:
    """Seconds until a trace is down to an energy; infinite where it is not."""
    return next((seconds for seconds, now in trace if now <= energy), float("inf"))


@app.command()
def curves(
    out: Annotated[Path, typer.Option("--out")] = Path("build/annealing"),
    limit: Annotated[float, typer.Option("--limit", help="Seconds for each method.")] = 60.0,
) -> None:
    """Energy against time of the three methods on the three fixtures."""
    out.mkdir(parents=True, exist_ok=True)
    heads = f"{'ours, s':>9} {'scipy, s':>9} {'x':>6} {'annealing, s':>13} {'x':>8}"
    print(f"{'':<18} {'within':>7} {'E, mm2':>10} {heads}")
    found: dict[str, dict[str, Trace]] = {}
    for fixture in FIXTURES:
        of = found[fixture] = traces(prepared(fixture), limit)
        lowest = min(trace[-1][1] for trace in of.values())
        for near in NEAR:
            ours, scipy, paper = (reached(of[name], lowest * (1.0 + near)) for name in ("ours", "scipy", "annealing"))
            told = f"{paper:13.1f} {paper / ours:8.0f}"
            if paper == float("inf"):
                told = f"{f'> {limit:.0f}':>13} {f'> {limit / ours:.0f}':>8}"
            print(
                f"{fixture:<18} {near:7.1%} {lowest * (1.0 + near):10.1f} {ours:9.3f} {scipy:9.2f} {scipy / ours:6.1f} "
                f"{told}"
            )
        print(
            f"{fixture:<18} annealing came to {of['annealing'][-1][1]:.1f} mm2 after {of['annealing'][-1][0]:.0f} s",
            flush=True,
        )
    with (out / "annealing.csv").open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(("fixture", "method", "seconds", "energy_mm2"))
        rows.writerows(
            (fixture, name, f"{seconds:.6f}", f"{energy:.6f}")
            for fixture, of in found.items()
            for name, trace in of.items()
            for seconds, energy in trace
        )
    _draw(found, out / "annealing.png")


def _draw(found: dict[str, dict[str, Trace]], path: Path) -> None:
    from cadpanel.delivery.pictures.figure import Picture, png_bytes

    figure = Picture(figsize=(12.0, 3.8), dpi=100, layout="constrained")
    for axes, (fixture, of) in zip(figure.subplots(1, len(found)), found.items(), strict=True):
        for name, trace in of.items():
            axes.step(*np.transpose(trace), where="post", label=name)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("seconds of the processor")
        axes.set_title(fixture, fontsize=10)
        axes.grid(visible=True, alpha=0.3)
    figure.axes[0].set_ylabel("energy, mm2")
    figure.axes[0].legend()
    path.write_bytes(png_bytes(figure))


@app.command()
def table1(tau: Annotated[float, typer.Option("--tau", help="Of annealing, mm.")] = 0.1) -> None:
    """Table 1 in the paper's layout: the largest corner gap at every seam, mm, by fixture and method."""
    columns: list[tuple[str, str, list[float], float]] = []
    for fixture in FIXTURES:
        reference = cp.read(f"fixtures/{fixture}.step")
        for method in METHODS:
            how = replace(LIKE_THE_PAPER, method=method, tau=tau, weights=WEIGHTS if method == "annealing" else None)
            began = time.process_time()
            result = cp.fit(reference, how)
            seconds = time.process_time() - began
            columns.append((fixture, method, result.measures.widest_corners.tolist(), seconds))
    _print_table(columns, lambda values, row: f"{values[row]:.2f}" if row < len(values) else "-")


def _print_table(columns: list[tuple[str, str, list[float], float]], cell: Callable[[list[float], int], str]) -> None:
    print("| inter-panel index | " + " | ".join(f"{fixture} ({method})" for fixture, method, _, _ in columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    for row in range(max(len(values) for _, _, values, _ in columns)):
        print(f"| {row + 1} | " + " | ".join(cell(values, row) for _, _, values, _ in columns) + " |")
    print("| seconds | " + " | ".join(f"{seconds:.1f}" for *_, seconds in columns) + " |")


if __name__ == "__main__":
    app()
