"""How long FreeCAD takes to open a delivery: its document, and its STEP file.

    python -m tests.benchmarks.opening --panels 1000

The strip of `tests.benchmarks.delivery` is built, and both files are opened, each in a FreeCAD of its own, with its
window on a screen that nobody sees and without one. With the window, FreeCAD 0.20 merges the STEP file into one object,
as its preferences are; without one that crashes it, and every solid is an object. The document holds skins, flat
patterns, seams and the schedule besides.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from cadpanel.delivery.outputs.freecad import DOCUMENT
from cadpanel.delivery.outputs.step_files import PANELS
from tests.benchmarks.delivery import run
from tests.freecad.program import run_in_freecad


def main() -> None:
    """See the module's text."""
    parser = argparse.ArgumentParser(description="Time opening a delivery in FreeCAD.")
    parser.add_argument("--panels", type=int, default=1000)
    parser.add_argument("--folder", type=Path, help="keep the files there, and use those that are there")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = chosen.folder or Path(temporary)
        if not (folder / DOCUMENT).exists():
            folder.mkdir(parents=True, exist_ok=True)
            run(chosen.panels, folder)
        for window in (False, True):
            found = {
                name: run_in_freecad(
                    "timing_driver.py", {"CADPANEL_FILE": str((folder / name).resolve())}, window=window, timeout=3600.0
                )
                for name in (DOCUMENT, PANELS)
            }
            for name, took in found.items():
                size = (folder / name).stat().st_size / 1e6
                print(
                    f"{'window' if window else 'headless':<9} {name:<13} {size:6.1f} MB {took['objects']:6} objects "
                    f"{took['seconds']:7.1f} s, processor {took['processor']:7.1f} s"
                )
            document, step = (found[name] for name in (DOCUMENT, PANELS))
            print(
                f"          as a part of STEP's time: {document['processor'] / step['processor']:.3f} of the processor"
            )


if __name__ == "__main__":
    main()
