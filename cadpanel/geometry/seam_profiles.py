"""How far apart and at which angle two chains of curves are, place by place along the first; see `widest_place`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.closest_points import stations
from cadpanel.geometry.conic_chains import ConicChains, followed, joined
from cadpanel.geometry.widest_place import looked_at, told


@dataclass(frozen=True, slots=True, kw_only=True)
class Profiles:
    """What is found at q places along each of s chains, from their closest points on s others.

    Attributes:
        points: (s, q, 3) the places, from end to end.
        gap: (s, q) how far the other chain is.
        kink: (s, q) angle between the two skins' normals, radians.
        width, step: (s, q) the parts of the gap in the skins and square to the curve, and along their mean normal.
    """

    points: Array
    gap: Array
    kink: Array
    width: Array
    step: Array


def profiles(first: ConicChains, second: ConicChains, steps: int) -> Profiles:
    """Follow each piece of the first chains in that many steps; lengths in the chains' own unit."""
    on = stations(joined(first, second))
    w = np.linspace(0.0, 1.0, steps + 1)
    # Pieces follow each other: each but the last leaves its end to the next one's beginning.
    pieces = first.pieces
    along = np.concatenate([*(w[:-1] for _ in range(pieces - 1)), w])
    piece = np.repeat(np.arange(pieces), [*(steps for _ in range(pieces - 1)), steps + 1])
    column = (np.arange(first.count)[:, None] * pieces + piece).ravel()
    shares = np.tile(along, first.count)
    found = told(looked_at(on, column, shares).values.copy()).reshape(4, first.count, -1)
    points = followed(np.take(on.chains.curves, column, axis=1), shares)
    return Profiles(
        points=np.moveaxis(points.reshape(3, first.count, -1), 0, -1),
        gap=found[0],
        kink=found[1],
        width=found[2],
        step=found[3],
    )
