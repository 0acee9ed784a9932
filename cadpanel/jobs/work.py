"""What is done for one task, wherever that is: a function of the task and its bytes, and of nothing else.

Numbers are computed by one thread, as sums that several threads share may end in another last digit.
"""

from __future__ import annotations

import errno
import itertools
import os
import shutil
import tempfile
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from threadpoolctl import threadpool_limits

from cadpanel.brep.isolation.client import Died
from cadpanel.brep.isolation.processors import given_processors, usable
from cadpanel.causes import causes, stopped_by
from cadpanel.delivery.source_date import VARIABLE
from cadpanel.delivery.work_folders import clear_left_behind, work_folder
from cadpanel.errors import CadpanelError, DeliveryError, ProofError
from cadpanel.jobs.archive import packed
from cadpanel.jobs.make import Asked, make_delivery
from cadpanel.jobs.program import program, program_sum
from cadpanel.jobs.task import Content, Task, located
from cadpanel.memory import give_back

RETRIES = 2
"""How often a task that has failed is tried again: a disk may have room the next time, another one its turn.

What is refused would be refused again, and is not.
"""
RETRIES_OF_A_CRASH = 1
"""How often one is tried again over which the CAD kernel has crashed: a system short of memory kills it, too."""
_FULL = frozenset({errno.ENOSPC, errno.EDQUOT})
MET, MISSED, REFUSED, FAILED = 0, 1, 2, 3
"""What comes of a task, as exit codes have it."""
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

Tell = Callable[[str, int, int, str], None]
"""Told the step, how much of it is done of how much, and a detail."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Made:
    """What came of a task.

    Attributes:
        key: of the task.
        code: MET, MISSED, REFUSED or FAILED.
        archive: the delivery; None where there is none.
        said: what is missed, or why there is no delivery, in sentences.
        details: where in the program a failure was that nobody foresaw.
        tries: how often it was tried.
    """

    key: str
    code: int
    archive: bytes | None
    said: str | None
    details: str = ""
    tries: int = 1


def work(task: Task, contents: Sequence[Content | bytes], tell: Tell, *, side_by_side: int = 1) -> Made:
    """Make the delivery of a task; a failure that nobody foresaw is tried again, and told in the end.

    Args:
        task: what is to be made.
        contents: its files, where they lie here, or their bytes, in their order.
        tell: told of the steps.
        side_by_side: how many tasks are worked at on this machine at once, which share its processors. What is made
            does not depend on it.

    Raises:
        KeyboardInterrupt, SystemExit: somebody ends the program, whatever error that comes out as.
    """
    if task.program != program_sum(task.needs):
        said = (
            f"the worker has another cadpanel, {program()['version']}, another Python or other packages: install one "
            "everywhere"
        )
        return refused(task, said)
    for tries in itertools.count(1):
        try:
            with given_processors(max(1, usable() // side_by_side)):
                archive, missed = _made(task, contents, tell)
        except Exception as error:  # noqa: BLE001 - the others go on, and whoever sits there is told of this one
            stopped = stopped_by(error)
            if stopped is not None:
                raise stopped from None
            failed, retries = _failed(task, error, tries), _retries(error)
        else:
            return Made(key=task.key, code=MISSED if missed else MET, archive=archive, said=missed, tries=tries)
        finally:
            give_back()
        if retries:
            tell(f"failed {tries} of {retries + 1} times", 0, 1, failed.said or "")
        if tries > retries:
            break
    return failed


def _retries(error: Exception) -> int:
    """How often what has failed so is tried again."""
    if any(isinstance(cause, Died) for cause in causes(error)):
        return RETRIES_OF_A_CRASH
    if isinstance(error, DeliveryError):
        return 0 if _fault_of_a_disk(error) is None else RETRIES
    return 0 if isinstance(error, CadpanelError) else RETRIES


def _fault_of_a_disk(error: Exception) -> OSError | None:
    """What the system said of it; None where it is something else."""
    faults = (cause for cause in causes(error) if isinstance(cause, OSError) and not isinstance(cause, CadpanelError))
    return next(faults, None)


def _failed(task: Task, error: Exception, tries: int) -> Made:
    """What comes of a task that has failed, in a sentence."""
    if isinstance(error, ProofError):
        said = f"the proof does not hold: {' '.join(error.failures)}"
        return Made(key=task.key, code=MISSED, archive=None, said=said, tries=tries)
    disk = _fault_of_a_disk(error)
    if disk is not None and disk.errno in _FULL:
        said = (
            f"'{tempfile.gettempdir()}' has no room for a delivery while it is made ({disk.strerror}): make room there "
            "or, by the variable TMPDIR, name a folder of another disk"
        )
        return refused(task, said, tries)
    if isinstance(error, CadpanelError):
        return refused(task, error, tries)
    said = f"{type(error).__name__}: {' '.join(str(error).split())}"
    details = "".join(traceback.format_exception(error))
    return Made(key=task.key, code=FAILED, archive=None, said=said, details=details, tries=tries)


def refused(task: Task, why: object, tries: int = 1) -> Made:
    """What comes of a task that is refused, in a sentence."""
    return Made(key=task.key, code=REFUSED, archive=None, said=str(why), tries=tries)


def _made(task: Task, contents: Sequence[Content | bytes], tell: Tell) -> tuple[bytes, str | None]:
    with _temporary_folder() as place, _as_told(task.date), threadpool_limits(1):
        paths = []
        for number, (content, data) in enumerate(zip(task.contents, contents, strict=True)):
            path = place / str(number) / content.name
            path.parent.mkdir()
            path.write_bytes(data.read() if isinstance(data, Content) else data)
            paths.append(path)
        asked = Asked(
            file=paths[0],
            how=located(task.how, None if task.beside is None else paths[task.beside]),
            settings=task.settings,
            sheet=task.sheet,
            shop=task.shop,
            folder_of=lambda delivery: paths[task.locks[delivery]].parent,
        )
        folder = place / "delivery"
        folder.mkdir()
        _, missed = make_delivery(asked, folder, _Told(tell))
        return packed(folder, missed), missed


@contextmanager
def _temporary_folder() -> Iterator[Path]:
    """A folder for as long as the block runs; those of processes that were killed in it are cleared before."""
    parent = Path(tempfile.gettempdir()).absolute()
    clear_left_behind(parent)
    place = work_folder(parent / "region")
    place.mkdir(mode=0o700)  # nobody else is to read what is made
    try:
        yield place
    finally:
        shutil.rmtree(place, ignore_errors=True)


class _Told:
    """Steps as one line."""

    def __init__(self, tell: Tell) -> None:
        self._tell = tell

    def begin(self, step: str, detail: str = "") -> None:
        self._tell(step, 0, 1, detail)

    def count(self, step: str, done: int, of: int) -> None:
        self._tell(step, done, of, "")

    def solving(self, step: str, count: int, excess: float, rms: float) -> None:
        self._tell(
            step, 0, 1, f"step {count}: worst gap or drift at {excess:.2f} x its limit (held at 1), RMS {rms:.2f} mm"
        )


_environment = threading.Lock()


@contextmanager
def _as_told(date: str | None) -> Iterator[None]:
    """The date of files, and one thread in the interpreters that are started."""
    wanted = dict.fromkeys(_THREADS, "1") | ({} if date is None else {VARIABLE: date})
    with _environment:  # a process has one environment
        before = {name: os.environ.get(name) for name in wanted}
        os.environ.update(wanted)
        try:
            yield
        finally:
            for name, value in before.items():
                if value is None:
                    os.environ.pop(name, None)
                else:
                    os.environ[name] = value
