"""From the skin's surfaces to panels, whichever way is asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from cadpanel.brep.curves.drawn_curve import Curve, CurveFile, curves_beside, own_curves, sampled
from cadpanel.brep.curves.projection import land_curves
from cadpanel.brep.cutting.by_grid import cut_grid
from cadpanel.brep.cutting.by_length import Lengths, cut_lengths, cut_lip
from cadpanel.brep.cutting.by_mesh import LAY_OVER, Mesh, load_mesh, require_all_panels, require_near
from cadpanel.brep.cutting.by_network import WORTH_A_NOTE, cut_network
from cadpanel.brep.cutting.by_stations import cut_stations, spine_of
from cadpanel.brep.cutting.cut_panel import CutPanel
from cadpanel.brep.cutting.grid_counts import counts_within
from cadpanel.brep.cutting.open_closed_faces import opened
from cadpanel.brep.files.model import Model
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.splitting.splitter import UncutError
from cadpanel.errors import CadpanelError, ReferenceFileError, SettingsError
from cadpanel.reference.settings import ReferenceSettings

DRAW_ON = "draw it on the surface, on to the next curve or to the outline, or take it out"
"""What to do about a curve that does not cut."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cut:
    """The panels of a reference, and what should be known of how they were cut."""

    panels: tuple[CutPanel, ...]
    notes: tuple[str, ...] = ()


Drawn = CurveFile | Mesh
"""What a surface is cut by, or its stations are measured along, as drawn in the reference or in a file beside it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Skin:
    """What is cut: surfaces of a model, how, and by what is drawn for it."""

    model: Model
    surfaces: Sequence[Surface]
    settings: ReferenceSettings
    drawn: Drawn | None


def load_drawn(model: Model, settings: ReferenceSettings, file: Path) -> Drawn | None:
    """What the surface is to be cut by; None where the settings ask for nothing that is drawn.

    Args:
        model: the reference.
        settings: with a way to cut.
        file: where the model came from; if it is the file with the curves, too, it is not read again.

    Raises:
        ReferenceFileError: there is nothing of the kind, or its file cannot be read.
    """
    beside, millimetres = settings.beside(file), settings.millimetres
    if settings.mesh is not None:
        return load_mesh(settings.mesh, np.array(model.origin), millimetres, settings.seam_tolerance)
    if beside is not None:
        return curves_beside(beside, model, millimetres)
    if settings.spine is not None:
        return own_curves(model)
    if settings.network is not None:
        curves = sampled(model.curves(), model.source, np.zeros(3))
        if not curves:
            raise ReferenceFileError(
                f"'{model.source}' holds no loose curves that could cut its surface: draw them in."
            )
        return CurveFile(source=model.source, curves=curves)
    return None


def cut_surfaces(
    model: Model, surfaces: Sequence[Surface], settings: ReferenceSettings, drawn: Drawn | None = None
) -> Cut:
    """Cut every surface the way that the settings ask for.

    Args:
        model: the file's content.
        surfaces: the skin, in faces that hang together.
        settings: with one way to cut.
        drawn: what it is cut by, as `load_drawn` gives it.

    Raises:
        ReferenceFileError: a surface cannot be cut that way.
        SettingsError: no way is asked for, or a setting does not fit the surface.
    """
    if settings.way is None:
        raise SettingsError(f"no way to cut '{model.source}' was asked for")
    return WAYS[settings.way](_Skin(model=model, surfaces=surfaces, settings=settings, drawn=drawn))


def _lengths(skin: _Skin) -> Cut:
    how, source = skin.settings, skin.model.source
    if isinstance(how.divide, str):
        raise SettingsError(f"how many panels '{source}' needs is found by fits: ask 'cadpanel fit' or fewest_panels()")
    wanted = Lengths(
        count=how.divide, longest=how.panel_length, seams=how.seams, most_turn=float(np.radians(how.cut_turn))
    )
    panels: list[CutPanel] = []
    notes: list[str] = []
    for surface in skin.surfaces:
        cut = partial(_cut_strip, surface, lip=how.lip, source=source, tolerance=how.seam_tolerance)
        try:
            of_strip, found = cut(wanted)
        except UncutError as error:
            # Of panels whose length is asked for nobody wants another number.
            others = () if wanted.count is None else (wanted.count + 1, wanted.count - 1, wanted.count + 2)
            asked = (replace(wanted, count=number) for number in others if number > 0)
            other = next((one.count for one in asked if _works(cut, one)), None)
            if other is None:
                raise
            raise ReferenceFileError(f"{str(error).rstrip('.')}; into {other} panels it can be cut.") from error
        panels += of_strip
        notes += found
    return Cut(panels=tuple(panels), notes=tuple(notes))


def _cut_strip(
    surface: Surface, wanted: Lengths, *, lip: float | None, source: str, tolerance: float
) -> tuple[tuple[CutPanel, ...], tuple[str, ...]]:
    if lip is None:
        return cut_lengths(surface, wanted, source, tolerance), ()
    return cut_lip(surface, wanted, lip, source, tolerance)


def _works(cut: Callable[[Lengths], object], wanted: Lengths) -> bool:
    """Whether such panels can be cut."""
    try:
        cut(wanted)
    except CadpanelError:
        return False
    return True


def _grid(skin: _Skin) -> Cut:
    how, by = skin.settings, skin.settings.by or "length"
    source, tolerance = skin.model.source, skin.settings.seam_tolerance
    panels: list[CutPanel] = []
    for surface in skin.surfaces:
        counts = [how.grid or (1, 1)] * len(surface.faces)
        if how.panel_size is not None:
            counts = counts_within(surface, how.panel_size, by, source)
        panels += cut_grid(surface, counts, by, source, tolerance)
    return Cut(panels=tuple(panels))


def _stations(skin: _Skin) -> Cut:
    how = skin.settings
    spine = spine_of(skin.drawn) if isinstance(skin.drawn, CurveFile) else None
    stations, tolerance = how.stations or (), how.seam_tolerance
    cut = [cut_stations(surface, stations, spine, skin.model.source, tolerance) for surface in skin.surfaces]
    notes = () if skin.drawn is None else skin.drawn.notes
    return Cut(panels=tuple(panel for panels in cut for panel in panels), notes=notes)


def _network(skin: _Skin) -> Cut:
    assert isinstance(skin.drawn, CurveFile)
    return _cut_by_curves(skin, skin.drawn.curves, skin.drawn.source, DRAW_ON, skin.drawn.notes)


def _mesh(skin: _Skin) -> Cut:
    mesh = skin.drawn
    assert isinstance(mesh, Mesh)
    require_near(mesh, skin.surfaces, mesh.source, skin.model.source)
    cut = _cut_by_curves(skin, mesh.curves(), mesh.source, LAY_OVER, mesh.notes)
    require_all_panels(mesh, cut.panels, mesh.source, skin.model.source)
    return cut


def _cut_by_curves(
    skin: _Skin, curves: Sequence[Curve], curve_source: str, remedy: str, notes: tuple[str, ...] = ()
) -> Cut:
    """Cut every surface by the curves that lie over it, and refuse one that lies over none with the remedy given."""
    tolerance = skin.settings.seam_tolerance
    source = skin.model.source
    surfaces = [opened(surface, source) for surface in skin.surfaces]
    landings = land_curves(surfaces, curves, tolerance, curve_source)
    stray = [curve for index, curve in enumerate(curves) if not any(landing.edges[index] for landing in landings)]
    if stray:
        called = stray[0].called
        raise ReferenceFileError(
            f"{called[:1].upper()}{called[1:]} of '{curve_source}' lies over no surface of '{source}': {remedy}."
        )
    panels: list[CutPanel] = []
    for whole, surface, landing in zip(skin.surfaces, surfaces, landings, strict=True):
        what = f"the surface of {whole.numbers} of '{source}'"
        panels += cut_network(surface, curves, landing, what, curve_source, remedy, tolerance)
    farthest, offset = max(enumerate(landing.offset for landing in landings), key=lambda landed: landed[1])
    fine = [curve for curve in curves if curve.beside > WORTH_A_NOTE]
    if fine:
        which = f"{fine[0].called} of '{curve_source}'" if len(fine) == 1 else f"{len(fine)} curves of '{curve_source}'"
        beside = max(curve.beside for curve in fine)
        found = f"The segments of {which} stand for a smooth curve, which passes up to {beside:.2g} mm beside them."
        notes = (*notes, found)
    if offset > WORTH_A_NOTE:
        off = "the surface" if len(landings) == 1 else f"the surface of {skin.surfaces[farthest].numbers}"
        found = f"The curves of '{curve_source}' lie up to {offset:.3g} mm off {off} and were projected onto it."
        notes = (*notes, found)
    return Cut(panels=tuple(panels), notes=notes)


WAYS: dict[str, Callable[[_Skin], Cut]] = {
    "divide": _lengths,
    "panel_length": _lengths,
    "grid": _grid,
    "panel_size": _grid,
    "stations": _stations,
    "network": _network,
    "mesh": _mesh,
}
"""The ways to cut, by the settings that ask for them."""
