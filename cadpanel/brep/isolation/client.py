"""A second interpreter that reads files, so that a crash or an endless loop of the CAD kernel takes nothing with it.

The kernel crashes over some damaged files whatever is looked for in their text before: of 1500 STEP files with a
reference, a number, a line or a bit changed, two ended the process; and of damaged .brep files that were read, one in
25 crashes it, or keeps it busy for ever, when a curve is laid over its faces. So every file is read, cut and measured
there. The interpreter starts once (about 2 s, beside the kernel's start in this one) and takes one file after the
other; one that dies is replaced at the next file. Shapes come back in the kernel's binary form, panels as arrays.

Nothing of the kernel is imported here, so that a command can start the reader before it loads the kernel itself.
"""

from __future__ import annotations

import atexit
import os
import pickle
import selectors
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Literal

from cadpanel.brep.isolation.interpreter import interpreter
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings

Task = Literal["products", "model"]
Work = Literal["panels", "survey"]
Kind = Literal["read", "hold", "work"]
Reading = Callable[[Task, Path, float | None], object]

SECONDS_TO_READ = 120.0
"""Time allowed for any file, the start of the interpreter included."""
SECONDS_PER_MEGABYTE = 10.0
"""More time for larger files; what is whole takes 0.2 s."""
SECONDS_TO_WORK = 3600.0
"""Time allowed for cutting and measuring what was read; ten thousand panels take two minutes."""
DAMAGED = "it is damaged or far too large; export it again, with fewer faces"
WORKED_ON = "repair it where it was modelled, cut it into fewer panels, or cut it another way"
HEADER = struct.Struct("<Q")
CHUNK_BYTES = 1 << 20


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What the second interpreter is to do.

    Attributes:
        kind: read a file, hold it for the work that comes next, or work on it.
        task: what to make of it.
        folder: in which names of files are looked for.
        path: the file, as the user named it.
        argument: how many millimetres its unit has, where it is read; the settings, where it is worked on.
        seconds: time allowed. It ends itself when a processor has been busy for so long: nobody else would end it, once
            the interpreter that asked has been killed.
    """

    kind: Kind
    task: Task | Work
    folder: Path
    path: Path
    argument: object
    seconds: float


class _Reader:
    """The second interpreter, started when it is first needed."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._said: IO[bytes] | None = None

    def start(self) -> subprocess.Popen[bytes]:
        """Return the running interpreter, a new one if there is none."""
        if self._process is None or self._process.poll() is not None:
            self._said = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the interpreter runs
            self._process = subprocess.Popen(
                interpreter("cadpanel.brep.server"),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._said,
                bufsize=0,
            )
        return self._process

    def ask(self, request: Request, name: str, remedy: str = DAMAGED) -> object:
        """Hand over one request and return the answer.

        Args:
            request: what to do.
            name: the file's, for messages.
            remedy: what to do about a file over which the interpreter does not end.

        Raises:
            ReferenceFileError: the interpreter died over it, or did not answer in time.
        """
        with self._lock:
            process = self.start()
            assert process.stdin is not None
            try:
                process.stdin.write(_framed(pickle.dumps(request)))
                return pickle.loads(_answer(process, time.monotonic() + request.seconds))
            except TimeoutError:
                raise ReferenceFileError(
                    f"'{name}' keeps the CAD kernel busy for more than {request.seconds:.0f} s: {remedy}."
                ) from None
            except (EOFError, OSError):
                raise ReferenceFileError(
                    f"'{name}' makes {self._last_words(process)}: it is damaged; repair the reference "
                    "and export it again."
                ) from None
            finally:
                if sys.exc_info()[0] is not None:  # an interrupt, too, leaves an answer that nobody waits for
                    self._end()

    def _last_words(self, process: subprocess.Popen[bytes]) -> str:
        """How the interpreter ended: by a signal, or with an exception that it did not expect."""
        if process.wait() <= 0 or self._said is None:
            return "the CAD kernel crash"
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").split("\n")
        return f"reading fail ({next((line for line in reversed(lines) if line.strip()), 'without a word')})"

    def stop(self) -> None:
        """End the interpreter."""
        with self._lock:
            self._end()

    def _end(self) -> None:
        process, self._process = self._process, None
        if self._said is not None:
            self._said.close()
            self._said = None
        if process is None:
            return
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                stream.close()


_READER = _Reader()
atexit.register(_READER.stop)


def start_reader() -> None:
    """Start the second interpreter now, so that it is ready when a file is to be read."""
    _READER.start()


def stop_reader() -> None:
    """End the second interpreter, if it runs; the next file would start a new one."""
    _READER.stop()


_HERE: Reading | None = None
"""How the second interpreter itself reads a file; None in the first."""


def read_here(reading: Reading) -> None:
    """From now on, read files in this interpreter: it is the second one."""
    global _HERE
    _HERE = reading


@dataclass(frozen=True, slots=True)
class Held:
    """A file that is read, and kept, before the work on it begins: `millimetres` as in `read_guarded`."""

    task: Task
    path: Path
    millimetres: float | None = None


def work_guarded(work: Work, path: Path, settings: ReferenceSettings, held: Held) -> object:
    """Have a file worked on by the second interpreter.

    Args:
        work: what to do with it.
        path: the file.
        settings: how.
        held: how it is read, for which there is less time than for the work.

    Returns:
        What the work gives.

    Raises:
        CadpanelError: the file, or what is to be done, is refused, or the kernel crashes over it or does not end.
    """
    _ask("hold", held.task, held.path, held.millimetres, _seconds_to_read(held.path))
    return _ask("work", work, path, settings, SECONDS_TO_WORK, WORKED_ON)


def _ask(kind: Kind, task: Task | Work, path: Path, argument: object, seconds: float, remedy: str = DAMAGED) -> object:
    # This interpreter may stand in another folder by now than where that one was started.
    request = Request(kind=kind, task=task, folder=Path.cwd(), path=path, argument=argument, seconds=seconds)
    answer = _READER.ask(request, path.name, remedy)
    if isinstance(answer, Exception):
        raise answer
    return answer


def _seconds_to_read(path: Path) -> float:
    return SECONDS_TO_READ + SECONDS_PER_MEGABYTE * path.stat().st_size / 1e6


def read_guarded(task: Task, path: Path, millimetres: float | None, seconds: float | None = None) -> object:
    """Read a file in the second interpreter.

    Args:
        task: what to make of it.
        path: the file.
        millimetres: how many the file's unit has, where the user says so; None for the file's own.
        seconds: time allowed; None for what its size may need.

    Returns:
        What `cadpanel.brep.server` packs for the task.

    Raises:
        ReferenceFileError: the file is refused, or the kernel crashes over it or does not end.
    """
    if _HERE is not None:
        return _HERE(task, path, millimetres)
    return _ask("read", task, path, millimetres, _seconds_to_read(path) if seconds is None else seconds)


def _framed(data: bytes) -> bytes:
    return HEADER.pack(len(data)) + data


def _answer(process: subprocess.Popen[bytes], deadline: float) -> bytes:
    assert process.stdout is not None
    channel = process.stdout.fileno()
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)

        def receive(count: int) -> bytes:
            parts: list[bytes] = []
            while count:
                if not selector.select(max(0.0, deadline - time.monotonic())):
                    raise TimeoutError
                part = os.read(channel, min(count, CHUNK_BYTES))
                if not part:
                    raise EOFError
                parts.append(part)
                count -= len(part)
            return b"".join(parts)

        return receive(HEADER.unpack(receive(HEADER.size))[0])
