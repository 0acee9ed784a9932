"""Import a STEP file with FreeCAD, an independent program, and learn what it sees."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import pytest

DRIVER = Path(__file__).parent / "driver.py"
PROGRAMS = ("freecadcmd", "FreeCADCmd")
REQUIRED = "CADPANEL_REQUIRE_FREECAD"
"""Set to 1, a missing FreeCAD is a failure and not a skip."""


def find_freecad() -> str:
    """FreeCAD's command line program; skips the test, or fails it, where there is none."""
    found = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if found is not None:
        return found
    reason = "FreeCAD's command line program is not installed (Debian: apt-get install freecad-python3)"
    if os.environ.get(REQUIRED) == "1":
        pytest.fail(f"{reason}, and {REQUIRED}=1 asks for it")
    pytest.skip(reason)


def import_with_freecad(step_file: Path, *, timeout: float = 120.0) -> list[dict[str, Any]]:
    """What FreeCAD sees in a STEP file, one dict an object that has a shape, in the order of the file.

    Args:
        step_file: the file.
        timeout: seconds to wait; starting FreeCAD takes about two, 1000 panels about twenty.

    Returns:
        The keys are label, shape_type, solids (their number), valid, closed, volume (mm^3), area (mm^2), face_types
        (Plane, Cone, Cylinder, BSplineSurface ..., one a face) and bounding_box ([[min], [max]], mm).

    Raises:
        RuntimeError: FreeCAD crashed, or could not import the file.
    """
    program = find_freecad()
    with tempfile.TemporaryDirectory() as folder:
        answer_file = Path(folder) / "answer.json"
        process = subprocess.run(
            [program, str(DRIVER)],
            env=_environment(step_file, answer_file),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            cwd=folder,
        )
        if not answer_file.is_file():
            raise RuntimeError(
                f"FreeCAD gave no answer for '{step_file}' (exit code {process.returncode}):\n"
                f"{process.stdout}{process.stderr}"
            )
        answer = json.loads(answer_file.read_text(encoding="utf-8"))
    if "error" in answer:
        raise RuntimeError(f"FreeCAD could not import '{step_file}':\n{answer['error']}")
    objects: list[dict[str, Any]] = answer["objects"]
    return objects


def _environment(step_file: Path, answer_file: Path) -> dict[str, str]:
    """FreeCAD has a Python of its own, which must not find ours; nor may it read or write the user's preferences."""
    ours = ("PYTHON", "VIRTUAL_ENV", "COV_")
    inherited = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    home = str(answer_file.parent)
    return inherited | {
        "HOME": home,
        "FREECAD_USER_HOME": home,
        "QT_QPA_PLATFORM": "offscreen",
        "CADPANEL_STEP_FILE": str(step_file.resolve()),
        "CADPANEL_ANSWER_FILE": str(answer_file),
    }
