"""What closing the seams of a twisting lip costs, by how its seams are cut.

python -m tests.benchmarks.seams                            square and conjugate seams, 9, 12 and 18 panels
python -m tests.benchmarks.seams --divide 12 --turn 15 --turn 30
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

import cadpanel as cp
from cadpanel.brep.kernel.shapes import compound_of
from tests.model_files import write_shape
from tests.roof_edges import roof_edge


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--divide", type=int, action="append", default=None)
    parser.add_argument("--gap", type=float, action="append", default=None)
    parser.add_argument("--turn", type=float, action="append", default=None, help="degrees that cuts may turn")
    asked = parser.parse_args()
    kinds = [cp.ReferenceSettings(unit="mm", divide=1)]
    kinds += [
        cp.ReferenceSettings(unit="mm", divide=1, seams="conjugate", cut_turn=turn) for turn in asked.turn or [15.0]
    ]
    print(
        "panels  gap, mm  seams            held  RMS  largest, mm  drift along, across, % of the length  kink, degrees"
    )
    with tempfile.TemporaryDirectory() as folder:
        path = write_shape(Path(folder) / "lip.brep", compound_of(roof_edge()))
        for count in asked.divide or [9, 12, 18]:
            for how in kinds:
                reference = cp.read(path, how, divide=count)
                for gap in asked.gap or [1.0, 5.0]:
                    result = cp.fit(reference, gap_tolerance=gap)
                    m = result.measures
                    along, across = (100.0 * float((of / m.lengths).max()) for of in (m.drift_along, m.drift_across))
                    name = "square" if how.seams == "square" else f"conjugate, {how.cut_turn:g}"
                    print(
                        f"{count:6d}  {gap:7g}  {name:15s}  {'yes' if result.tolerance_met else 'no':4s}  "
                        f"{m.overall_rms:.2f}  {m.max_deviation.max():.1f}  {along:.1f}, {across:.1f}  "
                        f"{np.degrees(m.kink.max()):.1f}",
                        flush=True,
                    )


if __name__ == "__main__":
    main()
