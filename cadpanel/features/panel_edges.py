"""A panel's boundary: which of its corners and arc points lie on which edge, and in which order."""

from __future__ import annotations

from dataclasses import dataclass

# Where along the sweep of every curved patch the end curve is held to its neighbour's, besides the corners: a conic
# with given ends and end tangents has one number left, so a few points pin it.
ARC_SHARES = (1 / 4, 1 / 2, 3 / 4)


@dataclass(frozen=True, slots=True)
class Edge:
    """One boundary edge.

    Attributes:
        name: as reports call it, for example "end 0", "side 1", "edge 3".
        corners: indices among the panel's corners, in order; at least two.
        arcs: indices among the panel's arc points, ARC_SHARES of them on every curved piece, in the same order.
        curved: for each piece between two corners whether it is an arc; a straight edge has one straight piece.
    """

    name: str
    corners: tuple[int, ...]
    arcs: tuple[int, ...]
    curved: tuple[bool, ...]

    @property
    def straight(self) -> bool:
        """Whether the edge is one segment."""
        return self.curved == (False,)


def chain_edges(curved: tuple[bool, ...]) -> tuple[Edge, ...]:
    """The two ends and the two sides of a chain whose patches are `curved` or flat.

    Corners are numbered along end 0 from side 0 to side 1, then along end 1; arc points likewise.
    """
    rulings, arcs = len(curved) + 1, len(ARC_SHARES) * sum(curved)
    ends = tuple(
        Edge(
            f"end {end}",
            tuple(range(end * rulings, (end + 1) * rulings)),
            tuple(range(end * arcs, (end + 1) * arcs)),
            curved,
        )
        for end in (0, 1)
    )
    sides = tuple(Edge(f"side {side}", (at, at + rulings), (), (False,)) for side, at in ((0, 0), (1, rulings - 1)))
    return ends + sides


def polygon_edges(corners: int) -> tuple[Edge, ...]:
    """The edges of a polygon, each from its corner to the next."""
    return tuple(Edge(f"edge {i}", (i, (i + 1) % corners), (), (False,)) for i in range(corners))
