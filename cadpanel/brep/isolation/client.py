"""A second interpreter that reads files, so that a crash or an endless loop of the CAD kernel takes nothing with it.

The kernel crashes over some damaged files whatever is looked for in their text before: of 1500 STEP files with a
reference, a number, a line or a bit changed, two ended the process; and of damaged .brep files that were read, one in
25 crashes it, or keeps it busy for ever, when a curve is laid over its faces. So every file is read, cut and measured
there. The interpreter starts once (about 2 s, beside the kernel's start in this one) and takes one file after the
other; one that dies is replaced at the next file. What comes back are arrays.

Nothing of the kernel is imported here, so that a command can start the reader before it loads the kernel itself.
"""

from __future__ import annotations

import atexit
import os
import pickle
import queue
import subprocess
import tempfile
import threading
import time
from pathlib import Path
from typing import IO, cast

from cadpanel.brep.isolation.copies import COPYABLE, Copy, Ends
from cadpanel.brep.isolation.interpreter import interpreter
from cadpanel.brep.isolation.requests import HEADER, SECONDS_TO_READ, Request, Stage, Work, framed, work_request
from cadpanel.errors import CadpanelError
from cadpanel.reference.settings import ReferenceSettings

CHUNK_BYTES = 1 << 20
# A wait of this length, s, ends early enough for an interrupt from the keyboard, which on Windows breaks into no wait.
LOOK_UP = 0.5
# On Windows, what a process that has crashed returns is not below 0, but from here on.
CRASHED_ON_WINDOWS = 0xC0000000
Process = subprocess.Popen[bytes] | Copy


class Died(Exception):
    """What a refusal is made of where the second interpreter has died over the file."""


class Interpreter:
    """A second interpreter, started when it is first needed."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: Process | None = None
        self._said: IO[bytes] | None = None
        self._frames: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self._listener: threading.Thread | None = None
        self._killed = False

    def start(self) -> Process:
        """Return the running interpreter, a new one if there is none.

        Raises:
            RuntimeError: it was killed for good.
        """
        with self._lock:
            return self._started()

    def _started(self) -> Process:
        if self._killed:
            raise RuntimeError("the second interpreter was killed")
        if self._process is None or self._process.poll() is not None:
            self._end()
            self._process = self._begun()
            self._heed_kill()
            # A thread waits for what comes: a pipe that is read with a time limit is a thing of POSIX.
            self._frames = queue.SimpleQueue()
            self._listener = threading.Thread(target=_listen, args=(self._process.stdout, self._frames), daemon=True)
            self._listener.start()
        return self._process

    def _begun(self) -> Process:
        self._said = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the interpreter runs
        return subprocess.Popen(
            interpreter("cadpanel.brep.server"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._said,
            bufsize=0,
        )

    def ask(self, request: Request) -> object:
        """Hand over one request and return the answer.

        Raises:
            CadpanelError: the file, or what is to be done, is refused; or, by the refusal of the stage in which that
                happens, the interpreter dies over it, or does not end in time.
        """
        with self._lock:
            process = self._started()
            try:
                answer = self._answer(process, request)
            except BaseException:  # an interrupt, too, leaves an answer that nobody waits for
                self._end()
                raise
        found: object = pickle.loads(answer)
        if isinstance(found, Exception):
            raise found
        return found

    def _answer(self, process: Process, request: Request) -> bytes:
        """Hand over a request and wait for what comes back.

        Raises:
            CadpanelError: the interpreter dies over it, or does not end in time.
        """
        assert process.stdin is not None
        stages = iter(request.stages)
        stage = next(stages)
        try:
            _write(process.stdin, framed(request))
            while not (answer := self._frame(time.monotonic() + stage.seconds)):
                stage = next(stages, stage)
        except TimeoutError:
            raise stage.refusal(
                f"'{stage.file}' keeps the CAD kernel busy for more than {stage.seconds:.0f} s: {stage.remedy}."
            ) from None
        except (EOFError, OSError):
            raise stage.refusal(f"'{stage.file}' makes {self._last_words(process)}: {stage.crashed}.") from Died()
        return answer

    def _frame(self, deadline: float) -> bytes:
        """The next frame without its length: empty where the next stage begins.

        Raises:
            TimeoutError: none has come until then.
            EOFError: none will come.
        """
        while (left := deadline - time.monotonic()) > 0.0:
            try:
                frame = self._frames.get(timeout=min(left, LOOK_UP))
            except queue.Empty:
                continue
            if frame is None:
                raise EOFError
            return frame
        raise TimeoutError

    def _last_words(self, process: Process) -> str:
        """How the interpreter ended: by a signal, or with an exception that it did not expect."""
        code = process.wait()
        if code <= 0 or code >= CRASHED_ON_WINDOWS or self._said is None:
            return "the CAD kernel crash"
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").split("\n")
        return f"reading fail ({next((line for line in reversed(lines) if line.strip()), 'without a word')})"

    def stop(self) -> None:
        """End the interpreter."""
        with self._lock:
            self._end()

    def kill(self) -> None:
        """End the interpreter for good, at once, whoever waits for its answer; that one is told that it has died."""
        self._killed = True
        self._heed_kill()

    def _heed_kill(self) -> None:
        """End it if it was killed: it may have been while it was being started."""
        process = self._process
        if self._killed and process is not None:
            process.kill()

    def interrupt(self) -> None:
        """End the interpreter at once, whoever waits for its answer; the next request starts a new one."""
        process = self._process
        if process is not None:
            process.kill()

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            if self._listener is not None:
                self._listener.join()
            for stream in (process.stdin, process.stdout):
                if stream is not None:
                    stream.close()
        if self._said is not None:
            self._said.close()
            self._said = None


def _write(stream: IO[bytes], data: bytes) -> None:
    """Write all of it: a stream without a buffer may take a part only."""
    rest = memoryview(data)
    while rest:
        rest = rest[stream.write(rest) :]


def _listen(stream: IO[bytes], frames: queue.SimpleQueue[bytes | None]) -> None:
    """Pass on one frame after the other, then None where the stream ends."""

    def received(count: int) -> bytes:
        parts: list[bytes] = []
        while count:
            part = stream.read(min(count, CHUNK_BYTES))
            if not part:
                raise EOFError
            parts.append(part)
            count -= len(part)
        return b"".join(parts)

    try:
        while True:
            frames.put(received(HEADER.unpack(received(HEADER.size))[0]))
    except (EOFError, OSError):
        frames.put(None)


class CopiedInterpreter(Interpreter):
    """One that begins as a copy of another one, which has loaded what it needs, where that is possible.

    Whether it is the one or the other makes no difference to whoever asks it.
    """

    def __init__(self, original: Interpreter) -> None:
        """Say of which one."""
        super().__init__()
        self._original = original

    def _begun(self) -> Process:
        if COPYABLE:
            try:
                return _copy_of(self._original)
            except (CadpanelError, RuntimeError, OSError):  # then it begins as any other does
                pass
        return super()._begun()


def _copy_of(original: Interpreter) -> Copy:
    """A copy of an interpreter, which is started if it does not run.

    Raises:
        CadpanelError: it makes none.
        RuntimeError: it was killed for good.
        OSError: the copy has ended already, or there are no more pipes.
    """
    its_requests, requests = os.pipe()
    answers, its_answers = os.pipe()
    ends = Ends(process=os.getpid(), requests=its_requests, answers=its_answers)
    stage = Stage(file="a copy", doing="copying", seconds=SECONDS_TO_READ)
    within = Path(__file__).parent
    try:
        asked = Request(work="copy", folder=within, path=within, argument=ends, stages=(stage,))
        process = cast(int, original.ask(asked))
        return Copy(process, os.pidfd_open(process), requests, answers)
    except BaseException:
        os.close(requests)
        os.close(answers)
        raise
    finally:
        os.close(its_requests)
        os.close(its_answers)


READER = Interpreter()
"""The one that reads whatever is to be read."""
atexit.register(READER.stop)


def start_reader() -> None:
    """Start the second interpreter now, so that it is ready when a file is to be read."""
    READER.start()


def stop_reader() -> None:
    """End the second interpreter, if it runs; the next file would start a new one."""
    READER.stop()


def work_guarded(work: Work, path: Path, settings: ReferenceSettings) -> object:
    """Have a file read and worked on by the second interpreter.

    Args:
        work: what to do with it.
        path: the file.
        settings: how.

    Returns:
        What the work gives.

    Raises:
        CadpanelError: the file, or what is to be done, is refused, or the kernel crashes over it or does not end.
    """
    return READER.ask(work_request(work, path, settings))
