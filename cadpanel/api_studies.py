"""What a Python program calls for many fits of one reference: what a gap costs, and how few panels will do."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack, cast

from cadpanel.api_keywords import check_keywords, spells_keywords
from cadpanel.api_result import FitResult, Study
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.settings import FitKeywords, FitSettings
from cadpanel.kinds import checked
from cadpanel.reference.model import Reference
from cadpanel.reference.settings import ReferenceSettings

if TYPE_CHECKING:
    from cadpanel.studies.fewest_panels import Fewest
    from cadpanel.studies.fewest_panels import Progress as FewestProgress
    from cadpanel.studies.held_points import Progress as StudyProgress


@checked
@spells_keywords("fit")
def study(
    reference: Reference | str | Path,
    *,
    gaps: Sequence[float],
    features: Sequence[str | PanelFeature] = ("plane-cone-plane",),
    divides: Sequence[int] = (),
    reading: ReferenceSettings | None = None,
    settings: FitSettings | None = None,
    out: str | Path | None = None,
    overwrite: bool = False,
    progress: StudyProgress | None = None,
    **changes: Unpack[FitKeywords],
) -> Study:
    """Fit every combination of gaps, features and numbers of panels: what a gap costs, and where it stops to pay.

    No row is worse than a fit of its own, nor than what a row with a tighter gap holds already.

    Args:
        reference: a reference, or the file to be cut into each of the numbers of panels.
        gaps: gap tolerances, mm.
        features: names, or features of one's own.
        divides: numbers of panels along each strip; none to take the reference as it is, or as `reading` cuts it.
        reading: how a file is read.
        settings: what all fits share.
        out: folder for study.json, study.csv and, where matplotlib is installed, study.png and study.svg, written whole
            or not at all; None to write nothing.
        overwrite: replace what cadpanel wrote there before.
        progress: told settings, reference, step (0 where a fit begins), largest excess over a tolerance, RMS deviation.
        changes: settings to change.

    Returns:
        What study.json holds; its `rows` are the points, and `plot()` draws them.

    Raises:
        ReferenceFileError: the file cannot be read or cut.
        SettingsError: a setting is out of its range, or a reference that is cut already is to be cut.
        DeliveryError: the folder is refused or cannot be written.
    """
    from cadpanel.brep.read import read_reference
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.delivery.folder import delivery_folder
    from cadpanel.delivery.records.study_rows import study_record
    from cadpanel.delivery.study_files import write_study_files
    from cadpanel.studies.trade_off import trade_off

    if isinstance(reference, Reference):
        if divides or reading is not None:
            raise SettingsError(
                "a reference is cut already: give the file to have it cut into several numbers of panels"
            )
        reads = [partial(_same, reference)]
    else:
        how = reading or ReferenceSettings()
        cuts = [replace(how, divide=count) for count in divides] or [how]
        reads = [partial(read_reference, reference, one) for one in cuts]
    asked = _asked(settings, changes)
    every = [replace(asked, feature=feature, gap_tolerance=gap) for feature in features for gap in dict.fromkeys(gaps)]
    with nullcontext() if out is None else delivery_folder(Path(out), overwrite=overwrite) as folder:
        found = study_record(trade_off(reads, every, progress, prepare=with_earlier))
        if folder is not None:
            write_study_files(found, folder)
    return Study.of(found)


def _same(reference: Reference) -> Reference:
    return reference


@checked
@spells_keywords("fit")
def fewest_panels(
    path: str | Path,
    settings: FitSettings | None = None,
    *,
    reading: ReferenceSettings | None = None,
    most: int = 200,
    progress: FewestProgress | None = None,
    time_limit: float | None = None,
    **changes: Unpack[FitKeywords],
) -> Fewest:
    """Find the fewest panels along each strip of a file that hold gaps, limits and the largest deviation.

    Args:
        path: the file.
        settings: with a largest deviation.
        reading: how the file is read; how it is divided is found.
        most: panels along a strip.
        progress: told the number of panels, the step (0 where a fit begins), the largest excess over a tolerance and
            the RMS deviation in mm; where it returns False the search ends with the best so far.
        time_limit: seconds after which it does.
        changes: settings to change, for example max_deviation=20.0.

    Returns:
        The `result`, what was `tried`, and whether everything is `held`.

    Raises:
        ReferenceFileError: the file cannot be read, or divided along strips.
        PanelError: no number of panels could be fitted.
        SettingsError: a setting is out of its range, or there is no largest deviation.
    """
    from cadpanel.brep.read import read_reference
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.studies.fewest_panels import fewest_panels as fewest

    how = reading or ReferenceSettings()

    def cut(count: int) -> Reference:
        return read_reference(path, replace(how, divide=count))

    asked = _asked(settings, changes)
    found = fewest(cut, asked, most=most, progress=progress, time_limit=time_limit, prepare=with_earlier)
    return replace(found, result=FitResult.of(found.result))


def _asked(settings: FitSettings | None, changes: FitKeywords) -> FitSettings:
    check_keywords("fit", changes)
    return replace(settings or FitSettings(), **cast("dict[str, Any]", changes))
