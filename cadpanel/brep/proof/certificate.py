"""The proof beside the delivery: panels.step and skins.step are read back and held against the expected numbers.

Nothing is taken from the builder's memory: the two files, and numbers that the caller states (volumes, corners, seams).
Corners are how an end is recognised: an end curve is the part of a skin's boundary whose vertices are the expected
corners of that end. So a panel that has been moved, or a corner that is missing, shows before any gap is measured.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.clearances import Clear, clearances
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam
from cadpanel.brep.proof.flat_checks import FlatFacts, check_flats
from cadpanel.brep.proof.hole_checks import check_holes
from cadpanel.brep.proof.overlaps import unparted
from cadpanel.brep.proof.parallel import Helper, Told, common_volumes, inspect_files, rebuild, unheard
from cadpanel.brep.proof.rebuilt import Rebuilt, unlike_rebuilt
from cadpanel.brep.proof.seam_gaps import seam_gaps
from cadpanel.brep.proof.shape_facts import FACE_KINDS, ShapeFacts
from cadpanel.brep.proof.stated_checks import check_stated
from cadpanel.geometry.kink import edge_angles

TANGENCY_LIMIT = 1e-9
"""Radians between neighbouring patches, read back."""
VOLUME_LIMIT = 1e-9
"""Relative difference between the kernel's volume and the expected one."""
POSITION_LIMIT = 1e-6
"""Distance in mm of a corner from where it is expected, and of a solid's skin from the skin file's."""
OVERLAP_LIMIT = 1e-6
"""Volume in mm3 that the kernel may find in common of two solids that touch."""
FOLD_ANGLE = 0.1
"""Radians; straight edges with a smaller angle between their faces are meant to be smooth; a sheet's own have more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """What reading both files back showed.

    Attributes:
        solids: number of solids in the panels' file.
        skins: number of open shells in the skins' file.
        valid: whether every shape passes the kernel's exact check and every solid is closed.
        face_kinds: number of faces of each kind among the solids.
        max_tangency_error: greatest angle in radians between neighbouring patches, solids and skins.
        volume_error: greatest relative difference of a solid's volume from the expected one.
        flat_area_error: greatest relative difference of a flat pattern's area from that of the surface in the solid.
        flat_length_error: greatest difference of an edge's length, unrolled, from that on the skin, mm.
        stated_error: greatest relative difference of a volume or area that a file states from the kernel's.
        holes: number of holes in the solids.
        hole_error: how far a place of a hole's rim lies off the circle on the flat pattern at most, mm.
        names_kept: whether both files hold exactly the expected names, each once.
        max_corner_error: farthest corner of a skin from where it is expected, mm.
        seam_gaps: measured gap of each expected seam along its whole length, mm, in their order.
        max_seam_gap: the widest of them, mm; 0 without seams.
        clear: the least and the largest clear width of each seam's joint, mm, in their order, None where walls are not
            found; empty where no joint was promised.
        overlap: the largest volume that two solids share, mm3; None where no joint was promised.
        failures: one sentence for everything that does not hold, naming the panel.
    """

    solids: int
    skins: int
    valid: bool
    face_kinds: dict[str, int]
    max_tangency_error: float
    volume_error: float
    flat_area_error: float
    flat_length_error: float
    stated_error: float
    holes: int
    hole_error: float
    names_kept: bool
    max_corner_error: float
    seam_gaps: tuple[float, ...]
    max_seam_gap: float
    clear: tuple[Clear | None, ...]
    overlap: float | None
    failures: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """Whether everything that was expected was found."""
        return not self.failures


def certify(
    panels_step: str | os.PathLike[str],
    skins_step: str | os.PathLike[str],
    panels: Sequence[ExpectedPanel],
    seams: Sequence[ExpectedSeam] = (),
    helper: Helper | None = None,
    joint: float | None = None,
    built: Mapping[str, Rebuilt] = MappingProxyType({}),
    told: Told = unheard,
) -> Certificate:
    """Read both files and prove them against the expected numbers.

    Args:
        panels_step: the file of solids.
        skins_step: the file of skins.
        panels: what both must hold.
        seams: which of their edges meet.
        helper: an interpreter that runs already, to help.
        joint: the width of the joint that was asked for, mm; None where none was promised, not even that sheets touch.
        built: by name, what bounds panels that were built from the numbers of their sheets already; others are built
            anew where there are numbers.
        told: how many solids, skins and sheets more were inspected or built.

    Raises:
        DeliveryError: if a file cannot be read at all.
    """
    solids, skins = inspect_files(panels_step, skins_step, helper, told)
    failures: list[str] = []
    names_kept = _names_kept("solids", solids, panels, failures) & _names_kept("skins", skins, panels, failures)
    solid_of, skin_of = ({facts.name: facts for facts in found} for found in (solids, skins))
    chains = {panel.name for panel in panels if len(panel.kinds) > 1}
    angles = [
        _tangency([facts for facts in found if facts.name in chains], label, failures)
        for found, label in ((solids, "solid"), (skins, "skin"))
    ]
    volume_error, corner_error, stated_error, hole_error = 0.0, 0.0, 0.0, 0.0
    flats: list[FlatFacts] = []
    for panel in panels:
        if panel.name in solid_of:
            volume_error = max(volume_error, _check_solid(panel, solid_of[panel.name], failures))
            hole_error = max(hole_error, check_holes(panel.name, panel.holes, solid_of[panel.name], failures))
        if panel.name in skin_of:
            corner_error = max(corner_error, _check_skin(panel, skin_of[panel.name], failures))
        for label, found, said in (("solid", solid_of, panel.said), ("skin", skin_of, panel.said_of_skin)):
            if panel.name in found:
                _check_placed(panel, label, found[panel.name], failures)
                if said is not None:
                    stated_error = max(stated_error, check_stated(label, found[panel.name], said, failures))
        if panel.name in solid_of and panel.name in skin_of:
            _check_same_place(panel.name, solid_of[panel.name], skin_of[panel.name], failures)
            if panel.flat is not None:
                read = solid_of[panel.name], skin_of[panel.name]
                flats.append(FlatFacts(panel.flat, panel.far_planes, *read, panel.holes))
    sheets = {panel.name: panel.sheet for panel in panels if panel.sheet is not None and panel.name not in built}
    anew = rebuild(panels_step, [*sheets.values()], helper, told)
    failures += unlike_rebuilt([*built, *sheets], [*built.values(), *anew], solid_of, skin_of)
    flat_errors = check_flats(flats, failures)
    gaps = seam_gaps(panels, skin_of, seams, failures)
    clear = [] if joint is None else clearances(panels, solid_of, seams, joint, failures)
    overlap = None if joint is None else _overlap(panels_step, solids, seams, failures)
    kinds = Counter[str]()
    for facts in solids:
        kinds.update(facts.face_kinds)
    return Certificate(
        solids=sum(facts.solids for facts in solids),
        skins=sum(facts.shells for facts in skins),
        valid=all(facts.valid for facts in (*solids, *skins)) and all(facts.closed for facts in solids),
        face_kinds={kind: kinds[kind] for kind in FACE_KINDS},
        max_tangency_error=max(angles),
        volume_error=volume_error,
        flat_area_error=flat_errors[0],
        flat_length_error=flat_errors[1],
        stated_error=stated_error,
        holes=sum(len(facts.rims) for facts in solids) // 2,
        hole_error=hole_error,
        names_kept=names_kept,
        max_corner_error=corner_error,
        seam_gaps=tuple(gaps),
        max_seam_gap=max(gaps, default=0.0),
        clear=tuple(clear),
        overlap=overlap,
        failures=tuple(failures),
    )


def _overlap(
    panels_step: str | os.PathLike[str],
    solids: Sequence[ShapeFacts],
    seams: Sequence[ExpectedSeam],
    failures: list[str],
) -> float:
    """The largest volume that two solids share, mm3, of those that no plane parts."""
    across: dict[str, list[Array]] = {}
    for seam in seams:
        for name in seam.panels if seam.across is not None else ():
            across.setdefault(name, []).append(np.asarray(seam.across))
    pairs = unparted(solids, across)
    shared = common_volumes(panels_step, pairs) if pairs else []
    for (first, second), volume in zip(pairs, shared, strict=True):
        if not volume <= OVERLAP_LIMIT:
            failures.append(
                f"Panels '{solids[first].name}' and '{solids[second].name}' share {volume:.3g} mm3, and no "
                "seam between them is known: take a thinner sheet, a wider --seam-tolerance, or, where corners lie on "
                "sides, --junctions."
            )
    return max(shared, default=0.0)


def _names_kept(label: str, found: Sequence[ShapeFacts], panels: Sequence[ExpectedPanel], failures: list[str]) -> bool:
    there, wanted = Counter(facts.name for facts in found), Counter(panel.name for panel in panels)
    for name in wanted - there:
        failures.append(f"Panel '{name}' is missing among the {label}.")
    for name in there - wanted:
        failures.append(f"Panel '{name}' is among the {label} but is not expected there.")
    return there == wanted


def _tangency(found: Sequence[ShapeFacts], label: str, failures: list[str]) -> float:
    """Greatest angle among the straight edges that are meant to be smooth, all shapes at once."""
    if not found:
        return 0.0
    angles = edge_angles(
        np.concatenate([facts.straight_edges for facts in found]),
        np.concatenate([facts.edge_surfaces for facts in found]),
    )
    owner = np.repeat(np.arange(len(found)), [len(facts.straight_edges) for facts in found])
    # On a skin every shared edge is meant to be smooth; on a solid the sheet's own edges are not.
    smooth = angles < FOLD_ANGLE if label == "solid" else np.ones(len(angles), dtype=bool)
    for index in np.unique(owner[smooth & (angles > TANGENCY_LIMIT)]):
        worst = angles[smooth & (owner == index)].max()
        failures.append(f"Panel '{found[index].name}': its {label} has a kink of {worst:.3g} rad between two patches.")
    return float(angles[smooth].max(initial=0.0))


def _check_solid(panel: ExpectedPanel, facts: ShapeFacts, failures: list[str]) -> float:
    """Everything about one solid but its tangency; returns the relative error of its volume."""
    found, wanted = Counter(facts.face_kinds), Counter[str]((*panel.kinds, *panel.kinds, *panel.walls))
    # One patch meets no other smoothly; the walls of a polygon may, where its outline hardly turns.
    smooth = int((edge_angles(facts.straight_edges, facts.edge_surfaces) < FOLD_ANGLE).sum())
    wrongly_smooth = len(panel.kinds) > 1 and smooth != panel.smooth_edges
    error = abs(facts.volume / panel.volume - 1.0)
    problems = {
        f"holds {facts.solids} solids instead of one": facts.solids != 1,
        "does not pass the kernel's exact check": not facts.valid,
        "is not closed": not facts.closed,
        f"has the faces {_described(found)}, expected {_described(wanted)}": wanted != +found,
        f"has {smooth} smooth edges, expected {panel.smooth_edges}": wrongly_smooth,
        f"has a volume of {facts.volume:.12g} mm3, expected {panel.volume:.12g}": not error <= VOLUME_LIMIT,
    }
    failures += [f"Panel '{panel.name}': its solid {problem}." for problem, present in problems.items() if present]
    if facts.solids == 1:
        _check_far_face(panel, facts, failures)
    return error


def _check_far_face(panel: ExpectedPanel, facts: ShapeFacts, failures: list[str]) -> None:
    """Corners of the solid must lie where the thickness and the skin's side put the far face of each flat patch."""
    corners = 4 if len(panel.corners) == 2 else panel.corners.shape[1]  # of a flat patch of a chain, or of a polygon
    for index, (point, normal) in enumerate(panel.far_planes, start=1):
        off = np.sort(np.abs((facts.vertices - point) @ normal))
        if not (len(off) >= corners and off[corners - 1] <= POSITION_LIMIT):
            failures.append(
                f"Panel '{panel.name}': the far face of its solid does not lie where the thickness and the skin's side "
                f"put it (flat patch {index})."
            )
            return


def _check_skin(panel: ExpectedPanel, facts: ShapeFacts, failures: list[str]) -> float:
    """Everything about one skin but its tangency; returns how far its farthest corner is from the expected one."""
    found, wanted = Counter(facts.face_kinds), Counter[str](panel.kinds)
    shared, alone = len(facts.straight_edges), (facts.shells, facts.solids) == (1, 0)
    corners = panel.vertices
    error = max(_farthest(corners, facts.vertices), _farthest(facts.vertices, corners))
    problems = {
        f"holds {facts.shells} shells and {facts.solids} solids instead of one shell": not alone,
        "does not pass the kernel's exact check": not facts.valid,
        f"has the faces {_described(found)}, expected {_described(wanted)}": wanted != +found,
        f"has {shared} straight shared edges, expected {len(panel.kinds) - 1}": shared != len(panel.kinds) - 1,
        f"has a corner {error:.3g} mm away from where it is expected": not error <= POSITION_LIMIT,
        f"has {facts.other_borders} boundary edges that are neither lines nor ellipses, expected {panel.bent_sides}": (
            facts.other_borders != panel.bent_sides
        ),
    }
    failures += [f"Panel '{panel.name}': its skin {problem}." for problem, present in problems.items() if present]
    return error


def _check_placed(panel: ExpectedPanel, label: str, facts: ShapeFacts, failures: list[str]) -> None:
    """The origin of its coordinates must lie where it is expected; a millimetre on a map is the last digit but six."""
    apart = float(np.abs(facts.placed - panel.placed).max())
    if not apart <= POSITION_LIMIT:
        failures.append(f"Panel '{panel.name}': its {label} is placed {apart:.3g} mm away from where it is expected.")


def _described(kinds: dict[str, int]) -> str:
    return ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()) if count) or "none"


def _check_same_place(name: str, solid: ShapeFacts, skin: ShapeFacts, failures: list[str]) -> None:
    """The skin's corners must be corners of the solid."""
    apart = _farthest(skin.vertices, solid.vertices)
    if not apart <= POSITION_LIMIT:
        failures.append(f"Panel '{name}': its solid lies {apart:.3g} mm away from its skin.")


def _farthest(points: Array, others: Array) -> float:
    """Distance in mm of the point that is farthest from its nearest other; infinite if there is none to be near."""
    apart = np.linalg.norm(points[:, None] - others[None], axis=-1).min(axis=1, initial=np.inf)
    return float(apart.max(initial=0.0))
