"""What a file holds, as measured: faces, curves, surfaces that hang together, and lips. Nothing is guessed."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np
from OCP.GeomAbs import (
    GeomAbs_BezierSurface,
    GeomAbs_BSplineSurface,
    GeomAbs_Cone,
    GeomAbs_Cylinder,
    GeomAbs_OffsetSurface,
    GeomAbs_Plane,
    GeomAbs_Sphere,
    GeomAbs_SurfaceOfExtrusion,
    GeomAbs_SurfaceOfRevolution,
    GeomAbs_Torus,
)

from cadpanel.brep.curves.drawn_curve import sampled
from cadpanel.brep.faces.face_patch import Patch, lengths_along
from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.model import Label, Model
from cadpanel.brep.isolation.client import work_guarded
from cadpanel.brep.skin.adjacency import Surface, surfaces_of
from cadpanel.brep.skin.conjugate import SeamLean, seam_bending, seam_lean
from cadpanel.brep.skin.cross_sections import sections_of
from cadpanel.brep.skin.curvature import Curvature, curvature_of
from cadpanel.brep.skin.face_cleanup import SkinFace, skin_faces
from cadpanel.brep.skin.lips import SECTIONS, Lip, lips_of
from cadpanel.brep.skin.strip import find_strip
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.vectors import norm
from cadpanel.reference.settings import ReferenceSettings, file_named

# Faces that fold by more than this where they meet are different surfaces here, degrees: a lip is round.
SMOOTH = 30.0
MIDDLE = np.array([0.5])
# The kernel's kinds of surface by the words for them.
KINDS = {
    GeomAbs_Plane: "plane",
    GeomAbs_Cylinder: "cylinder",
    GeomAbs_Cone: "cone",
    GeomAbs_Sphere: "sphere",
    GeomAbs_Torus: "torus",
    GeomAbs_BezierSurface: "Bezier",
    GeomAbs_BSplineSurface: "B-spline",
    GeomAbs_SurfaceOfRevolution: "revolution",
    GeomAbs_SurfaceOfExtrusion: "extrusion",
    GeomAbs_OffsetSurface: "offset",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class FaceSurvey:
    """One face.

    Attributes:
        number: its place in the file, from 1, by which it may be chosen.
        label: name, layer and colour; its part's where it has none of its own.
        panel: what its part is called as a ready-made panel; empty where it bounds a solid, which is none.
        of_solid: whether it bounds a solid.
        kind: what the file stores it as.
        poles: control points along u and v; zeros where it has none.
        area: mm^2.
        size: (2,) lengths along u and v through the middle of its parameter range, mm.
        trimmed: whether it covers only a part of that range.
        curvature: flat, developable or doubly curved, with the numbers behind it.
    """

    number: int
    label: Label
    panel: str
    of_solid: bool
    kind: str
    poles: tuple[int, int]
    area: float
    size: tuple[float, float]
    trimmed: bool
    curvature: Curvature


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceSurvey:
    """Faces that hang together.

    Attributes:
        name: under which its panels would go.
        faces: their numbers.
        area: mm^2.
        lips: where normals turn fast across it; None where that could not be measured, as it is no strip.
        strip: (length, width) along and across the lips, mm; None with them.
        seams: how far square seams are from where flat panels could meet without a step; None where it is no strip.
    """

    name: str
    faces: tuple[int, ...]
    area: float
    lips: tuple[Lip, ...] | None
    strip: tuple[float, float] | None
    seams: SeamLean | None


@dataclass(frozen=True, slots=True, kw_only=True)
class CurveSurvey:
    """One loose curve: its place among the curves, label and length in mm."""

    number: int
    label: Label
    length: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Survey:
    """What a file holds.

    Attributes:
        source: its name.
        format: "STEP", "IGES", "BREP" or "Rhino".
        unit: of its lengths, in its own words; everything here is in mm.
        faces: one a face; those without area are left out, with a note.
        surfaces: faces grouped by where they meet without a crease of more than SMOOTH.
        curves: its loose curves.
        notes: what was mended or moved, one sentence each.
    """

    source: str
    format: str
    unit: str
    faces: tuple[FaceSurvey, ...]
    surfaces: tuple[SurfaceSurvey, ...]
    curves: tuple[CurveSurvey, ...]
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        return (
            f"<Survey of '{self.source}': {len(self.faces)} faces, {len(self.surfaces)} surfaces, "
            f"{len(self.curves)} loose curves, {len(self.notes)} notes>"
        )


def survey(path: str | Path, settings: ReferenceSettings | None = None) -> Survey:
    """Measure what a file holds.

    Args:
        path: a STEP, IGES, .brep or .3dm file.
        settings: its unit, where it has none, the faces to look at, and the tolerance within which faces touch.

    Raises:
        ReferenceFileError: the file cannot be read, or holds neither faces nor curves.
        SettingsError: the path is no name of a file.
    """
    path, how = file_named(path, "reference"), settings or ReferenceSettings()
    return cast(Survey, work_guarded("survey", path, how))


def measured(model: Model, how: ReferenceSettings) -> Survey:
    """The same of a model in this interpreter, which the kernel may crash over a damaged file."""
    skin, mended = _skin(model, how)
    surfaces, gaps = surfaces_of(skin, model.source, how.seam_tolerance, SMOOTH) if skin else ((), ())
    curves = sampled(model.curves(), model.source, np.zeros(3))
    return Survey(
        source=model.source,
        format=model.format,
        unit=model.unit,
        faces=tuple(map(_face, skin)),
        surfaces=tuple(_surface(surface, model.source, how.seam_tolerance) for surface in surfaces),
        curves=tuple(
            CurveSurvey(
                number=curve.number,
                label=model.curves()[curve.number - 1].label,
                length=float(norm(np.diff(curve.points, axis=0)).sum()),
            )
            for curve in curves
        ),
        notes=(*model.notes, *mended, *gaps),
    )


def _skin(model: Model, how: ReferenceSettings) -> tuple[tuple[SkinFace, ...], tuple[str, ...]]:
    """All faces, those of solids, too."""
    faces = model.faces() if how.faces is None else select_faces(model, how.faces)
    if not faces:
        if not model.curves() and not model.unreadable():
            raise ReferenceFileError(f"'{model.source}' holds neither faces nor curves.")
        return (), ()
    return skin_faces(faces, model.source, how.seam_tolerance, chosen=how.faces is not None)


def _face(face: SkinFace) -> FaceSurvey:
    surface = face.patch.surface
    kind = surface.GetType()
    has_poles = kind in (GeomAbs_BezierSurface, GeomAbs_BSplineSurface)
    return FaceSurvey(
        number=face.number,
        label=face.source.label,
        panel="" if face.source.of_solid else face.source.panel,
        of_solid=face.source.of_solid,
        kind=KINDS.get(kind, "other"),
        poles=(surface.NbUPoles(), surface.NbVPoles()) if has_poles else (0, 0),
        area=face.area,
        size=_size(face.patch),
        trimmed=not face.patch.whole,
        curvature=curvature_of(face),
    )


def _size(patch: Patch) -> tuple[float, float]:
    along_u, along_v = (float(lengths_along(patch, axis, MIDDLE)[0, -1]) for axis in (0, 1))
    return along_u, along_v


def _surface(surface: Surface, source: str, tolerance: float) -> SurfaceSurvey:
    lips, strip = None, None
    try:
        sections = sections_of(surface, SECTIONS, source, tolerance)
    except ReferenceFileError:
        sections = None  # it is no strip: nothing was measured, and nothing is said
    if sections is not None:
        length, turn = sections.mean
        lips = lips_of(length, turn)
        strip = (sections.strip_length, float(length[-1]))
    return SurfaceSurvey(
        name=surface.name,
        faces=tuple(face.number for face in surface.faces),
        area=surface.area,
        lips=lips,
        strip=strip,
        seams=None if sections is None else _seams(surface, source, tolerance),
    )


def _seams(surface: Surface, source: str, tolerance: float) -> SeamLean | None:
    try:
        strip = find_strip(surface, source, tolerance)
    except ReferenceFileError:  # a tube has sections, but no long edges
        return None
    return seam_lean(seam_bending(surface, strip), strip.length)
