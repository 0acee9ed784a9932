"""From a file to the reference: which panels there are, what to approximate, and who meets whom.

Reading, cutting and sampling is for the guarded interpreter, as the kernel may crash in any of them over a file that is
damaged; what comes back are arrays.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import cast

from cadpanel.brep.cutting.raw_panels import RawReference
from cadpanel.brep.cutting.remedies import other_ways
from cadpanel.brep.isolation.client import work_guarded
from cadpanel.errors import CadpanelError, NoStripError, OutlineError, OverlapError
from cadpanel.reference.assemble import assemble
from cadpanel.reference.model import Reference
from cadpanel.reference.settings import ReferenceSettings, file_named


def read_reference(path: str | Path, settings: ReferenceSettings | None = None) -> Reference:
    """Read a file into panels with outlines and seams.

    Args:
        path: a STEP, IGES, .brep or .3dm file.
        settings: how; by default each product of the file is one panel: a face, a shell, or a compound of faces.

    Raises:
        ReferenceFileError: the file cannot be read, does not hold panels, or cannot be cut into them.
        PanelError: one of the panels is none. Where the cut is at fault, two other ways are tried, and one that gives
            panels is named.
        SettingsError: the path is no name of a file, or a setting does not fit the file.
    """
    path, how = file_named(path, "reference"), settings or ReferenceSettings()
    try:
        return _read(path, how)
    except (OutlineError, NoStripError) as error:
        remedy = _seen_to_help(path, how)
        if remedy is None:
            raise
        raise error.with_remedy(remedy) from error
    except OverlapError as error:
        if how.way is None:
            raise
        raise error.of_a_cut() from error


def _read(path: Path, how: ReferenceSettings) -> Reference:
    raw = read_raw_panels(path, how)
    reference = assemble(raw.panels, path.name, how.seam_tolerance, how.junctions, raw.outlines)
    return replace(reference, notes=(*reference.notes, *raw.notes), settings=how, origin=raw.origin)


def _seen_to_help(path: Path, how: ReferenceSettings) -> str | None:
    """Of other ways to cut, the first that gives panels; that none of them does; None where there is none to try."""
    others = other_ways(how)
    for other in others:
        try:
            _read(path, other.settings)
        except CadpanelError:
            continue
        return f"{other.called} cuts it"
    tried = [other.called for other in others]
    return None if not tried else f"{' and '.join(tried)} {'does' if len(tried) == 1 else 'do'} not help"


def read_raw_panels(path: str | Path, settings: ReferenceSettings | None = None) -> RawReference:
    """Read a file into sampled faces, panel by panel, in millimetres; see `raw_panels`.

    Raises:
        ReferenceFileError: the file cannot be read, holds no faces, cannot be cut as asked, or the kernel crashes over
            it or does not end.
        PanelError: a product is a solid, holds no face, or holds one that cannot be sampled.
    """
    path, how = file_named(path, "reference"), settings or ReferenceSettings()
    return cast(RawReference, work_guarded("panels", path, how))
