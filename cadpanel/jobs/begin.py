"""A job to begin with: what `inspect` measures of a file, and of the ways to cut it the first that gives panels.

Nothing is written that was not tried: every region that stands in it was read, and each of its panels fitted alone.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tomli_w

from cadpanel.delivery.file_names import file_names
from cadpanel.errors import CadpanelError, ReferenceFileError
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.jobs.names import RESERVED
from cadpanel.jobs.variables import escaped
from cadpanel.reference.settings import ReferenceSettings

if TYPE_CHECKING:
    from cadpanel.brep.survey import SurfaceSurvey, Survey

_LONGEST_NAME = 60
USUAL_LENGTH = 2000.0
"""mm that a panel is long if the surface says nothing else."""
_LEANS = 2.0
"""Degrees from which seams are cut as the surface bends."""
_FOLD, _ROLLED, _FLAT = "plane-cone-plane", "cone", "planar-quadrilateral"


@dataclass(frozen=True, slots=True)
class Begun:
    """One region of the job: its name, what was measured, its values, or why there are none."""

    name: str
    measured: str
    values: Mapping[str, Any]
    refused: str = ""


def begun_job(file: Path, how: ReferenceSettings, folder: Path) -> str:
    """The text of a job for a file, to stand in a folder.

    Args:
        file: the reference.
        how: its unit, the faces to look at, and the tolerance within which faces touch.
        folder: from which the file is to be named.

    Raises:
        CadpanelError: the file cannot be read, or no way was found to cut it.
    """
    from cadpanel.brep.survey import survey

    whole = _ready_made(file, how)
    found = (whole,) if whole is not None else tuple(_regions(file, how, survey(file, how)))
    if all(region.refused for region in found):
        raise ReferenceFileError(
            f"no way was found to cut '{file.name}' into panels: {found[0].refused}"
            if found
            else f"'{file.name}' holds no faces."
        )
    return _text(file, how, folder, found)


def _ready_made(file: Path, how: ReferenceSettings) -> Begun | None:
    """The file as it is, where its products are panels; None where it is one surface to be cut, or is none."""
    from cadpanel.brep.read import read_reference

    try:
        reference = read_reference(file, how)
    except CadpanelError:
        return None
    if len(reference.panels) < 2:
        return None
    corners = {len(panel.edges) for panel in reference.panels}
    for feature in (_FOLD, _ROLLED, _FLAT) if corners == {4} else ("planar-polygon",):
        try:
            fit(reference, FitSettings(method="local", feature=feature))
        except CadpanelError:
            continue
        measured = f"{len(reference.panels)} panels as they are drawn, {len(reference.seams)} seams"
        return Begun(_name(file.stem), measured, {"feature": feature})
    return None


def _regions(file: Path, how: ReferenceSettings, found: Survey) -> Iterator[Begun]:
    names = file_names([surface.name for surface in found.surfaces], _LONGEST_NAME, RESERVED)
    for name, surface in zip(names, found.surfaces, strict=True):
        faces: dict[str, Any] = {} if len(found.surfaces) == 1 else {"faces": _ranges(surface.faces)}
        yield _first_that_works(file, how, name, surface, faces)


def _first_that_works(
    file: Path, how: ReferenceSettings, name: str, surface: SurfaceSurvey, faces: Mapping[str, Any]
) -> Begun:
    from cadpanel.brep.read import read_reference

    refused = ""
    for cut in _ways(surface):
        asked = replace(how, **{**faces, **cut})
        try:
            reference = read_reference(file, asked)
        except CadpanelError as error:
            refused = refused or str(error)
            continue
        for feature in (_FOLD, _ROLLED, _FLAT) if surface.lips else (_ROLLED, _FLAT):
            try:
                fit(reference, FitSettings(method="local", feature=feature))
            except CadpanelError as error:
                refused = refused or str(error)
                continue
            measured = f"{_measured(surface)}; this gives {len(reference.panels)} panels"
            return Begun(name, measured, {**faces, **cut, "feature": feature})
    return Begun(name, _measured(surface), faces, refused)


def _ways(surface: SurfaceSurvey) -> Iterator[dict[str, Any]]:
    """Ways to cut a surface, the likeliest first: what is wide and has no lip is rather cut both ways than along."""
    side = _round(min(USUAL_LENGTH, math.sqrt(surface.area) / 2.0))
    both = {"panel_size": (side, side)}
    wide = surface.strip is not None and not surface.lips and surface.strip[1] > USUAL_LENGTH
    if wide:
        yield both
    if surface.strip is not None:
        length = {"panel_length": _round(min(USUAL_LENGTH, surface.strip[0] / 2.0))}
        if surface.seams is not None and surface.seams.largest >= _LEANS:
            yield {**length, "seams": "conjugate"}
        yield length
    if not wide:
        yield both
    yield {"grid": (2, 2)}


def _round(length: float) -> float:
    """Two digits are enough to begin with, mm."""
    digit = 10.0 ** (math.floor(math.log10(length)) - 1)
    return max(math.floor(length / digit) * digit, digit)


def _measured(surface: SurfaceSurvey) -> str:
    said = [f"{surface.area / 1e6:.4g} m2"]
    if surface.strip is not None:
        said.append("a strip of {:.0f} x {:.0f} mm".format(*surface.strip))
    said += [f"a lip that turns by {lip.turn:.0f} degrees over {lip.width:.0f} mm" for lip in surface.lips or ()]
    if surface.seams is not None and surface.seams.largest >= _LEANS:
        said.append(f"where panels can meet seams lean by up to {surface.seams.largest:.0f} degrees")
    return ", ".join(said)


def _text(file: Path, how: ReferenceSettings, folder: Path, regions: Sequence[Begun]) -> str:
    changed = {one.name: getattr(how, one.name) for one in fields(how) if getattr(how, one.name) != one.default}
    asked = {name: value for name, value in changed.items() if name != "faces" or len(regions) == 1}
    lines = [
        f"# A job for '{_printable(file.name)}', as it was measured; 'cadpanel run' of this file makes it.",
        "# Settings are the options of 'cadpanel fit', with _ for -: 'cadpanel fit --help' says what each means.",
        "",
        "[defaults]                # hold for every region that does not say otherwise",
        _line("reference", _relative(file, folder)) + "   # files are named by where they lie from here",
        *(_line(name, value) for name, value in asked.items()),
        "# thickness = 3.0         # of the sheet, mm",
        "# joint = 10.0            # clear width between sheets, mm",
        "# step = 3.0              # largest step across a seam, mm",
        '# outputs = ["step", "flats", "schedule"]   # all that need no asking if not given',
    ]
    for region in regions:
        lines += ["", f"# {region.measured}"]
        if region.refused:
            lines += [f"# No way was found to cut it: {_printable(' '.join(region.refused.split()))}"]
        head = tomli_w.dumps({"regions": {region.name: {"x": 0}}}).splitlines()[0]
        marked = "# " if region.refused else ""
        lines += [f"{marked}{head}", *(f"{marked}{_line(name, value)}" for name, value in region.values.items())]
    lines += [
        "",
        "# [regions.NAME.matrix]   # one region for every combination, to see what each costs",
        "# gap_tolerance = [1.0, 3.0, 10.0]",
        "",
    ]
    return "\n".join(lines)


def _line(name: str, value: Any) -> str:
    return f"{name} = {_plain(value)}"


def _plain(value: Any) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_plain, value))}]"
    return tomli_w.dumps({"x": escaped(value)}).partition("= ")[2].strip()


def _printable(text: str) -> str:
    """What may stand in a comment."""
    return "".join(sign if sign.isprintable() else "_" for sign in text)


def _relative(file: Path, folder: Path) -> str:
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # from one drive to another
        return file.absolute().as_posix()


def _ranges(numbers: Sequence[int]) -> tuple[str, ...]:
    """Numbers of faces, those that follow each other as one range."""
    runs: list[list[int]] = []
    for number in sorted(numbers):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return tuple(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)


def _name(text: str) -> str:
    return file_names([text], _LONGEST_NAME, RESERVED)[0]
