"""What measuring costs: a whole fit part by part, and seams against measuring them densely.

    python -m tests.benchmarks.measures             both of these:
    python -m tests.benchmarks.measures fit --panels 100 --panels 1000
    python -m tests.benchmarks.measures seams --seams 1000

All times are of the processor, and the best of several, as the machine is shared. Set OPENBLAS_NUM_THREADS=1 to keep to
one core.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Annotated

import numpy as np
import typer

from cadpanel.arrays import Array
from cadpanel.fitting.measures.boundary import overhang
from cadpanel.fitting.measures.deviation import deviations, outline_distances
from cadpanel.fitting.measures.drift import drifts
from cadpanel.fitting.measures.edges import PanelEdges
from cadpanel.fitting.measures.fit import measure
from cadpanel.fitting.measures.seams import along_seams, corner_gaps
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.problem import pose
from cadpanel.fitting.samples import SampleArrays
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.end_curves import EndCurves, seam_gap
from cadpanel.geometry.panel import Panel
from cadpanel.reference.model import Reference
from fixtures.arrays import reference
from tests.benchmarks.strips import long_lip
from tests.dense_seam_gap import Density, dense_seam_gap
from tests.seams import KINDS

app = typer.Typer(add_completion=False)

_DENSE = Density(points=48, peaks=4, close=1e-4, targets=96)


def best_of(runs: int, call: Callable[[], object]) -> float:
    """Processor seconds of the quickest of several calls."""
    best = np.inf
    for _ in range(runs):
        began = time.process_time()
        call()
        best = min(best, time.process_time() - began)
    return best


def parts(shapes: tuple[Panel, ...], of: Reference) -> Iterator[tuple[str, Callable[[], object]]]:
    """What there is to measure of a fit."""
    edges, samples = PanelEdges.of(shapes), SampleArrays.of(of)
    yield "all of it", lambda: measure(shapes, of)
    yield "  panels as arrays", lambda: PanelEdges.of(shapes)
    yield "  samples as arrays", lambda: SampleArrays.of(of)
    yield "  deviation of samples", lambda: deviations(shapes, samples.points)
    yield "  deviation of outlines", lambda: outline_distances(shapes, of)
    yield "  overhang", lambda: overhang(edges, of)
    yield "  seam gaps and kinks", lambda: along_seams(edges, of.seams)
    yield "  corner gaps", lambda: corner_gaps(edges, of.seams)
    yield "  drift", lambda: drifts(edges, of)


@app.callback(invoke_without_command=True)
def both(context: typer.Context) -> None:
    """What measuring costs."""
    if context.invoked_subcommand is None:
        fit()
        print()
        seams()


@app.command()
def fit(
    panels: Annotated[list[int] | None, typer.Option(help="Strips to measure; 100 and 1000 if none.")] = None,
    runs: Annotated[int, typer.Option(help="Of which the quickest counts.")] = 7,
) -> None:
    """Milliseconds a panel of measuring long strips, and of every part of it."""
    table: dict[str, list[float]] = {}
    counts = panels or [100, 1000]
    for count in counts:
        settings, lip = FitSettings(), reference(long_lip(count))
        problem, begin = pose(lip, [settings.feature_for(4)] * count)
        shapes = panel_shapes(problem, fit_local(problem, lip, begin, settings).unknowns)
        for name, call in parts(shapes, lip):
            table.setdefault(name, []).append(1e3 * best_of(runs, call) / count)
    print(f"{'ms a panel, panels':24}" + "".join(f"{count:8d}" for count in counts))
    for name, times in table.items():
        print(f"{name:24}" + "".join(f"{each:8.4f}" for each in times))


def ours(first: EndCurves, second: EndCurves) -> tuple[Array, float]:
    """(2, s) gaps and kinks, and seconds; the best of three, as the machine is shared."""
    return np.array(seam_gap(first, second)), best_of(3, lambda: seam_gap(first, second))


@app.command()
def seams(
    seams: Annotated[int, typer.Option(help="Seams of each kind.")] = 1000,
    dense: Annotated[int, typer.Option(help="Of these measured densely.")] = 100,
    seed: Annotated[int, typer.Option(help="Of the random seams.")] = 0,
) -> None:
    """For every kind of random seams: time of the dense measure and of ours, and by how much the two differ at most.

    The dense one, which takes many points and all of them against all, is timed on fewer seams.
    """
    print(
        f"{'kind':24} {'dense, ms':>10} {'ours, ms':>9} {'ratio':>6} {'gap, mm':>20} {'off by':>8} {'kink off by':>11}"
    )
    for kind, make in KINDS.items():
        first, second = make(np.random.default_rng(seed), seams)
        found, seconds = ours(first, second)
        some = np.arange(min(dense, seams))
        began = time.process_time()
        plain = np.array(dense_seam_gap(first.take(some), second.take(some), _DENSE))
        dense_seconds = (time.process_time() - began) / len(some)
        off = np.max(np.abs(found[:, some] - plain) / np.maximum(plain, 1e-4), axis=1)
        ratio = dense_seconds * seams / seconds
        gaps = f"{found[0].min():.3g} to {found[0].max():.3g}"
        print(
            f"{kind:24} {1e3 * dense_seconds:10.2f} {1e3 * seconds / seams:9.3f} {ratio:6.0f} "
            f"{gaps:>20} {off[0]:8.1e} {off[1]:11.1e}"
        )


if __name__ == "__main__":
    app()
