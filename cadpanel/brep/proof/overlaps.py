"""Do any two sheets in a file share volume? Millimetres.

Two sheets share none where a plane parts them: a wall of either, any other of their flat faces, or one square to a way
across a joint of either, as square walls at ends and sides that bend are no planes. What a plane of
planes, cones and cylinders bounds is farthest out, in any direction, on an edge: where a developable face touches a
plane, it does so along a whole ruling, which ends on edges. So does a wall of normals, which is ruled, too. So sheets
are parted, or not, by their edges alone. The kernel is asked only for what is left.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.geometry.boxes import meeting

TOUCH = 1e-7
"""How far one sheet may reach through the plane that parts it from another, mm: the kernel's own tolerance."""


def unparted(
    solids: Sequence[ShapeFacts], across: Mapping[str, Sequence[Array]] | None = None
) -> list[tuple[int, int]]:
    """Pairs of sheets, by their places, whose boxes meet and which no plane parts that is known.

    Args:
        solids: the sheets.
        across: ways (3,) across the joints of each, by its name, where they are known.
    """
    ways = {name: np.concatenate([own, np.negative(own)]) for name, own in (across or {}).items()}
    normals = [np.concatenate([_flat_normals(facts), ways.get(facts.name, np.empty((0, 3)))]) for facts in solids]
    there = [place for place, facts in enumerate(solids) if facts.solids and len(facts.pieces)]
    boxes = np.array([_box(solids[place]) for place in there]).reshape(-1, 2, 3)
    return [
        (i, j)
        for i, j in sorted((there[one], there[other]) for one, other in meeting(boxes[:, 0], boxes[:, 1], TOUCH))
        if not (_parts(solids[i], solids[j], normals[i]) or _parts(solids[j], solids[i], normals[j]))
    ]


def _box(facts: ShapeFacts) -> tuple[Array, Array]:
    """The least and greatest coordinates (3,)."""
    least, greatest = facts.reach(np.eye(3))
    return least.min(axis=1), greatest.max(axis=1)


def _flat_normals(facts: ShapeFacts) -> Array:
    """(f, 3) of the flat faces of a sheet, out of it."""
    planes = facts.surfaces[facts.surfaces[:, 6] == 0.0]
    return np.asarray(planes[:, 8:] * planes[:, 3:6])


def _parts(one: ShapeFacts, other: ShapeFacts, normals: Array) -> bool:
    """Whether a plane square to one of (n, 3) normals parts the one from the other, which is beyond it."""
    ahead = other.reach(normals)[0].min(axis=1) - one.reach(normals)[1].max(axis=1)
    return bool(ahead.max(initial=-np.inf) >= -TOUCH)
