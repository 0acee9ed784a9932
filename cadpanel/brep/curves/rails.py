"""The loose curves of a file as exact B-splines: rails of a loft, chosen by number, name or layer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.Geom import Geom_TrimmedCurve
from OCP.GeomConvert import GeomConvert
from OCP.TopoDS import TopoDS_Edge
from scipy.interpolate import BSpline

from cadpanel.brep.curves.drawn_curve import own_curves
from cadpanel.brep.curves.pieces import Piece
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Model
from cadpanel.brep.isolation.client import work_guarded
from cadpanel.errors import LoftError
from cadpanel.lofting.rail import Rail, Stretch, chained, stretch_of
from cadpanel.near import near_names
from cadpanel.reference.settings import ReferenceSettings, file_named

_LAYER = "layer="


@dataclass(frozen=True, slots=True, kw_only=True)
class FileCurve:
    """A loose curve of a file.

    Attributes:
        number: its place there, from 1.
        name, layer: as the file has them, or empty.
        stretches: its parts between corners.
    """

    number: int
    name: str
    layer: str
    stretches: tuple[Stretch, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class FileCurves:
    """The loose curves of a file.

    Attributes:
        source: its name.
        curves: all of them.
        notes: what should be known of its reading.
        origin: what was taken off all coordinates, mm.
    """

    source: str
    curves: tuple[FileCurve, ...]
    notes: tuple[str, ...]
    origin: tuple[float, float, float]


def read_curves(path: str | Path, settings: ReferenceSettings | None = None) -> FileCurves:
    """Read the loose curves of a STEP, IGES, .brep or .3dm file.

    Raises:
        ReferenceFileError: the file cannot be read, or holds no loose curves.
    """
    path, how = file_named(path, "reference"), settings or ReferenceSettings()
    return cast(FileCurves, work_guarded("rails", path, how))


def curves_of(model: Model) -> FileCurves:
    """The same of a model that is read already; for the guarded interpreter.

    Raises:
        ReferenceFileError: it holds none.
    """
    drawn, loose = own_curves(model), model.curves()
    return FileCurves(
        source=model.source,
        curves=tuple(
            FileCurve(
                number=curve.number,
                name=curve.name,
                layer=loose[curve.number - 1].label.layer,
                stretches=tuple(_stretch(curve.edge, piece) for piece in curve.pieces),
            )
            for curve in drawn.curves
        ),
        notes=model.notes,
        origin=model.origin,
    )


def load_curves(path: Path, how: ReferenceSettings) -> FileCurves:
    """Read a file's loose curves in this interpreter.

    Raises:
        ReferenceFileError: the file cannot be read, or holds no loose curves.
    """
    return curves_of(load_model(path, how.millimetres))


def _stretch(edge: TopoDS_Edge, piece: Piece) -> Stretch:
    """A smooth piece: the spline that stands for a fine polyline, or the kernel's own curve, exactly."""
    if isinstance(piece.at, BSpline):
        return stretch_of(piece.at)
    first, last = piece.parameters[[0, -1]].tolist()
    curve = GeomConvert.CurveToBSplineCurve_s(Geom_TrimmedCurve(BRep_Tool.Curve_s(edge, 0.0, 0.0), first, last))
    if curve.IsPeriodic():
        curve.SetNotPeriodic()
    poles = [(*curve.Pole(index).Coord(), 1.0) for index in range(1, curve.NbPoles() + 1)]
    weights = np.array([curve.Weight(index) for index in range(1, curve.NbPoles() + 1)])
    knots = [curve.Knot(index) for index in range(1, curve.NbKnots() + 1)]
    counts = [curve.Multiplicity(index) for index in range(1, curve.NbKnots() + 1)]
    return Stretch(int(curve.Degree()), np.repeat(knots, counts), np.array(poles) * weights[:, None])


def chosen_rails(found: FileCurves, names: Sequence[str]) -> tuple[Rail, Rail]:
    """Two rails of a file.

    Args:
        found: its curves.
        names: of each a number, a name, or "layer=NAME"; none where the file holds two curves.

    Raises:
        LoftError: there is no such curve, or not two of them.
    """
    if len(found.curves) < 2:
        raise LoftError(
            f"'{found.source}' holds one curve, and a loft has two rails: export the other one into the same file, too"
        )
    if not names:
        if len(found.curves) != 2:
            raise LoftError(
                f"'{found.source}' holds {len(found.curves)} curves: say which two are the rails, by number, name or "
                "layer=NAME"
            )
        names = [str(curve.number) for curve in found.curves]
    if len(names) != 2:
        raise LoftError(f"a loft has two rails: name two curves, not {len(names)}")
    one, other = (_chosen(found, name) for name in names)
    common = {curve.number for curve in one} & {curve.number for curve in other}
    if common:
        raise LoftError(
            f"curve {min(common)} of '{found.source}' cannot be both rails: name two, by number if their names are the "
            "same"
        )
    return _rail(names[0], one), _rail(names[1], other)


def _chosen(found: FileCurves, name: str) -> list[FileCurve]:
    if name.startswith(_LAYER):
        layer = name.removeprefix(_LAYER)
        chosen = [curve for curve in found.curves if curve.layer == layer]
        known = [f"{_LAYER}{curve.layer}" for curve in found.curves if curve.layer]
    else:
        chosen = [curve for curve in found.curves if curve.name == name]
        chosen = chosen or [curve for curve in found.curves if str(curve.number) == name]
        known = [curve.name or str(curve.number) for curve in found.curves]
    if not chosen:
        raise LoftError(f"'{found.source}' holds no curve '{name}': {near_names(name, dict.fromkeys(known))}")
    return chosen


def _rail(name: str, curves: Sequence[FileCurve]) -> Rail:
    called = f"curve {name}" if name.isdigit() else name
    return chained(called, [stretch for curve in curves for stretch in curve.stretches])
