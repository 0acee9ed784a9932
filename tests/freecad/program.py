"""Run a script inside FreeCAD, an independent program, with or without a window, and learn what it sees."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent
INSIDE = HERE / "inside.py"
PROGRAMS = ("freecadcmd", "FreeCADCmd")
WINDOWS = ("freecad", "FreeCAD")
SCREENS = ("xvfb-run",)
REQUIRED = "CADPANEL_REQUIRE_FREECAD"
"""Set to 1, a missing FreeCAD is a failure and not a skip."""


def found_program(names: tuple[str, ...], package: str) -> str:
    """The first of some programs that is installed; skips the test, or fails it, where there is none."""
    found = next(filter(None, map(shutil.which, names)), None)
    if found is not None:
        return found
    reason = f"{names[0]} is not installed (Debian: apt-get install {package})"
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
    given = {"CADPANEL_STEP_FILE": str(step_file.resolve())}
    answer = run_in_freecad("import_driver.py", given, timeout=timeout)
    objects: list[dict[str, Any]] = answer["objects"]
    return objects


def run_in_freecad(
    driver: str,
    given: Mapping[str, str],
    *,
    window: bool = False,
    home: Path | None = None,
    timeout: float = 120.0,
) -> dict[str, Any]:
    """What a driver, a script of this folder with a function `answer`, has to say.

    Args:
        driver: its file.
        given: what it finds in its environment.
        window: whether FreeCAD has its window, on a screen that nobody sees.
        home: where it keeps preferences and add-ons; a new place, where there are none, if None.
        timeout: seconds to wait.

    Raises:
        RuntimeError: FreeCAD crashed, or the driver failed.
    """
    command = [found_program(PROGRAMS, "freecad-python3")]
    if window:
        screen = [found_program(SCREENS, "xvfb xauth"), "-a", "-s", "-screen 0 1280x900x24"]
        command = [*screen, found_program(WINDOWS, "freecad")]
    with tempfile.TemporaryDirectory() as folder:
        answer_file = Path(folder) / "answer.json"
        process = subprocess.run(
            [*command, str(INSIDE)],
            env={
                **_environment(answer_file, home or Path(folder), window=window),
                "CADPANEL_DRIVER": str(HERE / driver),
                **given,
            },
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            cwd=folder,
        )
        if not answer_file.is_file():
            raise RuntimeError(
                f"FreeCAD gave {driver} no answer for {dict(given)} (exit code {process.returncode}):\n"
                f"{process.stdout}{process.stderr}"
            )
        answer: dict[str, Any] = json.loads(answer_file.read_text(encoding="utf-8"))
    if "error" in answer:
        raise RuntimeError(f"FreeCAD could not run {driver} for {dict(given)}:\n{answer['error']}")
    return answer


def _environment(answer_file: Path, home: Path, *, window: bool) -> dict[str, str]:
    """FreeCAD has a Python of its own, which must not find ours; nor may it read or write the user's preferences."""
    ours = ("PYTHON", "VIRTUAL_ENV", "COV_")
    inherited = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    # The start page is a browser, which refuses to run as the administrator of a bare container.
    screen = {"LIBGL_ALWAYS_SOFTWARE": "1", "QTWEBENGINE_DISABLE_SANDBOX": "1"}
    return (
        inherited
        | {"HOME": str(home), "FREECAD_USER_HOME": str(home), "CADPANEL_ANSWER_FILE": str(answer_file)}
        | (screen if window else {"QT_QPA_PLATFORM": "offscreen"})
    )
