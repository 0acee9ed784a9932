"""Loose curves of a file: those that cut a surface, or the spine along which stations are measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.Standard import Standard_Failure
from OCP.TopoDS import TopoDS, TopoDS_Edge

from cadpanel.arrays import Array
from cadpanel.brep.curves.pieces import Piece, piece_through, smooth_pieces
from cadpanel.brep.curves.polyline_joining import joined
from cadpanel.brep.curves.polyline_smoothing import FACET
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Model, ModelCurve
from cadpanel.brep.kernel.transforms import shifted
from cadpanel.brep.skin.strip_direction import runs_back
from cadpanel.errors import ReferenceFileError

# How closely one curve must begin where another one ends to follow it, as a part of the whole length.
FOLLOWS = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """A curve of a file.

    Attributes:
        number: its place there, from 1.
        name: as the file has it.
        edge: the kernel's edge.
        points: (q, 3) along it, mm.
        parts: its smooth pieces; none where it is the smooth curve through its points.
    """

    number: int
    name: str
    edge: TopoDS_Edge
    points: Array
    parts: tuple[Piece, ...] = ()

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Its smooth pieces, each of which begins where the one before it ends."""
        return self.parts or (piece_through(self.points),)

    @property
    def beside(self) -> float:
        """How far its pieces run beside a polyline that stands for them, at most, mm."""
        return max((piece.beside for piece in self.parts), default=0.0)

    @property
    def called(self) -> str:
        """How a message speaks of it."""
        return f"curve {self.number}" + (f" ('{self.name}')" if self.name else "")


@dataclass(frozen=True, slots=True, kw_only=True)
class CurveFile:
    """The loose curves by which a reference is cut, the name of their file, and what should be known of its reading."""

    source: str
    curves: tuple[Curve, ...]
    notes: tuple[str, ...] = ()


def curves_beside(path: Path, reference: Model, millimetres: float | None) -> CurveFile:
    """The loose curves of a file beside a reference, in the reference's coordinates.

    Args:
        path: a file of any format.
        reference: beside which they lie.
        millimetres: how many the unit has that the user gives, for files without one of their own.

    Raises:
        ReferenceFileError: the file cannot be read, or holds no loose curves.
    """
    model = load_model(path, millimetres, near_origin=False, beside_unitless=not reference.own_unit)
    return replace(_curves(model, -np.array(reference.origin)), notes=model.notes)


def own_curves(reference: Model) -> CurveFile:
    """The loose curves of a reference itself; what is known of it need not be said again.

    Raises:
        ReferenceFileError: it holds none.
    """
    return _curves(reference, np.zeros(3))


def _curves(model: Model, shift: Array) -> CurveFile:
    loose = model.curves()
    if not loose:
        raise ReferenceFileError(
            f"'{model.source}' holds no loose curves, only faces: export the lines between the panels as curves."
        )
    curves = sampled(loose, model.source, shift)
    if not curves:
        raise ReferenceFileError(f"'{model.source}' holds only curves without length: draw them again.")
    return CurveFile(source=model.source, curves=curves)


def sampled(loose: Sequence[ModelCurve], source: str, shift: Array) -> tuple[Curve, ...]:
    """Curves with points along them, moved by (3,) `shift`; those without length are left out.

    Straight edges that go on from each other with facets only are one curve, called by the first of them.

    Raises:
        ReferenceFileError: the kernel cannot evaluate one of them.
    """
    curves = []
    for number, curve in joined(loose, FACET):
        if BRep_Tool.Degenerated_s(curve.edge):
            continue
        edge = TopoDS.Edge_s(shifted(curve.edge, tuple(shift.tolist()))) if shift.any() else curve.edge
        try:
            pieces = smooth_pieces(edge)
        except Standard_Failure as error:
            raise ReferenceFileError(
                f"Curve {number} of '{source}' cannot be evaluated by the CAD kernel ({error}): redraw it."
            ) from error
        points = np.concatenate([pieces[0].points, *(piece.points[1:] for piece in pieces[1:])])
        if not np.isfinite(points).all():
            raise ReferenceFileError(f"Curve {number} of '{source}' has points that are not numbers: redraw it.")
        if np.ptp(points, axis=0).max() > 0.0:
            curves.append(Curve(number=number, name=curve.label.name, edge=edge, points=points, parts=pieces))
    return tuple(curves)


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
    return line[::-1] if runs_back(line[-1] - line[0]) else line


def _joined(line: Array, other: Array, near: float) -> Array | None:
    for first in (line, line[::-1]):
        for second in (other, other[::-1]):
            if np.linalg.norm(first[-1] - second[0]) <= near:
                return np.concatenate([first, second[1:]])
    return None
