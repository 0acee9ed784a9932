"""Damaged files of every kind that the program reads: each ends in panels, a verdict, or one sentence.

The files are read as ever, by a second interpreter, which may crash over them; this one may not, and says so in one
sentence. A traceback, a sentence that is none, a process that dies or files that are left are what is looked for.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from cadpanel.brep.cutting.by_mesh import load_mesh
from cadpanel.brep.isolation import client, requests
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.survey import survey
from cadpanel.delivery.manifest import write_manifest
from cadpanel.delivery.verify import verify
from cadpanel.errors import CadpanelError
from tests.attack.damage import damaged, json_damaged, lines_damaged
from tests.attack.made import copied, delivery_of, models, plain_delivery
from tests.brep.files.mutants import rhino_mutant, step_mutant
from tests.forking import SERVER, forking

SECONDS = 6.0
"""After which a reader counts as hanging; it says so."""
LONGEST = 1500
"""Characters of a sentence."""
NOT_FOR_PEOPLE = re.compile(r"Traceback|0x[0-9a-f]{6,}|[\x00-\x08\x0b-\x1f\x7f-\x9f]|\n")

Change = Callable[[bytes, int], bytes]


def _half(one: Change, other: Change) -> Change:
    """Every other seed the one, else the other."""
    return lambda data, seed: (one, other)[seed % 2](data, seed // 2)


_STEP: Change = lambda data, seed: step_mutant(data, seed)[0]  # noqa: E731
_RHINO: Change = lambda data, seed: rhino_mutant(data, seed)[0]  # noqa: E731

READ: dict[str, tuple[str, Change]] = {
    "STEP, products": ("products.step", damaged),
    "STEP, model": ("labelled.step", damaged),
    "STEP, instances": ("strip.step", _STEP),
    "IGES": ("faces.iges", _half(damaged, lines_damaged)),
    ".brep text": ("text.brep", _half(damaged, lines_damaged)),
    ".brep binary": ("binary.bin.brep", damaged),
    ".3dm": ("sphere.3dm", damaged),
    ".3dm, trims": ("tube.3dm", _RHINO),
    "OBJ": ("mesh.obj", _half(damaged, lines_damaged)),
}
"""Files that are read: which, and how they are damaged."""
VERIFIED: dict[str, tuple[str, Change]] = {
    "report.json": ("report.json", _half(json_damaged, damaged)),
    "report.json, values": ("report.json", json_damaged),
    "manifest.json": ("manifest.json", _half(json_damaged, damaged)),
    "panels.step": ("panels.step", _half(damaged, _STEP)),
    "skins.step": ("skins.step", _half(_STEP, damaged)),
}
"""Files of a delivery with nothing else in it that `verify` reads."""
OUTPUTS: dict[str, tuple[str, Change]] = {
    "flats": ("flat/N-02.dxf", _half(damaged, lines_damaged)),
    "glb": ("panels.glb", damaged),
    "freecad": ("panels.FCStd", damaged),
    "html": ("report.html", damaged),
    "schedule": ("schedule.csv", damaged),
    "setting-out": ("setting_out.csv", _half(damaged, lines_damaged)),
}
"""Files of deliveries that have one output more each, by its name."""
KINDS = (*READ, *VERIFIED, *OUTPUTS)


class Fuzzer:
    """Tries damaged files, one at a time, in a place of its own."""

    def __init__(self, made: Path) -> None:
        """Make what is damaged, once for all processes."""
        self._files = models(made)
        self._plain = plain_delivery(made)
        self._with = {output: delivery_of(made, output) for output in OUTPUTS}
        self._stack = ExitStack()
        client.stop_reader()  # every process has its own

    def prepare(self) -> None:
        """What every process does first: a place of its own, and readers that are there at once."""
        self._place = Path(self._stack.enter_context(tempfile.TemporaryDirectory(prefix="fuzz-")))
        fork = self._stack.enter_context(forking())
        setattr(client, "interpreter", lambda _: fork(SERVER))  # noqa: B010 - as tests do
        requests.SECONDS_TO_READ = requests.SECONDS_TO_WORK = SECONDS

    def attempt(self, kind: str, seed: int) -> str:
        """What becomes of one."""
        shutil.rmtree(self._place, ignore_errors=True)
        self._place.mkdir()
        if kind in READ:
            name, change = READ[kind]
            path = self._place / name
            path.write_bytes(change(self._files[name], seed))
            return self._read(path, seed)
        name, change = VERIFIED[kind] if kind in VERIFIED else OUTPUTS[kind]
        folder = copied(self._with.get(kind, self._plain), self._place / "out")
        path = folder / name
        path.write_bytes(change(path.read_bytes(), seed))
        if name != "manifest.json":
            write_manifest(folder)
        return ended(lambda: "holds" if verify(folder).holds else "does not hold")

    def _read(self, path: Path, seed: int) -> str:
        def read() -> str:
            if path.suffix == ".obj":
                load_mesh(path, np.zeros(3), 1.0, 0.01)
            elif path.name == "products.step" and seed % 2:
                read_raw_panels(path)
            else:
                survey(path)
            return "read"

        end = ended(read)
        left = sorted(one.name for one in path.parent.iterdir())
        return end if left == [path.name] else f"LEFT: {left}"


def ended(work: Callable[[], str]) -> str:
    """What work ends in: its word, "refused", "crash, told", or in capitals what must not be."""
    try:
        return work()
    except CadpanelError as error:
        said = str(error)
    except Exception as error:  # noqa: BLE001 - this is what is looked for
        where = error.__traceback__
        while where is not None and where.tb_next is not None:
            where = where.tb_next
        place = "" if where is None else f"{where.tb_frame.f_code.co_filename}:{where.tb_lineno}"
        return f"TRACEBACK: {type(error).__name__}: {error} ({place})"[:LONGEST]
    if not said.endswith(".") or len(said) > LONGEST or NOT_FOR_PEOPLE.search(said):
        return f"NO SENTENCE: {said[:LONGEST]!r}"
    return "crash, told" if "the CAD kernel crash" in said or "keeps the CAD kernel busy" in said else "refused"
