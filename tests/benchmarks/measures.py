"""What measuring seams costs, and how far it is from measuring them densely.

    python -m tests.benchmarks.measures --seams 1000

For every kind of random seams: processor time of the dense measure and of ours, how many times as fast ours is, and by
how much the two differ at most. The dense one, which takes many points and all of them against all, is timed on fewer
seams. Set OPENBLAS_NUM_THREADS=1 to keep to one core.
"""

from __future__ import annotations

import time
from typing import Annotated

import numpy as np
import typer

from cadpanel.arrays import Array
from cadpanel.geometry.end_curves import EndCurves, seam_gap
from tests.dense_seam_gap import Density, dense_seam_gap
from tests.seams import KINDS

_DENSE = Density(points=48, peaks=4, close=1e-4, targets=96)


def ours(first: EndCurves, second: EndCurves) -> tuple[Array, float]:
    """(2, s) gaps and kinks, and seconds; the best of three, as the machine is shared."""
    best, found = np.inf, np.zeros((2, 0))
    for _ in range(3):
        began = time.process_time()
        found = np.array(seam_gap(first, second))
        best = min(best, time.process_time() - began)
    return found, best


def main(
    seams: Annotated[int, typer.Option(help="Seams of each kind.")] = 1000,
    dense: Annotated[int, typer.Option(help="Of these measured densely.")] = 100,
    seed: Annotated[int, typer.Option(help="Of the random seams.")] = 0,
) -> None:
    """Print one line a kind."""
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
    typer.run(main)
