"""In which order the patches of a chain are walked over: from the ruling in the middle of one of them to both sides.

Ruling i lies before patch i; the anchor's ruling comes after all of these.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.features.patches import Kind


@dataclass(frozen=True, slots=True)
class Ways:
    """Ways over the patches of one kind, outwards.

    Attributes:
        kind: of the patches; cylinders are cones.
        patches: over which patch each leads.
        shares: (ways,) of the patch, below 0 to the left.
        starts, ends: (ways,) from which ruling to which one.
        beyond: the rulings that each moves.
    """

    kind: Kind
    patches: tuple[int, ...]
    shares: Array
    starts: IntArray
    ends: IntArray
    beyond: tuple[slice, ...]


@dataclass(frozen=True, slots=True)
class Plan:
    """How a chain is walked.

    Attributes:
        kinds: the ways, kind by kind.
        order: the ways one after the other, each by its kind and its place there, with its start and end.
        carriers: per patch the ruling that its radius is measured at.
    """

    kinds: tuple[Ways, ...]
    order: tuple[tuple[int, int, int, int], ...]
    carriers: IntArray


@lru_cache
def plan_of(anchor: int, curved: tuple[bool, ...]) -> Plan:
    """The plan of a chain that starts in the middle of a patch; `curved` says of each whether it is a cone."""
    count = len(curved)
    last = count + 1
    ways = [(i, last if i == anchor else i + 1, i, -0.5 if i == anchor else -1.0) for i in range(anchor, -1, -1)]
    ways += [(i, last if i == anchor else i, i + 1, 0.5 if i == anchor else 1.0) for i in range(anchor, count)]
    kinds: list[Ways] = []
    order: dict[int, tuple[int, int, int, int]] = {}
    for bent in sorted(set(curved)):
        own = [place for place, way in enumerate(ways) if curved[way[0]] is bent]
        patches, starts, ends, shares = zip(*(ways[place] for place in own), strict=True)
        order |= {place: (len(kinds), i, starts[i], ends[i]) for i, place in enumerate(own)}
        beyond = tuple(
            slice(end, last) if share > 0.0 else slice(end + 1) for end, share in zip(ends, shares, strict=True)
        )
        kinds.append(
            Ways("cone" if bent else "plane", patches, np.array(shares), np.array(starts), np.array(ends), beyond)
        )
    carriers = [last if i == anchor else i + (i < anchor) for i in range(count)]
    return Plan(tuple(kinds), tuple(order[place] for place in range(len(ways))), np.array(carriers))
