"""Second interpreters that are there at once: forked from a process that has loaded the kernel already.

Loading the kernel takes 1.5 s of a processor, and where it crashes over a hundred damaged files, it is loaded a hundred
times. Here one process loads what the second interpreter runs, `cadpanel.brep.server`, and forks itself whenever one is
started. The program under test stays as it is: it starts a command, and that is a small interpreter that hands its
pipes to the fork and ends as the fork does, by the same signal or with the same exit code. If it is killed, so is the
fork.
"""

from __future__ import annotations

import gc
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

CAN_FORK = hasattr(os, "fork") and hasattr(os, "pidfd_open")
"""On Linux; elsewhere every interpreter loads the kernel itself."""
LOADED = "import cadpanel.brep.server"
SERVER = "from cadpanel.brep.server import main; main()"
READY = b"ready\n"
STREAMS = 3
MOST_TEXT = 1 << 16  # bytes
STATUS = 4  # bytes

Command = Callable[[str], list[str]]
"""From the text that an interpreter is to run, the command that starts it."""

HANDS_OVER = f"""
import os, signal, socket, sys
with socket.socket(socket.AF_UNIX) as line:
    line.connect(sys.argv[1])
    socket.send_fds(line, [sys.argv[2].encode()], range({STREAMS}))
    code = os.waitstatus_to_exitcode(int.from_bytes(line.recv({STATUS}), "little"))
if code < 0:
    os.kill(os.getpid(), -code)
os._exit(code)
"""


@contextmanager
def forking() -> Iterator[Command]:
    """Start interpreters by forking, as long as this lasts, where the system can."""
    if not CAN_FORK:
        yield lambda text: [sys.executable, "-P", "-c", _here(text)]
        return
    with tempfile.TemporaryDirectory() as folder:  # with a short path, as sockets want it
        place = str(Path(folder) / "forks")
        load = _here(f"{LOADED}; from {__name__} import fork_for_all; fork_for_all({place!r})")
        with subprocess.Popen(
            [sys.executable, "-P", "-c", load], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        ) as loaded:
            try:
                assert loaded.stdout is not None
                assert loaded.stdout.readline() == READY
                yield lambda text: [sys.executable, "-I", "-S", "-c", HANDS_OVER, place, text]
            finally:
                loaded.kill()


def _here(text: str) -> str:
    """The same text, for an interpreter that is to find the same modules as this one."""
    return f"import sys; sys.path[:] = {[str(Path(path).absolute()) for path in sys.path if path]!r}\n{text}"


def fork_for_all(place: str) -> None:
    """Fork, with all that is loaded, for whoever asks at a socket, until the standard input ends."""
    gc.freeze()  # what is loaded stays shared with the forks
    running: dict[int, tuple[int, socket.socket]] = {}
    with socket.socket(socket.AF_UNIX) as door:
        door.bind(place)
        door.listen()
        os.write(sys.stdout.fileno(), READY)
        while True:
            ready = select.select([sys.stdin, door, *running, *(line for _, line in running.values())], [], [])[0]
            if sys.stdin in ready:
                return
            for watched in [one for one in running if one in ready or running[one][1] in ready]:
                _end(watched, *running.pop(watched))
            if door in ready:
                line = door.accept()[0]
                text, streams, *_ = socket.recv_fds(line, MOST_TEXT, STREAMS)
                if (process := os.fork()) == 0:
                    _become(text.decode(), streams)
                for stream in streams:
                    os.close(stream)
                running[os.pidfd_open(process)] = process, line


def _become(text: str, streams: list[int]) -> None:
    """Run the text as an interpreter of its own would, and end."""
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
    os.closerange(STREAMS, max(streams) + 1)
    code = 1
    try:
        exec(text, {"__name__": "__main__"})
        code = 0
    finally:
        if error := sys.exc_info()[1]:
            sys.excepthook(type(error), error, error.__traceback__)
        sys.stderr.flush()
        os._exit(code)


def _end(watched: int, process: int, line: socket.socket) -> None:
    """Tell how a fork has ended, or end it where whoever asked for it is gone."""
    try:
        os.kill(process, signal.SIGKILL)  # which does nothing to one that has ended
        line.sendall(os.waitpid(process, 0)[1].to_bytes(STATUS, "little"))
    except BrokenPipeError:
        pass  # nobody is there to hear it
    finally:
        line.close()
        os.close(watched)
