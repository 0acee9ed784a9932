"""Reads and inspects the two files of a delivery with a second interpreter, if it pays.

The second one reads the skins while the first reads the panels; then both inspect panels until none is left. A shape's
facts do not depend on who found them: shapes go over in the kernel's binary form, which keeps every digit. It takes
about 2 s to load the kernel, so whoever knows in time that files will be inspected starts it before.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections import deque
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.isolation.interpreter import interpreter
from cadpanel.brep.kernel.shapes import packed, unpacked
from cadpanel.brep.proof.shape_facts import ShapeFacts, inspect
from cadpanel.brep.step.file import step_shapes
from cadpanel.errors import DeliveryError

WORTHWHILE_BYTES = 4_000_000
"""Size of a file of skins from which reading takes longer than starting an interpreter with the kernel, about 2 s."""
WORTHWHILE_PANELS = 400
"""Panels whose skins make a file of that size."""
CHUNK = 16
"""Shapes handed over at once, about 0.1 s of work."""
PIPE_BYTES = 1 << 20

Shapes = list[tuple[str, TopoDS_Shape]]


class Helper:
    """A second interpreter that loads the kernel, then inspects what it is told to."""

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        self._process = process
        self._begun: Path | None = None

    def begin(self, skins: Path) -> None:
        """Let it read and inspect the file of skins, from now on; whether it can shows when its facts are asked for."""
        self._begun = skins
        try:
            self._send(os.fspath(skins))
        except OSError:
            self._process.kill()

    def facts(self, skins: Path, work: _Work) -> list[ShapeFacts] | None:
        """The skins' facts; then it takes shapes from `work` until none is left. None if it gave up before."""
        if self._begun != skins:
            self.begin(skins)
        found: list[ShapeFacts] | None = None
        try:
            found = self._receive()
            while taken := work.take():
                self._send([(work.shapes[index][0], packed(work.shapes[index][1])) for index in taken])
                work.facts.update(zip(taken, self._receive(), strict=True))
        except (OSError, EOFError, pickle.UnpicklingError):
            self.kill()  # whatever is missing, the caller does itself
        return found

    def kill(self) -> None:
        """End it at once."""
        self._process.kill()

    def _send(self, message: object) -> None:
        assert self._process.stdin is not None
        pickle.dump(message, self._process.stdin)
        self._process.stdin.flush()

    def _receive(self) -> list[ShapeFacts]:
        assert self._process.stdout is not None
        received: list[ShapeFacts] = pickle.load(self._process.stdout)
        return received


@contextmanager
def second_interpreter(panels: int) -> Iterator[Helper | None]:
    """Start a helper for a delivery of so many panels, where there is a processor for it and it pays; else None."""
    if (os.cpu_count() or 1) < 2 or panels < WORTHWHILE_PANELS:
        yield None
        return
    command = interpreter(__name__)
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, bufsize=PIPE_BYTES) as process:
        try:
            yield Helper(process)
        except BaseException:
            process.kill()
            raise
        finally:
            _hang_up(process)


def _hang_up(process: subprocess.Popen[bytes]) -> None:
    """Tell the helper that nothing more comes; one that is gone already needs no telling."""
    assert process.stdin is not None
    try:
        process.stdin.close()
    except OSError:
        process.kill()


def inspect_files(
    panels_step: str | os.PathLike[str], skins_step: str | os.PathLike[str], helper: Helper | None = None
) -> tuple[list[ShapeFacts], list[ShapeFacts]]:
    """Facts of every shape in either file.

    Args:
        panels_step: the file of solids.
        skins_step: the file of open shells.
        helper: a second interpreter that is running already; None to start one if it pays.

    Raises:
        DeliveryError: if a file cannot be read.
    """
    skins = Path(skins_step)
    if helper is not None:
        return _inspect_together(panels_step, skins, helper)
    worthwhile = skins.is_file() and skins.stat().st_size >= WORTHWHILE_BYTES
    with second_interpreter(WORTHWHILE_PANELS if worthwhile else 0) as started:
        if started is None:
            return inspect_file(panels_step), inspect_file(skins_step)
        return _inspect_together(panels_step, skins, started)


def _inspect_together(
    panels_step: str | os.PathLike[str], skins: Path, helper: Helper
) -> tuple[list[ShapeFacts], list[ShapeFacts]]:
    with step_shapes(panels_step) as shapes, ThreadPoolExecutor(max_workers=1) as clerk:
        work = _Work(shapes)
        answer = clerk.submit(helper.facts, skins, work)
        try:
            work.do()
        except BaseException:
            helper.kill()  # or the clerk would wait for its answers
            raise
        skin_facts = answer.result()
        panel_facts = work.result()
    return panel_facts, inspect_file(skins) if skin_facts is None else skin_facts


def inspect_file(path: str | os.PathLike[str]) -> list[ShapeFacts]:
    """Facts of every shape in one file, in its order."""
    with step_shapes(path) as shapes:
        return [inspect(name, shape) for name, shape in shapes]


@dataclass(slots=True)
class _Work:
    """Shapes to inspect, taken from the front by one interpreter and from the back by the other."""

    shapes: Shapes
    waiting: deque[int] = field(init=False)
    facts: dict[int, ShapeFacts] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.waiting = deque(range(len(self.shapes)))

    def do(self) -> None:
        """Inspect from the front until nothing waits."""
        while True:
            try:
                index = self.waiting.popleft()
            except IndexError:
                return
            self.facts[index] = inspect(*self.shapes[index])

    def take(self) -> list[int]:
        """Up to CHUNK indices from the back."""
        taken: list[int] = []
        while len(taken) < CHUNK:
            try:
                taken.append(self.waiting.pop())
            except IndexError:
                break
        return taken

    def result(self) -> list[ShapeFacts]:
        """All facts in the order of the shapes; what the other interpreter took and kept is inspected now."""
        return [self.facts.get(index) or inspect(*shape) for index, shape in enumerate(self.shapes)]


def _serve(requests: BinaryIO, answers: BinaryIO) -> None:
    """What the second interpreter does: the file that it is told first, then every chunk that comes."""
    try:
        skins: str = pickle.load(requests)
        with step_shapes(skins) as shapes:
            found = [inspect(name, shape) for name, shape in shapes]
            while True:
                pickle.dump(found, answers)
                answers.flush()
                chunk: list[tuple[str, bytes]] = pickle.load(requests)
                found = [inspect(name, unpacked(data)) for name, data in chunk]
    except EOFError:
        return


def main() -> None:
    """Answer what comes on the standard input."""
    # Answers go through a channel of their own, as the kernel may print to standard output.
    channel = os.fdopen(os.dup(sys.stdout.fileno()), "wb", buffering=PIPE_BYTES)
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    try:
        _serve(sys.stdin.buffer, channel)
    except DeliveryError:
        # The caller reads the file itself then, and says what is wrong with it.
        sys.exit(1)
