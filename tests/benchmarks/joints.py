"""How wide the joints of whole deliveries are, read from the files that they leave behind.

python -m tests.benchmarks.joints
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import cadpanel as cp
from cadpanel.geometry.sheet_checks import SkinSide
from tests.joined_fits import FITS, fitted

JOINTS = (0.0, 10.0, 20.0)
SHEETS: tuple[tuple[float, SkinSide], ...] = ((3.0, "outer"), (3.0, "inner"), (20.0, "outer"), (20.0, "inner"))


def cell(name: str, joint: float, thickness: float, skin_side: SkinSide, folder: Path) -> str:
    """The least and the largest clear width, mm; the proof says that no two solids share volume."""
    report = cp.deliver(fitted(name), folder, thickness=thickness, joint=joint, skin_side=skin_side)
    certificate = report.certificate
    if certificate.clear is None or certificate.overlap != 0.0 or not cp.verify(folder).holds:
        raise SystemExit(f"{name}: the files do not hold what the report says")
    return f"{certificate.clear.least:.3f} to {certificate.clear.largest:.3f}"


def main() -> None:
    """Print one row a kind of panels and joint, one column a sheet."""
    heads = [f"{thickness:g} mm, {side}" for thickness, side in SHEETS]
    sys.stdout.write(f"| panels | joint | {' | '.join(heads)} |\n|{'---|' * (2 + len(heads))}\n")
    for name in FITS:
        for joint in JOINTS:
            with tempfile.TemporaryDirectory() as folder:
                cells = [cell(name, joint, *sheet, Path(folder) / str(i)) for i, sheet in enumerate(SHEETS)]
            sys.stdout.write(f"| {name} | {joint:g} | {' | '.join(cells)} |\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
