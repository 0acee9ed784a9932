"""What is done for one task, wherever that is: a function of the task and its bytes, and of nothing else.

Numbers are computed by one thread, as sums that several threads share may end in another last digit.
"""

from __future__ import annotations

import os
import tempfile
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from threadpoolctl import threadpool_limits

from cadpanel.brep.isolation.processors import given_processors, usable
from cadpanel.delivery.source_date import VARIABLE
from cadpanel.errors import CadpanelError, DeliveryError, ProofError
from cadpanel.jobs.archive import packed
from cadpanel.jobs.make import Asked, make_delivery
from cadpanel.jobs.program import program, program_sum
from cadpanel.jobs.task import Content, Task, located
from cadpanel.memory import give_back

RETRIES = 2
"""How often a task that has failed is tried again; what is refused would be refused again, and is not."""
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
    """
    if task.program != program_sum(task.needs):
        said = (
            f"the worker has another cadpanel, {program()['version']}, another Python or other packages: install one "
            "everywhere"
        )
        return refused(task, said)
    for tries in range(1, RETRIES + 2):
        try:
            with given_processors(max(1, usable() // side_by_side)):
                archive, missed = _made(task, contents, tell)
        except ProofError as error:
            said = f"the proof does not hold: {' '.join(error.failures)}"
            return Made(key=task.key, code=MISSED, archive=None, said=said, tries=tries)
        except DeliveryError as error:  # of a disk, which may have room the next time
            failed = refused(task, error, tries)
        except CadpanelError as error:
            return refused(task, error, tries)
        except Exception as error:  # noqa: BLE001 - the others go on, and whoever sits there is told of this one
            said = f"{type(error).__name__}: {' '.join(str(error).split())}"
            details = "".join(traceback.format_exception(error))
            failed = Made(key=task.key, code=FAILED, archive=None, said=said, details=details, tries=tries)
        else:
            return Made(key=task.key, code=MISSED if missed else MET, archive=archive, said=missed, tries=tries)
        finally:
            give_back()
        tell(f"failed {tries} of {RETRIES + 1} times", 0, 1, failed.said or "")
    return failed


def refused(task: Task, why: object, tries: int = 1) -> Made:
    """What comes of a task that is refused, in a sentence."""
    return Made(key=task.key, code=REFUSED, archive=None, said=str(why), tries=tries)


def _made(task: Task, contents: Sequence[Content | bytes], tell: Tell) -> tuple[bytes, str | None]:
    with tempfile.TemporaryDirectory(prefix="cadpanel-") as place, _as_told(task.date), threadpool_limits(1):
        paths = []
        for number, (content, data) in enumerate(zip(task.contents, contents, strict=True)):
            path = Path(place) / str(number) / content.name
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
        folder = Path(place) / "delivery"
        folder.mkdir()
        _, missed = make_delivery(asked, folder, _Told(tell))
        return packed(folder, missed), missed


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
