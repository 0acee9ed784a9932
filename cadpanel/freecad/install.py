"""The add-on's files put where FreeCAD looks for add-ons, as FreeCAD wants them to lie."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path

from cadpanel.errors import DeliveryError, SettingsError

ADDON = Path(__file__).parent / "addon"
NAME = "cadpanel"
PACKAGE = "package.xml"
WORKBENCH = Path("freecad") / "cadpanel_workbench"
"""FreeCAD's own name space, which has no `__init__`, and the add-on's package in it."""
INTERPRETER = "interpreter.json"
PROGRAMS = ("freecadcmd", "FreeCADCmd", "freecad.cmd")
_SECONDS = 120.0
_ANSWER = "CADPANEL_ANSWER_FILE"
# It swallows what is printed while it starts, and waits for commands afterwards.
_ASK = (
    "import FreeCAD, os\n"
    f"with open(os.environ['{_ANSWER}'], 'w', encoding='utf-8') as file:\n"
    "    file.write(FreeCAD.getUserAppDataDir())\n"
    "os._exit(0)\n"
)


def install(to: Path | None = None) -> Path:
    """Write the add-on into a folder of add-ons; an older one of ours there is replaced.

    Args:
        to: FreeCAD's folder of add-ons, "Mod"; the one that the installed FreeCAD names if None.

    Returns:
        The add-on's folder.

    Raises:
        SettingsError: no FreeCAD is found that could name its folder.
        DeliveryError: the folder is taken by something else, or cannot be written.
    """
    place = (folder_of_addons() if to is None else to) / NAME
    _refuse_if_taken(place)
    package = (ADDON / PACKAGE).read_text(encoding="utf-8").replace("{version}", version("cadpanel"))
    try:
        shutil.rmtree(place, ignore_errors=True)
        own = place / WORKBENCH
        own.mkdir(parents=True)
        for file in sorted(ADDON.iterdir()):
            if file.suffix in (".py", ".svg"):
                shutil.copyfile(file, own / file.name)
        told = {"python": sys.executable, "cadpanel": version("cadpanel")}
        (own / INTERPRETER).write_text(json.dumps(told), encoding="utf-8")
        (place / PACKAGE).write_text(package, encoding="utf-8")  # the mark of ours, so the last
    except OSError as error:
        raise DeliveryError(f"'{place}' cannot be written: {error.strerror or error}.") from error
    return place


def folder_of_addons() -> Path:
    """Where the installed FreeCAD looks for add-ons: it knows, and versions differ.

    Raises:
        SettingsError: there is none, or it does not say.
    """
    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    remedy = "name its folder of add-ons with --to DIR (FreeCAD's Python console: App.getUserAppDataDir() + 'Mod')"
    if program is None:
        raise SettingsError(f"there is no {PROGRAMS[0]} on the path to ask where FreeCAD keeps add-ons: {remedy}")
    with tempfile.TemporaryDirectory() as folder:
        script, answer = Path(folder) / "ask.py", Path(folder) / "answer.txt"
        script.write_text(_ASK, encoding="utf-8")
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        try:
            subprocess.run(
                [program, str(script)],
                env={**environment, _ANSWER: str(answer)},
                stdin=subprocess.DEVNULL,
                capture_output=True,
                timeout=_SECONDS,
                check=False,
            )
            return Path(answer.read_text(encoding="utf-8")) / "Mod"
        except (OSError, subprocess.TimeoutExpired) as error:
            raise SettingsError(f"'{program}' does not say where FreeCAD keeps add-ons: {remedy}") from error


def _refuse_if_taken(place: Path) -> None:
    if not place.exists():
        return
    mark = place / PACKAGE
    ours = mark.is_file() and f"<name>{NAME}</name>" in mark.read_text(encoding="utf-8", errors="replace")
    if not ours or not (place / WORKBENCH).is_dir():
        raise DeliveryError(f"'{place}' is not an add-on of cadpanel's: move it elsewhere, or name another folder.")
