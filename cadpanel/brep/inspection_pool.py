"""Reads and inspects the two files of a delivery with a second interpreter, if it pays.

The second one reads the skins while the first reads the panels; then both inspect panels until none is left. A shape's
facts do not depend on who found them: shapes go over in the kernel's binary form, which keeps every digit.
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
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

from OCP.BinTools import BinTools
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.inspection import ShapeFacts, inspect
from cadpanel.brep.step import read_step_shapes
from cadpanel.errors import DeliveryError

WORTHWHILE_BYTES = 4_000_000
"""Size of a file from which reading takes longer than starting an interpreter with the kernel, about 2 s."""
CHUNK = 16
"""Shapes handed over at once, about 0.1 s of work."""
PIPE_BYTES = 1 << 20

Shapes = list[tuple[str, TopoDS_Shape]]


def inspect_files(
    panels_step: str | os.PathLike[str], skins_step: str | os.PathLike[str]
) -> tuple[list[ShapeFacts], list[ShapeFacts]]:
    """Facts of every shape in either file.

    Raises:
        DeliveryError: if a file cannot be read.
    """
    skins = Path(skins_step)
    if (os.cpu_count() or 1) < 2 or not skins.is_file() or skins.stat().st_size < WORTHWHILE_BYTES:
        return inspect_file(panels_step), inspect_file(skins_step)
    with _second_interpreter(skins) as helper:
        work = _Work(read_step_shapes(panels_step))
        with ThreadPoolExecutor(max_workers=1) as clerk:
            answer = clerk.submit(_employ, helper, work)
            try:
                work.do()
            except BaseException:
                helper.kill()  # or the clerk would wait for its answers
                raise
            skin_facts = answer.result()
    return work.result(), inspect_file(skins_step) if skin_facts is None else skin_facts


def inspect_file(path: str | os.PathLike[str]) -> list[ShapeFacts]:
    """Facts of every shape in one file, in its order."""
    return [inspect(name, shape) for name, shape in read_step_shapes(path)]


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


@contextmanager
def _second_interpreter(skins: Path) -> Iterator[subprocess.Popen[bytes]]:
    # A plain second interpreter, not multiprocessing: that would run the caller's own script again to get started.
    command = [sys.executable, "-m", "cadpanel.brep.inspection_pool", os.fspath(skins)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, bufsize=PIPE_BYTES) as helper:
        try:
            yield helper
        except BaseException:
            helper.kill()
            raise


def _employ(helper: subprocess.Popen[bytes], work: _Work) -> list[ShapeFacts] | None:
    """Take the skins' facts from the second interpreter and hand it shapes; None if it gave up before."""
    assert helper.stdin is not None
    assert helper.stdout is not None
    skins: list[ShapeFacts] | None = None
    try:
        skins = pickle.load(helper.stdout)
        while taken := work.take():
            pickle.dump([(work.shapes[index][0], _packed(work.shapes[index][1])) for index in taken], helper.stdin)
            helper.stdin.flush()
            work.facts.update(zip(taken, pickle.load(helper.stdout), strict=True))
        helper.stdin.close()
    except (OSError, EOFError, pickle.UnpicklingError):
        helper.kill()  # whatever is missing, the caller does itself
    return skins


def _packed(shape: TopoDS_Shape) -> bytes:
    stream = BytesIO()
    BinTools.Write_s(shape, stream)
    return stream.getvalue()


def _unpacked(data: bytes) -> TopoDS_Shape:
    shape = TopoDS_Shape()
    BinTools.Read_s(shape, BytesIO(data))
    return shape


def _serve(skins: str, requests: BinaryIO, answers: BinaryIO) -> None:
    """What the second interpreter does: the skins, then every chunk that comes, until none does."""
    found: list[ShapeFacts] = inspect_file(skins)
    while True:
        pickle.dump(found, answers)
        answers.flush()
        try:
            chunk: list[tuple[str, bytes]] = pickle.load(requests)
        except EOFError:
            return
        found = [inspect(name, _unpacked(data)) for name, data in chunk]


if __name__ == "__main__":
    # Answers go through a channel of their own, as the kernel may print to standard output.
    channel = os.fdopen(os.dup(sys.stdout.fileno()), "wb", buffering=PIPE_BYTES)
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    try:
        _serve(sys.argv[1], sys.stdin.buffer, channel)
    except DeliveryError:
        # The caller reads the file itself then, and says what is wrong with it.
        sys.exit(1)
