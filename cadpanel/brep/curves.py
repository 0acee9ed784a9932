"""Loose curves of a file: those that cut a surface, or the spine along which stations are measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import GeomAbs_BSplineCurve, GeomAbs_C1
from OCP.Standard import Standard_Failure
from OCP.TColStd import TColStd_Array1OfReal
from OCP.TopoDS import TopoDS, TopoDS_Edge

from cadpanel.brep.formats.units import shifted
from cadpanel.brep.loading import load_model
from cadpanel.brep.model import Model, ModelCurve
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.polyline import unit

Array = NDArray[np.float64]

POINTS = 257
# Points for every span of a spline that waves more often than that many can follow, and at most.
POINTS_A_SPAN = 16
MOST_POINTS = 4097
# A curve has a kink where its direction changes by more than this, degrees, seen from this part of it before and after;
# polylines that stand for round curves turn by less at each of their points.
LEAST_KINK = 5.0
BESIDE = 1e-6
# How closely one curve must begin where another one ends to follow it, as a part of the whole length.
FOLLOWS = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """A curve of a file: its place there (from 1), its edge, and (q, 3) points along it, mm."""

    number: int
    name: str
    edge: TopoDS_Edge
    points: Array

    @property
    def called(self) -> str:
        """How a message speaks of it."""
        return f"curve {self.number}" + (f" ('{self.name}')" if self.name else "")


@dataclass(frozen=True, slots=True, kw_only=True)
class CurveFile:
    """The loose curves of a file beside a reference, its name, and what should be known of how it was read."""

    source: str
    curves: tuple[Curve, ...]
    notes: tuple[str, ...]


def load_curves(path: Path, reference: Model, millimetres: float | None) -> CurveFile:
    """The loose curves of a file, in the coordinates of a reference.

    Args:
        path: a file of any format.
        reference: beside which they lie.
        millimetres: how many the unit has that the user gives, for files without one of their own.

    Raises:
        ReferenceFileError: the file cannot be read, or holds no loose curves.
    """
    model = load_model(path, millimetres, near_origin=False, beside_unitless=not reference.own_unit)
    loose = model.curves()
    if not loose:
        raise ReferenceFileError(
            f"'{path.name}' holds no loose curves, only faces: export the lines between the panels as curves."
        )
    curves = sampled(loose, path.name, -np.array(reference.origin))
    if not curves:
        raise ReferenceFileError(f"'{path.name}' holds only curves without length: draw them again.")
    return CurveFile(source=model.source, curves=curves, notes=model.notes)


def sampled(loose: Sequence[ModelCurve], source: str, shift: Array) -> tuple[Curve, ...]:
    """Curves with points along them, moved by (3,) `shift`; those without length are left out.

    Raises:
        ReferenceFileError: the kernel cannot evaluate one of them.
    """
    curves = []
    for number, curve in enumerate(loose, start=1):
        if BRep_Tool.Degenerated_s(curve.edge):
            continue
        edge = TopoDS.Edge_s(shifted(curve.edge, tuple(shift.tolist()))) if shift.any() else curve.edge
        try:
            adaptor = BRepAdaptor_Curve(edge)
            places = np.linspace(adaptor.FirstParameter(), adaptor.LastParameter(), POINTS)
            points = np.array([adaptor.Value(place).Coord() for place in places.tolist()])
        except Standard_Failure as error:
            raise ReferenceFileError(
                f"Curve {number} of '{source}' cannot be evaluated by the CAD kernel ({error}): redraw it."
            ) from error
        if not np.isfinite(points).all():
            raise ReferenceFileError(f"Curve {number} of '{source}' has points that are not numbers: redraw it.")
        if np.ptp(points, axis=0).max() > 0.0:
            curves.append(Curve(number=number, name=curve.label.name, edge=edge, points=points))
    return tuple(curves)


def smooth_pieces(curves: Sequence[Curve]) -> tuple[Curve, ...]:
    """The same curves, each cut at its kinks, with points as dense as its knots: a cut must turn where they turn."""
    pieces = []
    for curve in curves:
        adaptor = BRepAdaptor_Curve(curve.edge)
        knots = adaptor.NbKnots() if adaptor.GetType() == GeomAbs_BSplineCurve else 2
        kinks = _kinks(adaptor)
        if not kinks and knots * POINTS_A_SPAN <= POINTS:
            pieces.append(curve)
            continue
        count = int(np.clip(knots * POINTS_A_SPAN, POINTS, MOST_POINTS))
        for low, high in pairwise((adaptor.FirstParameter(), *kinks, adaptor.LastParameter())):
            points = np.array([adaptor.Value(place).Coord() for place in np.linspace(low, high, count).tolist()])
            pieces.append(replace(curve, points=points))
    return tuple(pieces)


def _kinks(adaptor: BRepAdaptor_Curve) -> list[float]:
    """Parameters inside a curve at which its direction jumps."""
    count = adaptor.NbIntervals(GeomAbs_C1)
    if count < 2:
        return []
    found = TColStd_Array1OfReal(1, count + 1)
    adaptor.Intervals(found, GeomAbs_C1)
    beside = BESIDE * (adaptor.LastParameter() - adaptor.FirstParameter())
    kinks = []
    for place in (found.Value(index) for index in range(2, count + 1)):
        ways = []
        for side in (-1.0, 1.0):
            start, end = (np.array(adaptor.Value(place + side * step * beside).Coord()) for step in (1.0, 2.0))
            ways.append(unit(side * (end - start)))
        if ways[0] @ ways[1] < np.cos(np.radians(LEAST_KINK)):
            kinks.append(place)
    return kinks


def chain(polylines: Sequence[Array]) -> Array | None:
    """Join polylines that follow each other to one, begun at the end that comes first along its main axis.

    Returns:
        (q, 3) points, or None where they do not follow each other.
    """
    left = list(polylines)
    if not left:
        return None
    near = FOLLOWS * sum(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) for line in left)
    line = left.pop(0)
    while left:
        for index, other in enumerate(left):
            joined = _joined(line, other, near)
            if joined is not None:
                line = joined
                left.pop(index)
                break
        else:
            return None
    way = line[-1] - line[0]
    return line[::-1] if way[np.abs(way).argmax()] < 0.0 else line


def _joined(line: Array, other: Array, near: float) -> Array | None:
    for first in (line, line[::-1]):
        for second in (other, other[::-1]):
            if np.linalg.norm(first[-1] - second[0]) <= near:
                return np.concatenate([first, second[1:]])
    return None
