"""A panel's flat pattern on a page, to a scale of the usual ones, with its dimensions, bends and neighbours."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.drawing.part import bend_lines
from cadpanel.delivery.pages.dimensions import dimension, room_for, words_along
from cadpanel.delivery.pages.paper import Box, Paper, standard_scale
from cadpanel.delivery.records.flat_parts import FlatPart
from cadpanel.geometry.unroll_trays import of_corner

_ROOM = 26.0
"""Round the part, for its dimensions, mm on paper."""
_NEAR, _STEP, _FAR = 5.0, 5.0, 20.0
_PLACES = np.linspace(0.0, 1.0, 65)
_NAME = 5.0


def draw_flat(paper: Paper, part: FlatPart, neighbours: Mapping[str, str], box: Box) -> float:
    """Draw the part, seen from outside, in the middle of a box; returns the scale, paper to part."""
    curves = part.pattern.curves
    points = curves.points(np.broadcast_to(_PLACES, (len(curves), len(_PLACES))))
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    inner = Box(
        left=box.left + _ROOM, bottom=box.bottom + _ROOM, width=box.width - 2.0 * _ROOM, height=box.height - 2.0 * _ROOM
    )
    scale = standard_scale(high - low, inner)
    shift = inner.middle - 0.5 * scale * (low + high)
    # A straight piece has nothing between its ends that a line has not.
    chains = [chain if curved else chain[[0, -1]] for chain, curved in zip(points, curves.curved, strict=True)]
    on_paper = [scale * chain + shift for chain in chains]
    paper.contour(np.concatenate(on_paper))
    for line in bend_lines(part):
        paper.lines(scale * line + shift, width=0.13, dashed=True)
    for x, y, diameter in part.circles.tolist():
        paper.circle(scale * np.array([x, y]) + shift, 0.5 * scale * diameter)
    _dimension_pieces(paper, part, on_paper)
    _overall(paper, scale * low + shift, scale * high + shift, high - low)
    _say(paper, part, neighbours, on_paper, scale * part.pattern.curves.start.mean(axis=0) + shift)
    return scale


def _dimension_pieces(paper: Paper, part: FlatPart, chains: list[Array]) -> None:
    """The length of every piece of the outline, outside of it; bent ones are measured along the bend.

    Of what belongs to reliefs only how wide each leg is: allowances stand in the table of bends.
    """
    level = 0
    bent, told = part.pattern.curves.curved.tolist(), _told(part)
    for chain, length, curved, tell in zip(chains, part.size.pieces, bent, told, strict=True):
        if not tell:
            continue
        number = f"{length:.1f}"
        span = float(np.linalg.norm(chain[-1] - chain[0]))
        # Beside a short one the next number stands one line farther out.
        level = 0 if span >= room_for(number) else 1 - level
        distance = _NEAR + _STEP * level
        if curved:
            middle, ahead = chain[len(chain) // 2], chain[len(chain) // 2 + 1] - chain[len(chain) // 2 - 1]
            along = ahead / np.linalg.norm(ahead)
            # Beside the number of a straight one, which stands on its line, not between the two.
            words_along(paper, middle + (distance if level else 1.0) * _out(along), along, _out(along), number)
        else:
            along = (chain[-1] - chain[0]) / span
            dimension(paper, chain[0], chain[-1], _out(along), distance, number)


def _told(part: FlatPart) -> list[bool]:
    """Which pieces of the outline get a dimension."""
    edges, owners = part.pattern.edges, part.pattern.owners
    after = [*range(1, len(edges)), 0]
    legs = [not of_corner(edges[row]) and owners[row] == owner > 0 for row, owner in zip(after, owners, strict=True)]
    return [not of_corner(edge) or leg for edge, leg in zip(edges, legs, strict=True)]


def _out(along: Array) -> Array:
    """The way out of a part whose outline runs counterclockwise."""
    return np.array([along[1], -along[0]])


def _overall(paper: Paper, low: Array, high: Array, size: Array) -> None:
    """The extents of the whole part, along its rulings and square to them."""
    down, left = np.array([0.0, -1.0]), np.array([-1.0, 0.0])
    dimension(paper, low, np.array([high[0], low[1]]), down, _FAR, f"{size[0]:.1f}")
    dimension(paper, np.array([low[0], high[1]]), low, left, _FAR, f"{size[1]:.1f}")


def _say(paper: Paper, part: FlatPart, neighbours: Mapping[str, str], chains: list[Array], middle: Array) -> None:
    """The name, and inside of every edge what it is called and who is met there."""
    paper.words(part.pattern.name, middle, _NAME, anchor="middle", bold=True, halo=True)
    paper.words("this face out", middle - [0.0, 4.5], 2.5, anchor="middle", halo=True)
    for edge in part.size.edges:
        rows = [row for row, own in enumerate(part.pattern.edges) if own == edge]
        longest = max(rows, key=lambda row: round(part.size.pieces[row], 6))
        chain = chains[longest]
        middle_of = 0.5 * (chain[0] + chain[-1]) if len(chain) == 2 else chain[len(chain) // 2]
        along = (chain[-1] - chain[0]) / max(float(np.linalg.norm(chain[-1] - chain[0])), 1e-9)
        words = ": ".join(word for word in (edge, neighbours.get(edge, "")) if word)
        words_along(paper, middle_of - 1.0 * _out(along), along, -_out(along), words, halo=True)
