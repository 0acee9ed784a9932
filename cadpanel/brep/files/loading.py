"""From a file in any format to a model: recognised, checked, read, and moved near the origin.

The kernel may crash over a damaged file: all of this is for the guarded interpreter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepTools import BRepTools_ReShape
from OCP.Standard import Standard_Failure
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files.catalogue import checked_format_of
from cadpanel.brep.files.format import Format
from cadpanel.brep.files.model import Model, NamedShape, Part, Products
from cadpanel.brep.files.step import STEP, read_products
from cadpanel.brep.files.units import refuse_given
from cadpanel.brep.kernel.placement import placed
from cadpanel.brep.kernel.shapes import children, compound_of, faces_of
from cadpanel.brep.kernel.transforms import shifted
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings

FAR = 1e7
"""Distance from the origin, mm, from which a model is moved: the kernel's checks fail at map-grid coordinates."""
MOST_NAMED = 8
WHOLE_METRE = 1000.0
LARGEST_COORDINATE = 1e12
"""Beyond it, a double keeps less than 0.1 mm."""


def load_reference(path: Path, how: ReferenceSettings) -> Model | Products:
    """Read a reference the way that its settings ask for.

    Returns:
        The products of a STEP file whose products are the panels, else a model.

    Raises:
        ReferenceFileError: as `load_model` says.
    """
    form = checked_format_of(path)
    if form is STEP and how.way is None and how.faces is None:
        return _load_products(path, how.millimetres)
    return _load(form, path, how.millimetres, beside_unitless=how.beside(path) is not None)


def load_model(
    path: Path, millimetres: float | None = None, *, near_origin: bool = True, beside_unitless: bool = False
) -> Model:
    """Read a file of any format.

    Args:
        path: the file.
        millimetres: how many the unit has that the user gives, for a file without one of its own.
        near_origin: move it near the origin where it lies far away.
        beside_unitless: the user may give the unit for another file; then this one may have its own.

    Raises:
        ReferenceFileError: there is no such file, it is damaged, it holds no shapes, or it has a unit of its own where
            one is given.
    """
    form = checked_format_of(path)
    return _load(form, path, millimetres, near_origin=near_origin, beside_unitless=beside_unitless)


def _load(
    form: Format,
    path: Path,
    millimetres: float | None,
    *,
    near_origin: bool = True,
    beside_unitless: bool = False,
) -> Model:
    model = form.read(path, millimetres)
    shapes = placed_together([part.shape for part in model.parts], path.name)
    model = replace(
        model, parts=tuple(replace(part, shape=shape) for part, shape in zip(model.parts, shapes, strict=True))
    )
    if form is not STEP:
        model = replace(model, parts=tuple(map(_tried_out, model.parts)))
    model = model.with_notes(_left_out(model))
    if millimetres is not None and model.own_unit and not beside_unitless:
        raise refuse_given(path.name, model.unit)
    if not model.parts:
        raise ReferenceFileError(
            f"'{path.name}' holds neither faces nor curves: export the faces of the skin and try again."
        )
    return _near_origin(model) if near_origin else model


def placed_together(shapes: Sequence[TopoDS_Shape], source: str) -> list[TopoDS_Shape]:
    """The shapes of a file without locations, all at once: what they share stays shared."""
    try:
        return list(children(placed(compound_of(shapes))))
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{source}' puts a shape where the CAD kernel cannot put it ({error}): place it without a mirror or a "
            "scale and export again."
        ) from error


def _tried_out(part: Part) -> Part:
    """A part without the faces that the kernel cannot evaluate.

    The STEP reader checks what it builds; the other readers take shapes over as they are.
    """
    faces = faces_of(part.shape)
    faults = {place: fault for place, face in enumerate(faces) if (fault := _fault(face)) is not None}
    if not faults:
        return part
    reshaping = BRepTools_ReShape()
    for place in faults:
        reshaping.Remove(faces[place])
    left = reshaping.Apply(part.shape)
    # Of what is left the places are counted among all faces again, those that were unreadable before between them.
    places = [place for place in range(len(faces) + len(part.unreadable)) if place not in part.unreadable]
    return replace(
        part,
        shape=compound_of([]) if left is None or left.IsNull() else left,
        face_labels=tuple(label for place, label in enumerate(part.face_labels) if place not in faults),
        unreadable={**part.unreadable, **{places[place]: fault for place, fault in faults.items()}},
    )


def _fault(face: TopoDS_Face) -> str | None:
    """Why a face cannot be evaluated; None where it can."""
    try:
        sample_faces(face)
    except (Standard_Failure, ValueError, FloatingPointError) as error:
        return f"the CAD kernel cannot evaluate it ({error})"
    return None


def _left_out(model: Model) -> list[str]:
    """What to say of faces that cannot be read."""
    lost = model.unreadable()
    if not lost:
        return []
    first, source = lost[0], model.source
    if len(lost) == 1:
        return [f"Face {first.number} of '{source}' cannot be read and is left out: {first.why}."]
    numbers = ", ".join(str(face.number) for face in lost[:MOST_NAMED])
    more = f" and {len(lost) - MOST_NAMED} more" if len(lost) > MOST_NAMED else ""
    return [
        f"{len(lost)} faces of '{source}' cannot be read and are left out, numbers {numbers}{more}; of face "
        f"{first.number}, {first.why}."
    ]


def _load_products(path: Path, millimetres: float | None) -> Products:
    found = read_products(path, millimetres)
    placed_shapes = placed_together([product.shape for product in found.shapes], path.name)
    named = zip(found.shapes, placed_shapes, strict=True)
    found = replace(found, shapes=tuple(replace(product, shape=shape) for product, shape in named))
    if found.unit is not None and millimetres is not None:
        raise refuse_given(path.name, found.unit)
    origin = far_origin([product.shape for product in found.shapes], path.name)
    if origin is None:
        return found
    notes = (*found.notes, origin_note(path.name, origin))
    return replace(found, shapes=moved_back(found.shapes, origin), notes=notes, origin=origin)


def moved_back(shapes: Sequence[NamedShape], origin: tuple[float, float, float]) -> tuple[NamedShape, ...]:
    """Shapes whose origin is to lie at a point."""
    back = (-origin[0], -origin[1], -origin[2])
    return tuple(replace(product, shape=shifted(product.shape, back)) for product in shapes)


def _near_origin(model: Model) -> Model:
    """Move a model that lies far from the origin, by whole metres, and note it."""
    origin = far_origin([part.shape for part in model.parts], model.source)
    if origin is None:
        return model
    back = (-origin[0], -origin[1], -origin[2])
    parts = tuple(replace(part, shape=shifted(part.shape, back)) for part in model.parts)
    return replace(model, parts=parts, origin=origin).with_notes([origin_note(model.source, origin)])


def far_origin(shapes: Sequence[TopoDS_Shape], source: str) -> tuple[float, float, float] | None:
    """The point, in whole metres, that should become the origin of shapes far from it; None where it may stay.

    Raises:
        ReferenceFileError: they lie where no double can hold a millimetre.
    """
    return origin_within([extent_of(shapes, source)], source)


class Extent(NamedTuple):
    """A box around shapes: its lower and its upper corner, mm, and by how much it is wider on every side."""

    bounds: tuple[float, ...]
    gap: float


def extent_of(shapes: Sequence[TopoDS_Shape], source: str) -> Extent | None:
    """The box around shapes; None around nothing.

    Raises:
        ReferenceFileError: the kernel cannot measure one of them.
    """
    box = Bnd_Box()
    try:
        BRepBndLib.Add_s(compound_of(shapes), box, False)
    except Standard_Failure as error:
        raise ReferenceFileError(
            f"'{source}' holds a shape that the CAD kernel cannot measure ({error}): repair it and export it again."
        ) from error
    if box.IsVoid():
        return None
    gap = float(box.GetGap())
    box.SetGap(0.0)
    return Extent(box.Get(), gap)


def origin_within(extents: Sequence[Extent | None], source: str) -> tuple[float, float, float] | None:
    """The origin that shapes in some boxes should have; None where it may stay where it is.

    Raises:
        ReferenceFileError: they lie where no double can hold a millimetre.
    """
    known = [extent for extent in extents if extent is not None]
    if not known:
        return None
    corners, gap = np.array([extent.bounds for extent in known]), max(extent.gap for extent in known)
    low, high = corners[:, :3].min(axis=0) - gap, corners[:, 3:].max(axis=0) + gap
    reach = float(np.abs([low, high]).max())
    if not np.isfinite(reach) or reach > LARGEST_COORDINATE:
        raise ReferenceFileError(
            f"'{source}' reaches {reach:.3g} mm from the origin, farther than millimetres can be told "
            "apart: look for a stray shape or a wrong unit."
        )
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    if np.linalg.norm(middle) < FAR and not np.linalg.norm(half) <= FAR < np.linalg.norm(np.abs(middle) + half):
        return None
    x, y, z = (np.round(middle / WHOLE_METRE) * WHOLE_METRE + 0.0).tolist()  # a note that says -0 makes one wonder
    return (x, y, z)


def origin_note(source: str, origin: tuple[float, float, float]) -> str:
    """What the report says of a model that was moved."""
    x, y, z = origin
    return (
        f"'{source}' lies {np.linalg.norm(origin) / 1e6:.4g} km from its origin; all coordinates here are less by "
        f"({x:.0f}, {y:.0f}, {z:.0f}) mm."
    )
