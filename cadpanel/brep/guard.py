"""A second interpreter that reads files, so that a crash or an endless loop of the CAD kernel takes nothing with it.

The kernel crashes over some damaged files whatever is looked for in their text before: of 1500 STEP files with a
reference, a number, a line or a bit changed, two ended the process. So every file is read there. The interpreter starts
once (about 2 s, beside the kernel's start in this one) and reads one file after the other; one that dies is replaced at
the next file. What it read comes back in the kernel's binary form, in a small part of the time that reading takes.

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
from pathlib import Path
from typing import IO, Literal

from cadpanel.errors import ReferenceFileError

Task = Literal["products", "model"]

SECONDS_TO_READ = 120.0
"""Time allowed for any file, the start of the interpreter included."""
SECONDS_PER_MEGABYTE = 10.0
"""More time for larger files; what is whole takes 0.2 s."""
HEADER = struct.Struct("<Q")
CHUNK_BYTES = 1 << 20


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
            # A plain interpreter, not multiprocessing: that would run the caller's own script again to get started.
            self._process = subprocess.Popen(
                [sys.executable, "-m", "cadpanel.brep.reading"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._said,
                bufsize=0,
            )
        return self._process

    def ask(self, request: tuple[object, ...], name: str, seconds: float) -> object:
        """Hand over one request and return the answer.

        Raises:
            ReferenceFileError: the interpreter died over it, or did not answer in time.
        """
        with self._lock:
            process = self.start()
            assert process.stdin is not None
            try:
                process.stdin.write(_framed(pickle.dumps(request)))
                return pickle.loads(_answer(process, time.monotonic() + seconds))
            except TimeoutError:
                raise ReferenceFileError(
                    f"'{name}' keeps the CAD kernel busy for more than {seconds:.0f} s: it is damaged or "
                    "far too large; export it again, with fewer faces."
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


def read_guarded(task: Task, path: Path, millimetres: float | None, seconds: float | None = None) -> object:
    """Read a file in the second interpreter.

    Args:
        task: what to make of it.
        path: the file.
        millimetres: how many the file's unit has, where the user says so; None for the file's own.
        seconds: time allowed; None for what its size may need.

    Returns:
        What `cadpanel.brep.reading` packs for the task.

    Raises:
        ReferenceFileError: the file is refused, or the kernel crashes over it or does not end.
    """
    if seconds is None:
        seconds = SECONDS_TO_READ + SECONDS_PER_MEGABYTE * path.stat().st_size / 1e6
    answer = _READER.ask((task, os.fspath(path.absolute()), millimetres), path.name, seconds)
    if isinstance(answer, ReferenceFileError):
        raise answer
    return answer


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
