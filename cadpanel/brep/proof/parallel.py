"""Reads and inspects the two files of a delivery in the guarded interpreter, and in one more, if that pays.

A file may be damaged as well as a reference may, so neither is read here. The one more reads the skins while the other
one reads the panels; then both inspect panels until none is left. It begins as a copy of the other one; where that is
not possible it loads the kernel, which takes 2 s, so whoever knows in time that files will be inspected starts it then.
"""

from __future__ import annotations

import os
import queue
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from pathlib import Path
from typing import cast

from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.isolation.client import LOOK_UP, READER, CopiedInterpreter, Interpreter
from cadpanel.brep.isolation.processors import processors
from cadpanel.brep.isolation.requests import SECONDS_TO_WORK, Request, Stage, looked_for_in, seconds_to_read
from cadpanel.brep.proof.kept_facts import KeptFacts
from cadpanel.brep.proof.rebuilt import Rebuilt
from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.errors import DeliveryError, PanelError

WORTHWHILE_BYTES = 4_000_000
"""Size of a file of skins from which reading takes longer than starting an interpreter with the kernel, about 2 s."""
WORTHWHILE_PANELS = 400
"""Panels whose skins make a file of that size."""
CHUNK = 16
"""Shapes asked for at once, about 0.1 s of work."""
AHEAD = 2
"""Chunks that lie ready for the helper, so that it never waits for one to be packed."""
WRITE_AGAIN = "it is damaged; write the delivery again"

Chunk = tuple[list[int], object]
Told = Callable[[int], None]
"""Told how many shapes more were looked at, by whichever thread waited for them."""


def unheard(_: int) -> None:
    """Nobody listens."""


class _File:
    """A file of a delivery, and the interpreter that has it."""

    def __init__(self, interpreter: Interpreter, path: Path) -> None:
        self._interpreter, self._path = interpreter, path

    def ask(self, work: str, argument: object = None, *, reads: bool = False) -> object:
        """Ask for some work with the file.

        Raises:
            DeliveryError: it cannot be read, or the kernel crashes over it or does not end.
        """
        seconds = seconds_to_read(self._path) if reads else SECONDS_TO_WORK
        stage = Stage(
            file=self._path.name,
            doing="reading" if reads else "inspection",
            seconds=seconds,
            remedy=WRITE_AGAIN,
            crashed=WRITE_AGAIN,
            refusal=DeliveryError,
        )
        request = Request(
            work=work,
            folder=looked_for_in(self._path, DeliveryError),
            path=self._path,
            argument=argument,
            stages=(stage,),
        )
        return self._interpreter.ask(request)

    def open(self) -> int:
        """Read it; returns the number of its shapes."""
        return cast(int, self.ask("open", reads=True))

    def facts(self, places: Sequence[int]) -> list[ShapeFacts]:
        """Facts of some of its shapes."""
        return cast(list[ShapeFacts], self.ask("facts", places))

    def common_volumes(self, pairs: Sequence[tuple[int, int]]) -> list[float]:
        """Read it and measure what pairs of its shapes share, mm3."""
        self.open()
        found = cast(list[float], self.ask("common", pairs))
        self.ask("close")
        return found

    def kept(self) -> dict[str, KeptFacts]:
        """Facts of the shapes that it keeps as text."""
        return cast(dict[str, KeptFacts], self.ask("kept", reads=True))

    def rebuilt(self, sheets: Sequence[Sheet], told: Told) -> list[Rebuilt | PanelError]:
        """What the kernel makes of sheets, some at a time, so that none has to wait for an answer for long."""
        found: list[Rebuilt | PanelError] = []
        for first in range(0, len(sheets), CHUNK):
            made = cast(list[Rebuilt | PanelError], self.ask("rebuild", sheets[first : first + CHUNK]))
            told(len(made))
            found += made
        return found

    def all_facts(self, told: Told = unheard) -> list[ShapeFacts]:
        """Read it and inspect all of it."""
        found: list[ShapeFacts] = []
        count = self.open()
        for first in range(0, count, CHUNK):
            some = self.facts(range(first, min(first + CHUNK, count)))
            told(len(some))
            found += some
        self.ask("close")
        return found


class Helper:
    """An interpreter that inspects files beside the one that reads them."""

    def __init__(self, interpreter: Interpreter) -> None:
        self._interpreter = interpreter
        self._clerk = ThreadPoolExecutor(max_workers=1)
        self._reader = ThreadPoolExecutor(max_workers=1)
        self._begun: tuple[Path, Future[list[ShapeFacts]]] | None = None
        self._clerk.submit(interpreter.start)
        self._opened: tuple[Path | None, Future[int]] | None = None

    def open(self, panels: Path) -> Future[int]:
        """Let the guarded interpreter read the file of panels, from now on."""
        if self._opened is None or self._opened[0] != panels:
            self._opened = panels, self._reader.submit(_File(READER, panels).open)
        return self._opened[1]

    def take_opened(self, panels: Path) -> Future[int]:
        """The same for who inspects it now: whoever asks again has it read again."""
        opened = self.open(panels)
        self._opened = None, opened  # still to be ended, if it is not done by then
        return opened

    def begin(self, skins: Path) -> Future[list[ShapeFacts]]:
        """Let it read and inspect the file of skins, from now on."""
        if self._begun is None or self._begun[0] != skins:
            self._begun = skins, self._clerk.submit(_File(self._interpreter, skins).all_facts)
        return self._begun[1]

    def join(self, panels: Path, work: _Work) -> Future[None]:
        """Let it take chunks of panels from `work` after that, until none comes any more."""
        return self._clerk.submit(work.help, _File(self._interpreter, panels))

    def rebuild(self, panels: Path, sheets: Sequence[Sheet], told: Told) -> Future[list[Rebuilt | PanelError]]:
        """Let it build sheets of the file of panels anew."""
        return self._clerk.submit(_File(self._interpreter, panels).rebuilt, sheets, told)

    def end(self) -> None:
        """End it at once, and what the other one reads for nobody any more."""
        if self._opened is not None:
            while not self._opened[1].done():  # it may be about to ask, and would start the reader again
                READER.interrupt()
                wait([self._opened[1]], timeout=LOOK_UP)
        self._interpreter.kill()
        self._reader.shutdown(cancel_futures=True)
        self._clerk.shutdown(cancel_futures=True)
        self._interpreter.stop()


@contextmanager
def second_interpreter(panels: int) -> Iterator[Helper | None]:
    """Start what a delivery of so many panels is inspected by; a helper, too, where it pays and has a processor."""
    READER.start()
    if processors() < 2 or panels < WORTHWHILE_PANELS:
        yield None
        return
    helper = Helper(CopiedInterpreter(READER))
    try:
        yield helper
    finally:
        helper.end()


def inspect_files(
    panels_step: str | os.PathLike[str],
    skins_step: str | os.PathLike[str],
    helper: Helper | None = None,
    told: Told = unheard,
) -> tuple[list[ShapeFacts], list[ShapeFacts]]:
    """Facts of every shape in either file.

    Args:
        panels_step: the file of solids.
        skins_step: the file of open shells.
        helper: that is running already; None to start one if it pays.
        told: how many shapes more were inspected.

    Raises:
        DeliveryError: if a file cannot be read, or the kernel crashes over it or does not end.
    """
    panels, skins = Path(panels_step), Path(skins_step)
    if helper is not None:
        return _inspect_together(panels, skins, helper, told)
    worthwhile = skins.is_file() and skins.stat().st_size >= WORTHWHILE_BYTES
    with second_interpreter(WORTHWHILE_PANELS if worthwhile else 0) as started:
        if started is None:
            return _File(READER, panels).all_facts(told), _File(READER, skins).all_facts(told)
        return _inspect_together(panels, skins, started, told)


def inspect_archive(path: Path) -> dict[str, KeptFacts]:
    """Facts of every shape that an archive keeps, by the names of their files.

    Raises:
        DeliveryError: it cannot be read, or the kernel crashes over it or does not end.
    """
    return _File(READER, path).kept()


def rebuild(
    panels_step: str | os.PathLike[str], sheets: Sequence[Sheet], helper: Helper | None = None, told: Told = unheard
) -> list[Rebuilt | PanelError]:
    """The sheets of a file of panels, built anew; half of them by a helper, if there is one.

    Raises:
        DeliveryError: if the kernel crashes over one of them or does not end.
    """
    file, path = _File(READER, Path(panels_step)), Path(panels_step)
    if helper is None or len(sheets) < CHUNK:
        return file.rebuilt(sheets, told)
    half = len(sheets) // 2
    others = helper.rebuild(path, sheets[half:], told)
    return [*file.rebuilt(sheets[:half], told), *others.result()]


def common_volumes(panels_step: str | os.PathLike[str], pairs: Sequence[tuple[int, int]]) -> list[float]:
    """The volume that pairs of a file's shapes share, mm3, by their places in it.

    Raises:
        DeliveryError: if the file cannot be read, or the kernel crashes over it or does not end.
    """
    return _File(READER, Path(panels_step)).common_volumes(pairs)


def _inspect_together(
    panels: Path, skins: Path, helper: Helper, told: Told
) -> tuple[list[ShapeFacts], list[ShapeFacts]]:
    work = _Work(told)
    opened, of_skins, helped = helper.take_opened(panels), helper.begin(skins), helper.join(panels, work)
    try:
        work.do(_File(READER, panels), opened.result())
    finally:
        work.end()
    found = of_skins.result()
    told(len(found))  # the helper may have begun with them before anybody listened
    helped.result()
    return work.facts(), found


class _Work:
    """The shapes of one file, inspected from the front by the interpreter that has it, from the back by a helper."""

    def __init__(self, told: Told) -> None:
        self._told = told
        self._facts: dict[int, ShapeFacts] = {}
        self._ready: queue.SimpleQueue[Chunk | None] = queue.SimpleQueue()
        self._helped = threading.Event()

    def do(self, file: _File, shapes: int) -> None:
        """Inspect so many shapes that the file holds, or have them packed for the helper once that one has time."""
        waiting = deque(range(shapes))
        while waiting:
            count = min(CHUNK, len(waiting))
            if self._helped.is_set() and self._ready.qsize() < AHEAD:
                places = [waiting.pop() for _ in range(count)]
                self._ready.put((places, file.ask("pack", places)))
            else:
                places = [waiting.popleft() for _ in range(count)]
                self._take(places, file.facts(places))
        file.ask("close")

    def help(self, file: _File) -> None:
        """Inspect chunk after chunk, until none comes any more."""
        self._helped.set()
        while (chunk := self._ready.get()) is not None:
            places, shapes = chunk
            self._take(places, cast(list[ShapeFacts], file.ask("inspect", shapes)))

    def end(self) -> None:
        """Tell the helper that nothing more comes."""
        self._ready.put(None)

    def facts(self) -> list[ShapeFacts]:
        """All facts in the order of the shapes."""
        return [self._facts[place] for place in sorted(self._facts)]

    def _take(self, places: Sequence[int], facts: Sequence[ShapeFacts]) -> None:
        self._facts.update(zip(places, facts, strict=True))
        self._told(len(places))
