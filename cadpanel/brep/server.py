"""What the guarded interpreter does: read, cut and measure files that another one names."""

from __future__ import annotations

import math
import os
import pickle
import resource
import sys
import traceback
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO, cast

from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files.catalogue import format_of
from cadpanel.brep.files.packing import PackedModel, PackedProducts
from cadpanel.brep.files.step import STEP
from cadpanel.brep.files.step_products import read_products
from cadpanel.brep.isolation.client import HEADER, WORKED_ON, Request, Task, Work, read_here
from cadpanel.brep.kernel.placement import placed
from cadpanel.brep.kernel.shapes import compound_of, packed, shapes_of
from cadpanel.errors import CadpanelError, ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings


def read(task: Task, path: Path, millimetres: float | None) -> PackedModel | PackedProducts:
    """Read a file and pack what it holds.

    Raises:
        ReferenceFileError: the kernel cannot read it.
    """
    if task == "products":
        products = read_products(path, millimetres)
        names = tuple(product.name for product in products.shapes)
        whole = _placed(path.name, [product.shape for product in products.shapes])
        return PackedProducts(names=names, unit=products.unit, shapes=packed(whole))
    form = format_of(path)
    model = form.read(path, millimetres)
    whole = _placed(path.name, [part.shape for part in model.parts])
    if form is not STEP:
        _try_out(path.name, whole)
    bare = tuple(replace(part, shape=None) for part in model.parts)
    return PackedModel(model=replace(model, parts=bare), shapes=packed(whole))


def _placed(source: str, shapes: Sequence[TopoDS_Shape]) -> TopoDS_Shape:
    """All shapes of a file as one compound without locations: what they share stays shared."""
    try:
        return placed(compound_of(shapes))
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{source}' puts a shape where the CAD kernel cannot put it ({error}): place it without a mirror or a "
            "scale and export again."
        ) from error


def _try_out(source: str, whole: TopoDS_Shape) -> None:
    """Evaluate every face here, where a crash of the kernel does no harm.

    The STEP reader checks what it builds, and of 1500 damaged files none crashed later; the other readers take shapes
    over as they are.
    """
    for face in shapes_of(whole, TopAbs_FACE):
        try:
            sample_faces(face)
        except (Standard_Failure, ValueError, FloatingPointError) as error:
            raise ReferenceFileError(
                f"'{source}' holds a face that the CAD kernel cannot evaluate ({error}): repair the reference and "
                "export it again."
            ) from error


WORDS: dict[Work, str] = {"panels": "cutting", "survey": "measuring"}

# Files that were read to be worked on next.
_held: dict[tuple[Task, Path, float | None], PackedModel | PackedProducts] = {}


def held_or_read(task: Task, path: Path, millimetres: float | None) -> PackedModel | PackedProducts:
    """What was read before, else what is read now.

    Raises:
        ReferenceFileError: the kernel cannot read it.
    """
    held = _held.get((task, path, millimetres))
    return read(task, path, millimetres) if held is None else held


def answer(request: Request) -> object:
    """Do what is asked.

    Raises:
        CadpanelError: the file, or what is asked, is refused.
    """
    os.chdir(request.folder)
    _limit(request.seconds)
    if request.kind == "work":
        try:
            return _work(cast(Work, request.task), request.path, cast(ReferenceSettings, request.argument))
        finally:
            _held.clear()
    task, millimetres = cast(Task, request.task), cast("float | None", request.argument)
    found = read(task, request.path, millimetres)
    if request.kind == "read":
        return found
    _held.clear()
    _held[task, request.path, millimetres] = found
    return None


def _limit(seconds: float) -> None:
    """Let the system end this interpreter once all processors have been busy for so long."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    soft = used.ru_utime + used.ru_stime + seconds * (os.cpu_count() or 1)
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    if hard == resource.RLIM_INFINITY or soft < hard:
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(soft), hard))


def _work(work: Work, path: Path, settings: ReferenceSettings) -> object:
    # Here, as both modules read files themselves.
    from cadpanel.brep.cutting.raw_panels import raw_panels
    from cadpanel.brep.survey import measured

    try:
        return raw_panels(path, settings) if work == "panels" else measured(path, settings)
    except CadpanelError:
        raise
    except Exception as error:
        # Of the kernel, or over arrays that a damaged file fills with nonsense. Python shows the note, a command not.
        what = "the CAD kernel fail" if isinstance(error, Standard_Failure) else f"its {WORDS[work]} fail"
        refusal = ReferenceFileError(f"'{path.name}' makes {what} ({str(error) or type(error).__name__}): {WORKED_ON}.")
        refusal.add_note(traceback.format_exc())
        raise refusal from error


def serve(requests: BinaryIO, answers: BinaryIO) -> None:
    """Answer one request after the other until none comes."""
    read_here(held_or_read)
    while header := requests.read(HEADER.size):
        found: object
        try:
            found = answer(pickle.loads(requests.read(HEADER.unpack(header)[0])))
        except CadpanelError as error:
            found = error
        data = pickle.dumps(found)
        answers.write(HEADER.pack(len(data)) + data)
        answers.flush()


def main() -> None:
    """Answer what comes on the standard input."""
    # Answers go through a channel of their own, as the kernel prints to standard output.
    channel = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    serve(sys.stdin.buffer, channel)
