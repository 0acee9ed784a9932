"""What one interpreter asks of the second one, and how requests and answers go over a pipe.

A request is worked on in stages, each over one file and with a time of its own: what is damaged shows while it is read,
for which less time is allowed than for the work. The second interpreter says when it goes on to the next stage. So a
frame is the length of what follows, and an answer; or 0 and nothing, for "the next stage begins".
"""

from __future__ import annotations

import pickle
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from cadpanel.brep.isolation.processors import processors
from cadpanel.errors import CadpanelError, ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings

Work = Literal["panels", "survey", "rails"]

SECONDS_TO_READ = 120.0
"""Time allowed for reading any file, the start of the interpreter included."""
SECONDS_PER_MEGABYTE = 10.0
"""More time for larger files; what is whole takes 0.2 s."""
SECONDS_TO_WORK = 3600.0
"""Time allowed for cutting and measuring what was read; ten thousand panels take two minutes."""
DAMAGED = "it is damaged or far too large; export it again, with fewer faces"
REPAIR = "it is damaged; repair the reference and export it again"
WORKED_ON = "repair it where it was modelled, cut it into fewer panels, or cut it another way"
DOING: dict[Work, str] = {"panels": "cutting", "survey": "measuring", "rails": "converting"}
HEADER = struct.Struct("<Q")
NEXT_STAGE = HEADER.pack(0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """A part of what is done for a request.

    Attributes:
        file: name of the file that it is done with, for messages.
        doing: what is done ("reading"), for messages.
        seconds: time allowed. The second interpreter ends itself when a processor has been busy for so long: nobody
            else would end it, once the interpreter that asked has been killed.
        remedy: what to do where it takes longer, or fails.
        crashed: what to do where the kernel crashes.
        refusal: the error that says so.
    """

    file: str
    doing: str
    seconds: float
    remedy: str = WORKED_ON
    crashed: str = REPAIR
    refusal: type[CadpanelError] = ReferenceFileError


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What the second interpreter is to do.

    Attributes:
        work: by the name under which the second interpreter knows it.
        folder: in which names of files are looked for.
        path: the file, as the user named it.
        argument: how; what it is depends on the work.
        stages: one or more.
        processors: how many the work may keep busy at once; as many as whoever asks may, if nothing else is said.
    """

    work: str
    folder: Path
    path: Path
    argument: object
    stages: tuple[Stage, ...]
    processors: int = field(default_factory=processors)


def work_request(work: Work, path: Path, settings: ReferenceSettings) -> Request:
    """Read a file, and the one beside it that says how it is cut, and work on it."""
    beside = settings.beside(path) if work == "panels" else None
    return Request(
        work=work,
        folder=looked_for_in(path, ReferenceFileError),
        path=path,
        argument=settings,
        stages=(
            *(reading(file) for file in (path, beside) if file is not None),
            Stage(file=path.name, doing=DOING[work], seconds=SECONDS_TO_WORK),
        ),
    )


def looked_for_in(path: Path, refusal: type[CadpanelError]) -> Path:
    """The folder in which names of files are looked for: the current one, or the file's own where that is gone.

    Raises:
        CadpanelError: the current folder is gone, and the file is named by its place in it.
    """
    try:
        return Path.cwd()
    except FileNotFoundError:
        if path.is_absolute():
            return path.parent
        raise refusal(
            f"'{path}' cannot be found: the folder that the program stands in no longer exists; change to another one."
        ) from None


def reading(path: Path) -> Stage:
    """The stage in which a file is read."""
    return Stage(file=path.name, doing="reading", seconds=seconds_to_read(path), remedy=DAMAGED)


def seconds_to_read(path: Path) -> float:
    """Time allowed for a file of its size; whoever reads it says what is wrong with one that is not there."""
    try:
        size = path.stat().st_size
    except OSError:
        size = 0
    return SECONDS_TO_READ + SECONDS_PER_MEGABYTE * size / 1e6


def framed(message: object) -> bytes:
    """A message as it goes over the pipe."""
    data = pickle.dumps(message)
    return HEADER.pack(len(data)) + data
