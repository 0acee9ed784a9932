"""A shape feature that is not in the catalogue, composed in a few lines and delivered with its proof.

    python examples/own_feature.py [REFERENCE [DIR]]

The shop's folding machine has one die for the lower bend, of 260 mm, and rolls the upper bend freely: a flange, a
cylinder of fixed radius, a cone that may open by at most 8 degrees either way, and the other flange.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import cadpanel as cp

FIXTURE = Path(__file__).resolve().parents[1] / "fixtures" / "kai_tak_nw.step"
STEEPEST = math.radians(8.0)


def main(reference: Path, folder: Path) -> None:
    """Fit the feature to every panel of a reference, and deliver the panels."""
    fold = cp.Feature(
        cp.Plane(),
        cp.Cylinder(radius=260.0),
        cp.Cone(half_angle=(-STEEPEST, STEEPEST)),
        cp.Plane(),
        name="die-260",
    )
    result = cp.fit(cp.read(reference), feature=fold, gap_tolerance=1.0)
    report = cp.deliver(result, folder, overwrite=True)
    summary = report.summary
    first, last = report.panels[0].name, report.panels[-1].name
    print(f"{first} to {last}: {len(fold.free)} independent numbers a panel of the feature '{fold.name}'")
    print(f"largest gap {summary.max_seam_gap:.2f} mm, RMS deviation {summary.rms_deviation:.2f} mm")
    print(f"tolerance met: {summary.tolerance_met}; the files hold what the report says: {cp.verify(folder).holds}")


if __name__ == "__main__":
    main(
        Path(sys.argv[1]) if len(sys.argv) > 1 else FIXTURE,
        Path(sys.argv[2]) if len(sys.argv) > 2 else Path("build/own_feature"),
    )
