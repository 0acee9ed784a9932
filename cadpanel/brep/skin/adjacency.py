"""Which faces of the skin hang together: the surfaces that are cut into panels, each for itself."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.faces.boundary import Edge
from cadpanel.brep.skin.face_cleanup import SkinFace
from cadpanel.geometry.order import order_in_space
from cadpanel.geometry.polyline import distances_to_curves
from cadpanel.geometry.vectors import norm
from cadpanel.reference.inner_edges import KNIFE_EDGE

# Places on an edge, as parts of its points, of which one must lie on the other edge for the two to touch.
PROBES = (0.25, 0.5, 0.75)
# Edges must lie this close to each other, as a part of the shorter one's length, to touch along and not across.
LONG_ENOUGH = 0.1
# Points looked at around a probe, in case that the other edge is sampled more coarsely.
NEAREST = 8
# Where faces touch, a distance of more than this is worth a note, mm.
WORTH_A_NOTE = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """Two faces that touch along an edge.

    Attributes:
        faces: their indices, rising.
        point: (3,) in the middle of an edge along which they touch, mm.
        gap: how far apart the edges lie, mm.
        fold: by how much the surface turns from one face to the other, degrees.
    """

    faces: tuple[int, int]
    point: Array
    gap: float
    fold: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """Faces that hang together.

    Attributes:
        name: of the surface, stable: the file's own where all its faces share one, else by its place.
        faces: in file order.
        contacts: where they touch along edges.
    """

    name: str
    faces: tuple[SkinFace, ...]
    contacts: tuple[Contact, ...]

    @property
    def size(self) -> float:
        """Diagonal of the box around it, mm."""
        points = np.concatenate([array for face in self.faces for array in (face.samples.points, *face.samples.edges)])
        return float(np.linalg.norm(np.ptp(points, axis=0)))

    @property
    def area(self) -> float:
        """Sum of its faces' areas, mm^2."""
        return sum(face.area for face in self.faces)

    @property
    def numbers(self) -> str:
        """Its faces' numbers in the file, for messages."""
        numbers = [str(face.number) for face in self.faces]
        return f"face {numbers[0]}" if len(numbers) == 1 else f"faces {', '.join(numbers[:-1])} and {numbers[-1]}"


def surfaces_of(
    faces: Sequence[SkinFace],
    source: str,
    tolerance: float,
    most_fold: float = KNIFE_EDGE,
    left_out: Collection[str] | None = None,
) -> tuple[tuple[Surface, ...], tuple[str, ...]]:
    """Group faces that touch along an edge, to within a tolerance.

    Args:
        faces: of the skin.
        source: the file's name.
        tolerance: how far faces that touch may lie apart, mm.
        most_fold: faces that fold by more than this where they touch are not joined, degrees.
        left_out: the names of faces of the file that are not looked at; None where the file is looked at as a whole.

    Returns:
        The surfaces by their place in space (x, then y, then z of their middles), and a note where faces lie apart.
    """
    touching = contacts_of(faces, tolerance)
    joints = [contact for contact in touching if contact.fold <= most_fold]
    pairs = np.array([contact.faces for contact in joints], dtype=np.intp).reshape(-1, 2)
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(faces), len(faces)))
    number, labels = connected_components(graph, directed=False)
    groups = [np.flatnonzero(labels == group).tolist() for group in range(number)]
    middles = np.array([_middle([faces[index] for index in group]) for group in groups])
    order = order_in_space(middles, max(tolerance, 1.0)).tolist()
    names = _names([[faces[index] for index in groups[group]] for group in order], left_out)
    surfaces = []
    for name, group in zip(names, order, strict=True):
        place = {index: position for position, index in enumerate(groups[group])}
        surfaces.append(
            Surface(
                name=name,
                faces=tuple(faces[index] for index in groups[group]),
                contacts=tuple(
                    replace(contact, faces=(place[contact.faces[0]], place[contact.faces[1]]))
                    for contact in joints
                    if contact.faces[0] in place
                ),
            )
        )
    return tuple(surfaces), _notes(faces, touching, source, tolerance, most_fold)


def _notes(
    faces: Sequence[SkinFace], touching: Sequence[Contact], source: str, tolerance: float, most_fold: float
) -> tuple[str, ...]:
    """What to say of gaps and knife edges: the widest gap, and each pair that is not joined."""
    notes = []
    gaping = [contact for contact in touching if contact.gap > WORTH_A_NOTE and contact.fold <= most_fold]
    if gaping:
        widest = max(gaping, key=lambda contact: contact.gap)
        first, second = (faces[index].number for index in widest.faces)
        many = f"{len(gaping)} edges between faces of '{source}' gape, the widest"
        if len(gaping) == 1:
            many = f"An edge between faces of '{source}' gapes,"
        notes.append(
            f"{many} by {widest.gap:.2g} mm between faces {first} and {second}; that is within the tolerance of "
            f"{tolerance:g} mm."
        )
    folded = {contact.faces: contact.fold for contact in touching if contact.fold > most_fold}
    if most_fold < KNIFE_EDGE and folded:
        pairs = (
            f"{len(folded)} pairs of faces of '{source}' meet" if len(folded) > 1 else f"Two faces of '{source}' meet"
        )
        notes.append(f"{pairs} in a crease of more than {most_fold:g} degrees: they count as different surfaces here.")
        return tuple(notes)
    for (one, other), fold in sorted(folded.items()):
        notes.append(
            f"Faces {faces[one].number} and {faces[other].number} of '{source}' fold back by {fold:.0f} degrees where "
            "they meet; they are not joined there."
        )
    return tuple(notes)


def contacts_of(faces: Sequence[SkinFace], tolerance: float) -> list[Contact]:
    """Where faces touch along edges, sorted by faces.

    Args:
        faces: of the skin.
        tolerance: how far edges that touch may lie apart, mm.
    """
    edges = [(index, edge) for index, face in enumerate(faces) for edge in face.patch.edges]
    contacts: list[Contact] = []
    if not edges:  # whole spheres and the like have no border
        return contacts
    for first, second in _near_edges([edge.points for _, edge in edges], tolerance):
        (a, one), (b, other) = sorted((edges[first], edges[second]), key=lambda owned: owned[0])
        if a == b:
            continue
        (there, point), (back, other_point) = _gap(one.points, other.points), _gap(other.points, one.points)
        gap = min(there, back)
        if gap <= min(tolerance, LONG_ENOUGH * _length(one.points), LONG_ENOUGH * _length(other.points)):
            point = point if there <= back else other_point
            fold = _fold(one, other, point)
            contacts.append(Contact(faces=(a, b), point=point, gap=gap, fold=fold))
    return sorted(contacts, key=lambda contact: (contact.faces, contact.point.tolist()))


def _fold(edge: Edge, other: Edge, point: Array) -> float:
    """By how much the way turns that comes out of one face and goes on into the other, degrees."""
    ways = []
    for border in (edge, other):
        near = int(np.clip(np.argmin(norm(border.points - point)), 1, len(border.points) - 2))
        ways.append(border.inwards(near))
    return float(np.degrees(np.arccos(np.clip(-(ways[0] @ ways[1]), -1.0, 1.0))))


def _near_edges(edges: Sequence[Array], tolerance: float) -> list[tuple[int, int]]:
    """Pairs of edges of which one has a probe whose nearest point of another is near; time grows with N log N."""
    points = np.concatenate(edges)
    owners = np.repeat(np.arange(len(edges)), [len(edge) for edge in edges])
    spacing = np.concatenate([np.full(len(edge), _spacing(edge)) for edge in edges])
    tree = cKDTree(points)
    found: set[tuple[int, int]] = set()
    for index, edge in enumerate(edges):
        probes = edge[[round(part * (len(edge) - 1)) for part in PROBES]]
        # On a coarser edge the nearest point may lie half its spacing away.
        for neighbours in tree.query_ball_point(probes, tolerance + 0.5 * _spacing(edge)):
            found |= {(index, int(other)) for other in np.unique(owners[neighbours]) if other != index}
        nearest, which = (np.asarray(found_there) for found_there in tree.query(probes, k=min(NEAREST, len(points))))
        near = which[nearest <= tolerance + 0.6 * spacing[which]]
        found |= {(index, int(other)) for other in np.unique(owners[near]) if other != index}
    return sorted({(min(pair), max(pair)) for pair in found})


def _length(edge: Array) -> float:
    return float(norm(np.diff(edge, axis=0)).sum())


def _spacing(edge: Array) -> float:
    return float(np.linalg.norm(np.diff(edge, axis=0), axis=1).max())


def _gap(first: Array, second: Array) -> tuple[float, Array]:
    """Least distance of the first edge's probes to the second one, mm; and the probe."""
    probes = first[[round(part * (len(first) - 1)) for part in PROBES]]
    distances = distances_to_curves(probes[None], second[None])[0]
    nearest = int(np.argmin(distances))
    return float(distances[nearest]), probes[nearest]


def _middle(faces: Sequence[SkinFace]) -> Array:
    weights = np.concatenate([face.samples.weights for face in faces])
    points = np.concatenate([face.samples.points for face in faces])
    return np.asarray(weights @ points / weights.sum(), dtype=np.float64)


def _names(groups: Sequence[Sequence[SkinFace]], left_out: Collection[str] | None) -> list[str]:
    """The name that all faces of a surface share and nothing else in the file has; else S1, S2 by place.

    Of chosen faces, the number of the first, behind the name that others share: who chooses others of the same file
    gets other names. Where a surface is called S2 in the file, the one in its place gets the next free number.
    """
    shared = []
    for group in groups:
        names = {face.source.label.name for face in group}
        shared.append(names.pop() if len(names) == 1 else "")
    uses = Counter(shared) + Counter(left_out or ())
    own = {name for name, count in uses.items() if name and count == 1}
    spare = (f"S{number}" for number in itertools.count(len(groups) + 1))
    chosen = []
    for place, (name, group) in enumerate(zip(shared, groups, strict=True), start=1):
        usual = f"S{place}" if left_out is None else "-".join(filter(None, (name, f"F{group[0].number}")))
        by_place = usual if usual not in own else next(word for word in spare if word not in own)
        chosen.append(name if name in own else by_place)
    return chosen
