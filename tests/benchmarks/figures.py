"""The figures of `examples/figures.md`, read from the files that a delivery leaves behind.

    python -m tests.benchmarks.figures

Fits every fixture by default and with whole gaps held at several tolerances, delivers it, verifies the folder, and
prints one row a delivery. All numbers come from report.json and from the certificate of the files that were read back.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import cadpanel as cp

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
TOLERANCES = (None, 1.0, 0.1)

HEADER = (
    "| fixture | held, mm | step, mm | width, mm | corner gap, mm | seam gap, mm | seam turn, degrees | unevenness, % "
    "| RMS deviation, mm | x local fit | max deviation, mm | drift along, % | across, % | tangency, rad | volume error "
    "| seconds |"
)


def row(fixture: Path, tolerance: float | None, folder: Path) -> str:
    """Fit, deliver, verify, and put the numbers in one row of a table."""
    result = cp.fit(cp.read(fixture), gap_tolerance=tolerance)
    report = cp.deliver(result, folder)
    proof = cp.verify(folder)
    if not proof.holds or not result.tolerance_met:
        raise SystemExit(f"{fixture.name}: the files do not hold what was asked, or what the report says")
    s, c = report.summary, proof.certificate
    held = ", ".join(f"{what} {allowed:g}" for what, allowed in report.settings.gaps.items())
    turn, uneven = (float(getattr(s, key) or 0.0) for key in ("max_seam_turn", "unevenness_percent"))
    return (
        f"| {fixture.stem} | {held} | {s.max_step:.2f} | {s.max_width:.2f} | {s.max_corner_gap:.3f} "
        f"| {c.max_seam_gap:.3f} | {turn:.2f} | {uneven:.2f} | {s.rms_deviation:.2f} | {s.local_rms_multiple:.2f} "
        f"| {s.max_deviation:.1f} | {s.drift_along_percent:.2f} | {s.drift_across_percent:.2f} "
        f"| {c.max_tangency_error:.0e} | {c.volume_error:.0e} | {result.seconds:.1f} |"
    )


def main() -> None:
    """Print the table."""
    print(HEADER)
    print("|" + "---|" * (HEADER.count("|") - 1))
    with tempfile.TemporaryDirectory() as scratch:
        for fixture in sorted(FIXTURES.glob("kai_tak_*.step")):
            for tolerance in TOLERANCES:
                print(row(fixture, tolerance, Path(scratch) / f"{fixture.stem}_{tolerance}"), flush=True)


if __name__ == "__main__":
    main()
