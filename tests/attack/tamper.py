"""A delivery tampered with in every way that is known: `verify` must notice it, or list as not proved what was changed.

Whoever tampers writes the manifest anew, so that nothing but the proof can tell. What the kernel makes of a file, or of
numbers, is asked once: most kinds leave the STEP files as they are.
"""

from __future__ import annotations

import json
import os
import pickle
import shutil
import tempfile
from collections.abc import Callable, Hashable, Iterator
from contextlib import ExitStack
from fnmatch import fnmatchcase
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple, ParamSpec, TypeVar

from cadpanel.brep.isolation import client
from cadpanel.brep.proof import certificate, parallel
from cadpanel.delivery.document import proof as document
from cadpanel.delivery.manifest import write_manifest
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.unproved import BY_A_FIT, BY_REFERENCE, IN_NO_FILE
from cadpanel.delivery.verify import verify
from tests.attack.file_tampers import FILES
from tests.attack.fuzz import ended
from tests.attack.made import copied, flat_delivery, plain_delivery, rich_delivery
from tests.attack.report_tampers import BY_HAND, edited, of_values
from tests.attack.solid_tampers import SOLIDS
from tests.forking import SERVER, forking

UNNOTICED = "UNNOTICED"
NOTHING = "nothing"
"""A tamper of this name changes nothing."""


class Kind(NamedTuple):
    """A way to tamper.

    Attributes:
        of: which delivery.
        name: what is done.
        tamper: does it to a folder.
        key: of a report, which value it changes; empty elsewhere.
    """

    of: str
    name: str
    tamper: Callable[[Path], None]
    key: str = ""


class Tamperer:
    """Tampers with deliveries, and looks whether it is noticed."""

    def __init__(self, made: Path) -> None:
        """Make what is tampered with, once for all processes."""
        self._deliveries = {"rich": rich_delivery(made), "plain": plain_delivery(made), "flat": flat_delivery(made)}
        self.kinds = {f"{kind.of}, {kind.name}": kind for kind in self._all()}
        self._stack = ExitStack()
        client.stop_reader()  # every process has its own

    def _all(self) -> Iterator[Kind]:
        for of, delivery in self._deliveries.items():
            report = json.loads((delivery / "report.json").read_text(encoding="utf-8"))
            for key, change in of_values(report).items():
                if of == "rich" or key.startswith(("panels", "seams")):
                    yield Kind(of, f"report: {key}", partial(_report, change), key)
        for name, change in BY_HAND.items():
            yield Kind("rich", f"report: {name}", partial(_report, change))
        for name, tamper in FILES.items():
            yield Kind("rich", name, tamper)
        for of in ("plain", "flat"):
            for name, tamper in SOLIDS.items():
                yield Kind(of, name, tamper)

    def prepare(self) -> None:
        """What every process does first."""
        self._place = Path(self._stack.enter_context(tempfile.TemporaryDirectory(prefix="tamper-")))
        fork = self._stack.enter_context(forking())
        setattr(client, "interpreter", lambda _: fork(SERVER))  # noqa: B010 - as tests do
        inspected = _once(parallel.inspect_files, lambda *files, **_: _contents(*files[:2]))
        rebuilt = _once(parallel.rebuild, lambda _, sheets, *__: pickle.dumps(sheets))
        kept = _once(parallel.inspect_archive, _contents)
        for place, name, work in (
            (certificate, "inspect_files", inspected),
            (certificate, "rebuild", rebuilt),
            (document, "inspect_archive", kept),
        ):
            assert hasattr(place, name)
            setattr(place, name, work)

    def attempt(self, name: str, _seed: int = 0) -> str:
        """What becomes of one."""
        kind = self.kinds[name]
        shutil.rmtree(self._place, ignore_errors=True)
        folder = copied(self._deliveries[kind.of], self._place / "out")
        try:
            kind.tamper(folder)
        except Exception as error:  # noqa: BLE001 - a tamper that does nothing must not count as noticed
            return f"NOT TAMPERED: {type(error).__name__}: {error}"
        if not kind.name.startswith("manifest"):
            write_manifest(folder)
        return ended(lambda: self._judged(folder, kind))

    @cache  # noqa: B019 - one object a process
    def _said_of_nothing(self, of: str) -> frozenset[str]:
        """What is said of a delivery whose files the kernel's own writer has written."""
        folder = copied(self._deliveries[of], self._place / "untouched")
        SOLIDS[NOTHING](folder)
        write_manifest(folder)
        return frozenset(verify(folder).failures)

    def _judged(self, folder: Path, kind: Kind) -> str:
        if kind.key and read_report(folder / REPORT) == read_report(self._deliveries[kind.of] / REPORT):
            return "says the same"  # a value was left out that is meant where none is given
        found = verify(folder)
        said = set(found.failures) - (self._said_of_nothing(kind.of) if kind.name in SOLIDS else set())
        if kind.name == NOTHING:
            return "holds"
        if said:
            return "noticed"
        listed = (*BY_REFERENCE, *BY_A_FIT, *IN_NO_FILE)
        words = {one.what for one in listed if any(fnmatchcase(kind.key, key) for key in one.keys)}
        return "listed as not proved" if words & set(found.unproved) else UNNOTICED


Given = ParamSpec("Given")
Found = TypeVar("Found")


def _once(work: Callable[Given, Found], known_by: Callable[Given, Hashable]) -> Callable[Given, Found]:
    """Work that is done once for whatever it is known by."""
    done: dict[Hashable, Found] = {}

    def remembered(*args: Given.args, **kwargs: Given.kwargs) -> Found:
        key = known_by(*args, **kwargs)
        if key not in done:
            done[key] = work(*args, **kwargs)
        return done[key]

    return remembered


def _contents(*files: str | os.PathLike[str]) -> Hashable:
    return tuple(Path(file).read_bytes() if Path(file).is_file() else None for file in files)


def _report(change: Callable[[object], None], folder: Path) -> None:
    edited(folder / "report.json", change)
