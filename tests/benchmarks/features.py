"""What every feature of the catalogue is good for: known panels found again, strips closed, whole grids at once.

python -m tests.benchmarks.features recovery
python -m tests.benchmarks.features strips
python -m tests.benchmarks.features grids
python -m tests.benchmarks.features speed
python -m tests.benchmarks.features starts
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Unpack

import numpy as np
import pytest
import typer

import cadpanel as cp
from cadpanel.features.catalogue import CATALOGUE, feature
from cadpanel.fitting.methods.local import Local, fit_local
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import FitKeywords, FitSettings
from cadpanel.fitting.shapes import panel_shapes
from fixtures.grids import dome, grid, honeycomb, vault
from tests.instances import random_shapes
from tests.known_panels import alone

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
# A panel is found again where its farthest corner is within this, mm, and flat where its deviation is below this, mm.
FOUND = 1e-6
SHOWN = 0.05

app = typer.Typer(add_completion=False)


@app.command()
def recovery(
    instances: Annotated[int, typer.Option(help="Random panels of each feature.")] = 200,
    seed: Annotated[int, typer.Option(help="Of the random numbers.")] = 5,
) -> None:
    """Fit random known panels of every feature to samples of themselves, from a start given by the samples alone."""
    print(
        f"{'feature':<30} {'median corner, mm':>18} {'largest':>9} {'lost':>5} {'RMS of the lost, mm':>20} "
        f"{'seconds':>8}"
    )
    for name in (*CATALOGUE, "cone-spline-4"):
        of = feature(name)
        known = random_shapes(of, seed, instances)
        reference = alone(*known)
        began = time.perf_counter()
        problem, starts = pose(reference, [of] * instances)
        found = fit_local(problem, reference, starts).unknowns
        seconds = time.perf_counter() - began
        shapes = panel_shapes(problem, found)
        error = np.array(
            [np.linalg.norm(a.corners() - b.corners(), axis=-1).max() for a, b in zip(shapes, known, strict=True)]
        )
        lost = error > FOUND
        rms = problem.deviations(found)[0][lost].max(initial=0.0)
        print(
            f"{name:<30} {np.median(error):18.1e} {error[~lost].max(initial=0.0):9.1e} {lost.sum():5d} {rms:20.1e} "
            f"{seconds:8.1f}",
            flush=True,
        )


@app.command()
def strips() -> None:
    """Close the strip of ten panels with each feature that can follow it, and with features chosen panel by panel."""
    reference = cp.read(FIXTURES / "kai_tak_se_east.step")
    _head()
    for name in ("plane-cylinder-plane", "plane-cone-plane", "tri-cone", "plane-cone-cone-plane", "cone-spline-5"):
        _row(name, cp.fit(reference, feature=name))
    for largest in (40.0, 25.0):
        _row(f"auto, {largest:g} mm", cp.fit(reference, feature="auto", max_deviation=largest))


@app.command()
def speed(
    times: Annotated[int, typer.Option(help="Runs of each, of which the quickest counts.")] = 3,
) -> None:
    """Processor time of fits as multiples of plane-cone-plane's on the same panels; one processor is best for it."""
    names = ("tri-cone", "plane-cone-cone-plane", "plane-cone-plane-cone-plane", "cone-spline-5")
    choices = (40.0, 30.0, 25.0)
    print(f"{'strip':<20} {'plane-cone-plane, s':>20}" + "".join(f" {name:>28}" for name in names), end="")
    print("".join(f" {f'auto, {largest:g} mm':>14}" for largest in choices))
    for strip in ("kai_tak_nw", "kai_tak_se_south", "kai_tak_se_east"):
        reference = cp.read(FIXTURES / f"{strip}.step")
        unit = _quickest(times, reference, feature="plane-cone-plane")
        print(f"{strip:<20} {unit:20.2f}", end="", flush=True)
        for name in names:
            print(f" {_quickest(times, reference, feature=name) / unit:28.1f}", end="", flush=True)
        for largest in choices:
            share = _quickest(1, reference, feature="auto", max_deviation=largest) / unit
            print(f" {share:14.1f}", end="", flush=True)
        print()


@app.command()
def starts(
    instances: Annotated[int, typer.Option(help="Random panels of each feature.")] = 60,
    seed: Annotated[int, typer.Option(help="Of the random numbers.")] = 5,
) -> None:
    """Local fits whose other start is cut evenly, and those where it is cones along a strip, panels in both alike.

    Of the second start and of the fit the RMS deviation, mm; and panels that are not met; and processor seconds.
    """
    print(
        f"{'panels':<18} {'feature':<22} {'other start':<12} {'start':>8} {'fit':>9} {'off':>4} {'steps':>6} {'s':>6}"
    )
    for name in ("plane-cone-cone-plane", "cone-spline-2", "cone-spline-4", "cone-spline-6"):
        of = feature(name)
        known = alone(*random_shapes(of, seed, instances))
        strip = {fixture: cp.read(FIXTURES / f"{fixture}.step") for fixture in ("kai_tak_nw", "kai_tak_se_east")}
        for label, reference in {"known": known, **strip}.items():
            for start in ("even", "cones"):
                _start_row(label, reference, name, start)


def _start_row(label: str, reference: cp.Reference, name: str, start: str) -> None:
    began = time.process_time()
    with pytest.MonkeyPatch.context() as patch:
        if start == "even":
            patch.setattr("cadpanel.fitting.start.chains.bends_in_cones", lambda _of: False)
        problem, begin = pose(reference, [feature(name)] * len(reference.panels))
    found = Local().fit(problem, begin, FitSettings())
    seconds = time.process_time() - began
    first, last = (np.sqrt((problem.deviations(at)[0] ** 2).mean()) for at in (begin[1], found.unknowns))
    off = int((problem.deviations(found.unknowns)[0] > FOUND).sum())
    print(
        f"{label:<18} {name:<22} {start:<12} {first:8.2f} {last:9.2g} {off:4d} {found.iterations:6d} {seconds:6.2f}",
        flush=True,
    )


def _quickest(times: int, reference: cp.Reference, **settings: Unpack[FitKeywords]) -> float:
    """Seconds of the processor."""
    taken = []
    for _ in range(times):
        began = time.process_time()
        cp.fit(reference, **settings)
        taken.append(time.process_time() - began)
    return min(taken)


@app.command()
def grids() -> None:
    """Fit grids and honeycombs with neighbours on all sides in one run."""
    _head()
    for label, reference, name in _grids():
        _row(label, cp.fit(reference, feature=name))


def _grids() -> Iterator[tuple[str, cp.Reference, str]]:
    yield "20 x 20 flat, arched both ways", grid(dome(4000.0, 60_000.0), 20, 20), "planar-quadrilateral"
    yield "20 x 20 rolled, barrel vault", grid(vault(25_000.0), 20, 20), "cylinder"
    yield "20 x 20 rolled, arched both ways", grid(dome(4000.0, 60_000.0), 20, 20), "cylinder"
    yield "10 x 10 rolled, tapered vault", grid(vault(25_000.0, 0.05), 10, 10), "cylinder"
    yield "10 x 10 hexagons, arched both ways", honeycomb(dome(4000.0, 60_000.0), 10, 10), "planar-polygon"


def _head() -> None:
    print(
        f"{'':<36} {'panels':>6} {'seams':>6} {'met':>5} {'seam gap':>9} {'RMS':>7} {'x alone':>8} {'max':>7} "
        f"{'along %':>8} {'across %':>9} {'seconds':>8}"
    )


def _row(label: str, result: cp.FitResult) -> None:
    m, alone_rms = result.measures, result.local.overall_rms
    multiple = f"{m.overall_rms / alone_rms:.2f}" if alone_rms > SHOWN else "-"
    print(
        f"{label:<36} {len(result.shapes):6d} {len(result.reference.seams):6d} {result.tolerance_met!s:>5} "
        f"{m.max_seam_gap:9.3f} {m.overall_rms:7.3f} {multiple:>8} {m.max_deviation.max():7.2f} "
        f"{100.0 * (m.drift_along / m.lengths).max():8.2f} {100.0 * (m.drift_across / m.lengths).max():9.2f} "
        f"{result.seconds:8.1f}",
        flush=True,
    )


if __name__ == "__main__":
    app()
