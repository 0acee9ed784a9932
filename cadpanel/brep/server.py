"""What the guarded interpreter does: read, cut, measure and inspect files that another one names."""

from __future__ import annotations

import os
import pickle
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import BinaryIO, cast

from OCP.Standard import Standard_Failure

from cadpanel.brep.building.many import measure_sheets
from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.curves.rails import FileCurves, load_curves
from cadpanel.brep.cutting.products_by_two import products_by_two
from cadpanel.brep.cutting.raw_panels import RawReference, raw_panels
from cadpanel.brep.cutting.ways import load_drawn
from cadpanel.brep.files.loading import load_model, load_reference
from cadpanel.brep.files.model import Model
from cadpanel.brep.isolation.copies import Ends, see_off, serving_copy
from cadpanel.brep.isolation.parent_watch import ends_with_whoever_asked
from cadpanel.brep.isolation.processors import given_processors
from cadpanel.brep.isolation.requests import HEADER, NEXT_STAGE, Request, Stage, framed
from cadpanel.brep.isolation.time_limit import limit_time, stop_limit
from cadpanel.brep.kernel.said import said_by
from cadpanel.brep.proof.archive import kept_facts
from cadpanel.brep.proof.finding_back import find_back
from cadpanel.brep.proof.inspection import Inspector, Packed, inspect_packed
from cadpanel.brep.proof.rebuilding import rebuild
from cadpanel.brep.survey import Survey, measured
from cadpanel.errors import CadpanelError
from cadpanel.memory import give_back
from cadpanel.reference.settings import ReferenceSettings

GoOn = Callable[[], None]
"""Tells whoever asked that the next stage begins."""


def panels(request: Request, go_on: GoOn) -> RawReference:
    """Read a reference, and what is drawn beside it, and cut it.

    Raises:
        CadpanelError: one of them is refused.
    """
    how = cast(ReferenceSettings, request.argument)
    by_two = products_by_two(request.path, how, go_on)
    if by_two is not None:
        return by_two
    found = load_reference(request.path, how)
    drawn = None
    if isinstance(found, Model):
        if how.beside(request.path) is not None:
            go_on()
        drawn = load_drawn(found, how, request.path)
    go_on()
    return raw_panels(found, how, drawn)


def survey(request: Request, go_on: GoOn) -> Survey:
    """Read a file and measure what it holds.

    Raises:
        CadpanelError: it is refused.
    """
    how = cast(ReferenceSettings, request.argument)
    model = load_model(request.path, how.millimetres)
    go_on()
    return measured(model, how)


def rails(request: Request, go_on: GoOn) -> FileCurves:
    """Read the loose curves of a file.

    Raises:
        CadpanelError: it is refused.
    """
    found = load_curves(request.path, cast(ReferenceSettings, request.argument))
    go_on()
    return found


INSPECTOR = Inspector()
WORKS: dict[str, Callable[[Request, GoOn], object]] = {
    "panels": panels,
    "survey": survey,
    "rails": rails,
    "open": lambda request, _: INSPECTOR.open(request.path),
    "facts": lambda request, _: INSPECTOR.facts(request.path, cast(Sequence[int], request.argument)),
    "pack": lambda request, _: INSPECTOR.pack(request.path, cast(Sequence[int], request.argument)),
    "inspect": lambda request, _: inspect_packed(cast(Packed, request.argument)),
    "common": lambda request, _: INSPECTOR.common(request.path, cast(Sequence[tuple[int, int]], request.argument)),
    "kept": lambda request, _: kept_facts(request.path),
    "measure": lambda request, _: measure_sheets(cast(Sequence[Sheet], request.argument)),
    "rebuild": lambda request, _: rebuild(cast(Sequence[Sheet], request.argument)),
    "back": lambda request, go_on: find_back(request.path, cast(Path, request.argument), go_on),
    "close": lambda _request, _: INSPECTOR.close(),
    "copy": lambda request, _: serving_copy(cast(Ends, request.argument), serve),
}
"""What can be asked for."""
LET_GO = frozenset({"panels", "survey", "rails", "close", "kept", "back"})
"""After which a file is held no more, or what was read of it."""


class _Stages:
    """The stages of a request, one after the other, each with the time that it has."""

    def __init__(self, request: Request, answers: BinaryIO) -> None:
        self._left: Iterator[Stage] = iter(request.stages)
        self._answers = answers
        self.now = next(self._left)
        limit_time(self.now.seconds)

    def go_on(self) -> None:
        """Begin the next stage; the last one lasts, though a file be read again in it that two could not read."""
        following = next(self._left, None)
        if following is None:
            return
        self._answers.write(NEXT_STAGE)
        self._answers.flush()
        self.now = following
        limit_time(self.now.seconds)


def answer(request: Request, answers: BinaryIO) -> object:
    """Do what is asked, or say why not."""
    os.chdir(request.folder)
    try:
        return _done(request, _Stages(request, answers))
    except CadpanelError as error:
        return error
    finally:
        stop_limit()


def _done(request: Request, stages: _Stages) -> object:
    try:
        with given_processors(request.processors):
            return WORKS[request.work](request, stages.go_on)
    except CadpanelError:
        raise
    except Exception as error:
        # Of the kernel, or over arrays that a damaged file fills with nonsense. Python shows the note, a command not.
        stage = stages.now
        what = "the CAD kernel fail" if isinstance(error, Standard_Failure) else f"its {stage.doing} fail"
        refusal = stage.refusal(f"'{stage.file}' makes {what} ({said_by(error)}): {stage.remedy}.")
        refusal.add_note(traceback.format_exc())
        raise refusal from error


def serve(requests: BinaryIO, answers: BinaryIO) -> None:
    """Answer one request after the other until none comes."""
    while header := requests.read(HEADER.size):
        request = pickle.loads(requests.read(HEADER.unpack(header)[0]))
        see_off()
        with ends_with_whoever_asked(requests.fileno()):
            found = answer(request, answers)
        answers.write(framed(found))
        answers.flush()
        del found
        if request.work in LET_GO:
            give_back()


def main() -> None:
    """Answer what comes on the standard input."""
    # Answers go through a channel of their own, as the kernel prints to standard output.
    channel = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    serve(sys.stdin.buffer, channel)
