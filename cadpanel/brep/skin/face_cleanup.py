"""What is mended in a file's faces before they are cut, each with a note, and what is refused with a remedy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from OCP.Standard import Standard_Failure
from OCP.TopoDS import TopoDS_Face
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.faces.closest_points import Search
from cadpanel.brep.faces.creases import crease_of
from cadpanel.brep.faces.face_patch import Patch, patch_of
from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files.model import ModelFace
from cadpanel.errors import ReferenceFileError
from cadpanel.geometry.polyline import arc_lengths, distances_to_curves
from cadpanel.reference.model import FaceSamples

# A face whose area is less than this part of its boundary's length squared is a line.
SLIVER = 1e-6
# A face of no more than this width, in mm, cannot be seen and is no part of a panel.
HAIR = 0.05
# Points of a face that are compared to tell whether it lies on another one.
COMPARED = 16
# Centres of faces that lie on each other are as close as the tolerance, or this part of the largest one's size.
CENTRES = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class SkinFace:
    """A face that is part of the skin.

    Attributes:
        source: the face as the file has it.
        patch: its parameter range and boundary.
        samples: points and normals on it.
        area: mm^2.
        size: diagonal of the box around it, mm.
    """

    source: ModelFace
    patch: Patch
    samples: FaceSamples
    area: float
    size: float

    @property
    def number(self) -> int:
        """Its place in the file, from 1."""
        return self.source.number


def skin_faces(
    faces: Sequence[ModelFace], source: str, tolerance: float, *, chosen: bool = False
) -> tuple[tuple[SkinFace, ...], tuple[str, ...]]:
    """Measure faces, leaving out those without width and those that lie on another one.

    One that cannot be measured is left out, too, unless the user has chosen it.

    Args:
        faces: what is chosen of the file.
        source: the file's name.
        tolerance: within which a face lies on another one, mm.
        chosen: whether the user has named them.

    Returns:
        The faces that stay, and a note on each that does not.

    Raises:
        ReferenceFileError: a chosen face cannot be evaluated, or none is left.
    """
    notes: list[str] = []
    measured = []
    for face in faces:
        try:
            skin = _measured(face)
        except _FaultError as error:
            if chosen:
                raise _refused(face, source, error) from error
            notes.append(f"Face {face.number} of '{source}' {error} and is left out.")
            continue
        if skin is None:
            notes.append(f"Face {face.number} of '{source}' has no area and is left out.")
            continue
        width = width_of_hair(skin.samples)
        if width is not None:
            notes.append(f"Face {face.number} of '{source}' is only {width:.2g} mm wide and is left out.")
            continue
        crease = crease_of(skin.patch)
        if crease:
            notes.append(
                f"Face {face.number} of '{source}' has a crease of {crease:.3g} degrees inside, which counts as a part "
                "of its bend: split it there, if panels should end on it."
            )
        measured.append(skin)
    kept, doubled = _without_doubles(measured, source, tolerance)
    if not kept:
        raise ReferenceFileError(f"'{source}' holds no face with an area: export the faces of the skin again.")
    return kept, (*notes, *doubled)


def measure(face: ModelFace, source: str) -> SkinFace | None:
    """Measure one face; None where it has no area.

    Raises:
        ReferenceFileError: the kernel cannot evaluate it.
    """
    try:
        return _measured(face)
    except _FaultError as error:
        raise _refused(face, source, error) from error


class _FaultError(Exception):
    """What keeps a face from being measured, to go on after its name."""


def _refused(face: ModelFace, source: str, why: _FaultError) -> ReferenceFileError:
    return ReferenceFileError(f"Face {face.number} of '{source}' {why}: repair it and export again.")


def _measured(face: ModelFace) -> SkinFace | None:
    try:
        (samples,) = sample_faces(face.face)
        patch = patch_of(face.face)
    except Standard_Failure as error:
        raise _FaultError(f"cannot be evaluated by the CAD kernel ({error})") from error
    arrays = (samples.points, samples.normals, samples.weights, *samples.edges, *samples.edge_normals)
    if not all(np.isfinite(array).all() for array in arrays):
        raise _FaultError("has points that are not numbers")
    if not len(samples.points):
        return None
    points = np.concatenate([samples.points, *samples.edges])
    return SkinFace(
        source=face,
        patch=patch,
        samples=samples,
        area=float(samples.weights.sum()),
        size=float(np.linalg.norm(np.ptp(points, axis=0))),
    )


def _without_doubles(
    faces: Sequence[SkinFace], source: str, tolerance: float
) -> tuple[tuple[SkinFace, ...], tuple[str, ...]]:
    """Leave out each face that covers the same surface as one before it."""
    dropped = find_doubles([face.samples for face in faces], [face.source.face for face in faces], tolerance)
    notes = tuple(
        f"Face {faces[second].number} of '{source}' lies on face {faces[first].number} and is left out."
        for second, first in sorted(dropped.items())
    )
    return tuple(face for index, face in enumerate(faces) if index not in dropped), notes


def width_of_hair(samples: FaceSamples) -> float | None:
    """The width of a face that is too narrow to be a part of a panel, mm; None for all others."""
    around = sum(float(lengths[-1]) for lengths in arc_lengths(samples.edges))
    area = float(samples.weights.sum())
    width = 2.0 * area / around if around > 0.0 else np.inf
    return width if area <= SLIVER * around**2 or width < HAIR else None


def find_doubles(faces: Sequence[FaceSamples], shapes: Sequence[TopoDS_Face], tolerance: float) -> dict[int, int]:
    """Which faces cover the same surface as one before them, and which that is, by their places.

    Args:
        faces: each with an area.
        shapes: the kernel's faces, in the same order.
        tolerance: within which a face lies on another one, mm.
    """
    dropped: dict[int, int] = {}
    if len(faces) < 2:
        return dropped
    centres = np.array([face.weights @ face.points / face.weights.sum() for face in faces])
    size = max(float(np.linalg.norm(np.ptp(face.points, axis=0))) for face in faces)
    for first, second in sorted(cKDTree(centres).query_pairs(max(tolerance, CENTRES * size))):
        if first in dropped or second in dropped or not _alike(faces[first], faces[second], tolerance):
            continue
        # Faces of one border and nearly one area may part inside: two layers, or a flat one and a wavy one.
        pairs = ((first, second), (second, first))
        if all(_lies_on(faces[one].points, faces[other], shapes[other], tolerance) for one, other in pairs):
            dropped[second] = first
    return dropped


def _lies_on(points: Array, samples: FaceSamples, face: TopoDS_Face, tolerance: float) -> bool:
    """Tell whether (m, 3) points all lie on a face of which they have the border."""
    apart = points[cKDTree(samples.points).query(points)[0] > tolerance]  # of a copy, none
    return not len(apart) or bool((Search(patch_of(face)).feet(apart).distances <= tolerance).all())


def _alike(first: FaceSamples, second: FaceSamples, tolerance: float) -> bool:
    """Tell whether two faces have the same boundary and nearly the same area."""
    area, other_area = float(first.weights.sum()), float(second.weights.sum())
    larger = max(area, other_area)
    if abs(area - other_area) > 1e-3 * larger + tolerance * np.sqrt(larger):
        return False
    for one, other in ((first, second), (second, first)):
        if not one.edges or not other.edges:
            return bool(one.edges) == bool(other.edges)
        points = np.concatenate([edge[:: max(1, len(edge) // COMPARED)] for edge in one.edges])
        distances = np.min([distances_to_curves(points[None], edge[None])[0] for edge in other.edges], axis=0)
        if distances.max() > tolerance:
            return False
    return True
