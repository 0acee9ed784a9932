"""What a Python program calls: read, fit, take the solids, deliver. Millimetres throughout.

Everything that needs the CAD kernel is imported when it is called, so that a program which only looks at results, or
asks for help, does not wait for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack, cast, overload

from cadpanel import api_result
from cadpanel.api_keywords import MadeKeywords, SheetKeywords, check_keywords, spells_keywords
from cadpanel.api_sheets import Panels, build_sheets, shapes_of, title_of
from cadpanel.delivery.settings import Ends, Schema
from cadpanel.delivery.shop_settings import ShopKeywords
from cadpanel.errors import SettingsError
from cadpanel.fitting.result import FitResult, Progress
from cadpanel.fitting.run import fit as fit_reference
from cadpanel.fitting.settings import LIKE_THE_PAPER, FitKeywords, FitSettings
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.kinds import checked
from cadpanel.reference.model import Reference
from cadpanel.reference.settings import ReferenceKeywords, ReferenceSettings

if TYPE_CHECKING:
    import build123d
    import cadquery

    from cadpanel.brep.survey import Survey
    from cadpanel.delivery.records.comparison import ComparisonModel
    from cadpanel.delivery.records.report import ReportModel
    from cadpanel.delivery.sheets import Progress as DeliveryProgress
    from cadpanel.studies.table1 import Progress as CompareProgress


@checked
@spells_keywords("read")
def read(
    path: str | Path, settings: ReferenceSettings | None = None, **changes: Unpack[ReferenceKeywords]
) -> Reference:
    """Read a STEP, IGES, .brep or Rhino .3dm file into panels, and find out which of them meet.

    Args:
        path: the file. Unless it is to be cut, each product in it is one panel's faces.
        settings: how; the fields of `ReferenceSettings`.
        changes: settings to change, for example divide=9, grid=(20, 10), network="curves.step" or faces="layer=Skin".

    Raises:
        ReferenceFileError: the file cannot be read, does not hold panels, or cannot be cut into them.
        PanelError: one of the panels is none.
        SettingsError: a setting is out of its range, or contradicts another one.
    """
    from cadpanel.brep.read import read_reference

    return read_reference(path, _changed(settings, changes))


@checked
@spells_keywords("read")
def inspect(
    path: str | Path, settings: ReferenceSettings | None = None, **changes: Unpack[ReferenceKeywords]
) -> Survey:
    """Measure what a file holds: faces, curves, surfaces that hang together, and their lips.

    Args:
        path: a STEP, IGES, .brep or Rhino .3dm file.
        settings: how to read it; its unit, faces and seam_tolerance count.
        changes: settings to change, for example unit="m".

    Raises:
        ReferenceFileError: the file cannot be read, or holds neither faces nor curves.
        SettingsError: a setting is out of its range.
    """
    from cadpanel.brep.survey import survey

    return survey(path, _changed(settings, changes))


def _changed(settings: ReferenceSettings | None, changes: ReferenceKeywords) -> ReferenceSettings:
    check_keywords("read", changes)
    # The settings bring every form that a keyword may have into one.
    given = {field.name: getattr(settings, field.name) for field in fields(ReferenceSettings)} if settings else {}
    return ReferenceSettings(**cast("dict[str, Any]", {**given, **changes}))


def _asked(settings: FitSettings | None, changes: FitKeywords) -> FitSettings:
    check_keywords("fit", changes)
    return replace(settings or FitSettings(), **cast("dict[str, Any]", changes))


@checked
@spells_keywords("fit")
def fit(
    reference: Reference | str | Path,
    settings: FitSettings | None = None,
    *,
    progress: Progress | None = None,
    time_limit: float | None = None,
    **changes: Unpack[FitKeywords],
) -> api_result.FitResult:
    """Fit all panels of a reference.

    Args:
        reference: what is to be approximated: as `read` gives it, or a file that is read as it is.
        settings: how; by default concurrent plane-cone-plane, steps of at most 3 mm, seams within 3 degrees of the
            drawn ones.
        progress: told the method, the step, the largest excess over a tolerance (1 where it holds) and the RMS
            deviation in mm; where it returns False the fit ends with the best so far.
        time_limit: seconds after which the fit ends with the best so far, which keeps all limits but perhaps gaps.
        changes: settings to change, for example gap_tolerance=5.0.

    Returns:
        The panels and their measures; it draws itself, and `result["NW-01"]` is a panel's shape.

    Raises:
        ReferenceFileError: a file cannot be read, or does not hold panels.
        PanelError: a panel's faces are nothing that the feature could approximate.
        SettingsError: a setting is out of its range.
    """
    if time_limit is not None and not time_limit > 0.0:
        raise SettingsError(f"the time limit must be above 0 s, not {time_limit:g}")
    how = _asked(settings, changes)
    read_in = reference if isinstance(reference, Reference) else read(reference)
    if how.rules is not None and how.rules.unread:
        from cadpanel.delivery.earlier import with_earlier

        how = with_earlier(how, read_in)
    return api_result.FitResult.of(fit_reference(read_in, how, progress, time_limit=time_limit))


@checked
@spells_keywords("fit")
def compare(
    reference: Reference | str | Path,
    settings: FitSettings | None = None,
    *,
    out: str | Path | None = None,
    overwrite: bool = False,
    progress: CompareProgress | None = None,
    **changes: Unpack[FitKeywords],
) -> ComparisonModel:
    """Fit a reference four ways: two-stage and concurrent, with cylinders and with cones.

    Args:
        reference: what is to be approximated: as `read` gives it, or a file that is read as it is.
        settings: tolerance, limits, tilt and restarts; feature and method are those of the four columns.
        out: folder for compare.json, written whole or not at all; None to write nothing.
        overwrite: replace what cadpanel wrote there before.
        progress: told feature, method, step, largest excess over a tolerance and RMS deviation in mm.
        changes: settings to change.

    Raises:
        ReferenceFileError: a file cannot be read, or does not hold panels.
        PanelError: a panel's faces are nothing that a feature could approximate.
        SettingsError: a setting is out of its range.
        DeliveryError: the folder is refused or cannot be written.
    """
    from cadpanel.delivery.earlier import with_earlier
    from cadpanel.delivery.folder import delivery_folder
    from cadpanel.delivery.own_files import COMPARISON
    from cadpanel.delivery.records.comparison import write_comparison
    from cadpanel.delivery.records.table1 import comparison_record
    from cadpanel.studies.table1 import compare as compare_reference

    asked = _asked(settings or LIKE_THE_PAPER, changes)
    read_in = reference if isinstance(reference, Reference) else read(reference)
    how = with_earlier(asked, read_in)
    # Refused before the fits, which take their time.
    with nullcontext() if out is None else delivery_folder(Path(out), overwrite=overwrite) as folder:
        comparison = comparison_record(read_in, how, compare_reference(read_in, how, progress=progress))
        if folder is not None:
            write_comparison(comparison, folder / COMPARISON)
    return comparison


@checked
@spells_keywords("deliver")
def deliver(
    result: FitResult,
    out: str | Path,
    *,
    thickness: float = 3.0,
    joint: float = 0.0,
    ends: Ends = "bevel",
    skin_side: SkinSide = "outer",
    schema: Schema = "AP242",
    overwrite: bool = False,
    progress: DeliveryProgress | None = None,
    **shop: Unpack[ShopKeywords],
) -> ReportModel:
    """Write a delivery folder whole or not at all: STEP, flat patterns, the schedule, and report.json with the proof.

    Args:
        result: the fitted panels.
        out: the folder; an existing one is refused unless `overwrite` is set.
        thickness: of the sheet, mm.
        joint: clear width between neighbouring sheets, mm.
        ends: "bevel": walls stand in the planes of joints; "square": square to the sheet, as lasers cut them.
        skin_side: "outer": the skin is the sheet's outer face; "inner": its inner one.
        schema: of the STEP files, "AP242" or "AP214".
        overwrite: replace an existing delivery.
        progress: told the step ("compare", "build", "write", "verify"), how much of it is done, and of how much.
        shop: the fields of `ShopSettings`: which outputs of which panels, and how drawings and schedule are made.

    Returns:
        What report.json holds.

    Raises:
        SettingsError: the thickness, joint, side or schema is none, or there is no such output or panel.
        PanelError: a panel cannot be built.
        DeliveryError: the folder is refused or cannot be written.
        ProofError: what was written is not what was promised; nothing is left.
    """
    from cadpanel.delivery.deliver import deliver as deliver_result
    from cadpanel.delivery.settings import SheetSettings
    from cadpanel.delivery.shop_settings import ShopSettings

    sheet = SheetSettings(thickness=thickness, joint=joint, ends=ends, skin_side=skin_side, schema=schema)
    check_keywords("deliver", shop)
    asked = ShopSettings(**cast("dict[str, Any]", shop))
    return deliver_result(result, Path(out), sheet, asked, overwrite=overwrite, progress=progress)


@checked
def to_cadquery(
    panels: Panels,
    *,
    thickness: float = 3.0,
    joint: float = 0.0,
    skin_side: SkinSide = "outer",
    **made: Unpack[MadeKeywords],
) -> cadquery.Workplane:
    """The solids on the stack of a cadquery Workplane, ready for selectors, holes and exports; `.vals()` lists them.

    Args:
        panels: a result, one of its shapes, or several.
        thickness: of the sheet, mm.
        joint: clear width between neighbouring sheets, mm; one of the shapes alone has no neighbours.
        skin_side: "outer" or "inner".
        made: ends, fixings and returns, as `deliver` has them; sheets without holes and returns if not given.

    Raises:
        PanelError: a panel cannot be built.
        SettingsError: the thickness, joint or side is none.
    """
    from cadpanel.brep.building.adapters import to_cadquery_shape, to_workplane

    solids = [
        panel.solid
        for panel in build_sheets(panels, SheetKeywords(thickness=thickness, joint=joint, skin_side=skin_side), made)
    ]
    return to_workplane(solids[0]).newObject([to_cadquery_shape(solid) for solid in solids])


@overload
def to_build123d(
    panels: Panel,
    *,
    thickness: float = 3.0,
    joint: float = 0.0,
    skin_side: SkinSide = "outer",
    **made: Unpack[MadeKeywords],
) -> build123d.Part: ...
@overload
def to_build123d(
    panels: FitResult | Sequence[Panel],
    *,
    thickness: float = 3.0,
    joint: float = 0.0,
    skin_side: SkinSide = "outer",
    **made: Unpack[MadeKeywords],
) -> build123d.Compound: ...
@checked
def to_build123d(
    panels: Panels,
    *,
    thickness: float = 3.0,
    joint: float = 0.0,
    skin_side: SkinSide = "outer",
    **made: Unpack[MadeKeywords],
) -> build123d.Compound:
    """A build123d Compound whose children are the solids under the panels' names; of one shape, a Part.

    Args:
        panels: a result, one of its shapes, or several.
        thickness: of the sheet, mm.
        joint: clear width between neighbouring sheets, mm; one of the shapes alone has no neighbours.
        skin_side: "outer" or "inner".
        made: ends, fixings and returns, as `deliver` has them; sheets without holes and returns if not given.

    Raises:
        PanelError: a panel cannot be built.
        SettingsError: the thickness, joint or side is none.
    """
    from cadpanel.brep.building.adapters import to_build123d_compound, to_build123d_part

    built = build_sheets(panels, SheetKeywords(thickness=thickness, joint=joint, skin_side=skin_side), made)
    if isinstance(panels, FitResult | Sequence):
        return to_build123d_compound([(panel.shape.name, panel.solid) for panel in built], title_of(panels))
    return to_build123d_part(built[0].solid, panels.name)


@checked
def write_step(
    result: Panels,
    path: str | Path,
    *,
    thickness: float = 3.0,
    joint: float = 0.0,
    skin_side: SkinSide = "outer",
    skins: bool = False,
    schema: Schema = "AP242",
    panels: Sequence[str] = (),
    **made: Unpack[MadeKeywords],
) -> None:
    """Write one STEP file, one product a panel with its name; for a folder with the proof beside it, see `deliver`.

    Args:
        result: a result, one of its shapes, or several.
        path: the file; one that is there is replaced once the new one is complete.
        thickness: of the sheet, mm.
        joint: clear width between neighbouring sheets, mm; one of the shapes alone has no neighbours.
        skin_side: "outer" or "inner".
        skins: write the skins as open shells instead of the solids.
        schema: "AP242" or "AP214".
        panels: names of those that are written, * for anything; all if empty.
        made: ends, fixings and returns, as `deliver` has them; sheets without holes and returns if not given.

    Raises:
        PanelError: a panel cannot be built.
        DeliveryError: the file cannot be written.
        SettingsError: the thickness, joint, side or schema is none, or there is no panel of such a name.
    """
    from cadpanel.delivery.chosen_panels import chosen_panels
    from cadpanel.delivery.outputs.step_files import write_skins, write_solids

    names = [shape.name for shape in shapes_of(result)]
    chosen = set(chosen_panels(names, [panels] if isinstance(panels, str) else panels))
    # All of them are built: a panel's neighbours say how it is cut.
    sheet = SheetKeywords(thickness=thickness, joint=joint, skin_side=skin_side, schema=schema)
    built = build_sheets(result, sheet, made)
    own = [panel for panel in built if panel.shape.name in chosen]
    (write_skins if skins else write_solids)(Path(path), own, title_of(result), schema)
