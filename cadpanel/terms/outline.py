"""Where the reference has a panel's corners, and which part of their drift from there counts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.terms.state import State


@dataclass(frozen=True, slots=True, kw_only=True)
class Limited:
    """Which corners are limited in one direction, and what of their drift counts.

    Attributes:
        corners: (panels, L) their places among the panels' corners.
        part: (panels, L, d, 3) rows that take from a drift what is limited; zero where a panel has fewer corners.
    """

    corners: IntArray
    part: Array

    def take(self, panels: IntArray) -> Limited:
        """Those of some panels, as many to a panel as they need."""
        part = self.part[panels]
        held = part.any(axis=(0, 2, 3))
        return Limited(corners=self.corners[panels][:, held], part=part[:, held])


@dataclass(frozen=True, slots=True, kw_only=True)
class Pieces:
    """The pieces of edges whose turn from the drawn edges is limited; rows of zeros where a panel has fewer.

    Attributes:
        points: (panels, P, 2) both ends, see `features.edge_pieces.EdgePieces`.
        planes: (panels, P, 3) unit normals of the drawn edges' planes in the panels' own frames.
        lengths: (panels, P) of the drawn edges, in the solver's length.
    """

    points: IntArray
    planes: Array
    lengths: Array

    def take(self, panels: IntArray) -> Pieces:
        """Those of some panels."""
        return Pieces(points=self.points[panels], planes=self.planes[panels], lengths=self.lengths[panels])


@dataclass(frozen=True, slots=True, kw_only=True)
class Level:
    """Points of edges on seams that are drawn level, and their planes.

    Attributes:
        panels: (g,) whose.
        points: (g,) 0 and more for a panel's corners, -1 and less for its arc points, see `features.edge_pieces`.
        normals: (g, 3) unit normals of the planes in the panels' own frames.
        offsets: (g,) how far along them the planes lie from the frames' origins, in the solver's length.
    """

    panels: IntArray
    points: IntArray
    normals: Array
    offsets: Array

    def take(self, panels: IntArray) -> Level:
        """Those of some panels (n,), which are counted anew."""
        row = np.full(1 + max(int(panels.max(initial=-1)), int(self.panels.max(initial=-1))), -1)
        row[panels] = np.arange(len(panels))
        place = np.flatnonzero(row[self.panels] >= 0)
        return Level(
            panels=row[self.panels[place]],
            points=self.points[place],
            normals=self.normals[place],
            offsets=self.offsets[place],
        )


NOT_LEVEL = Level(
    panels=np.zeros(0, dtype=np.intp),
    points=np.zeros(0, dtype=np.intp),
    normals=np.zeros((0, 3)),
    offsets=np.zeros(0),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """f edges on no seam: points of them, and where they are drawn.

    Attributes:
        panels: (f,) whose.
        places: (f, m, 2) each point lies between two points of the panel's boundary, see `State.boundary`.
        shares: (f, m) how far on the way from the first to the second.
        straight: (f,) whether an edge is one segment.
        drawn: (f, r, 3) the drawn lines in the panels' own frames and the solver's length.
    """

    panels: IntArray
    places: IntArray
    shares: Array
    straight: BoolArray
    drawn: Array


NO_LINE = Line(
    panels=np.zeros(0, dtype=np.intp),
    places=np.zeros((0, 1, 2), dtype=np.intp),
    shares=np.zeros((0, 1)),
    straight=np.zeros(0, dtype=bool),
    drawn=np.zeros((0, 2, 3)),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outline:
    """The reference's corners as the drift limits see them.

    Inside the fold a panel has corners too, where its flanges begin. Where across the fold they lie is a matter of the
    fit, but along the strip they belong on the reference's end like the outer ones: otherwise a cut plane could tilt
    far out of the end while its outer corners stay. How far they are from the end is told in the direction of the
    strip, so that a corner may slide along an end that runs askew.

    Attributes:
        corners: (panels, corners, 3) points on the reference's outline in the panels' own frames and the solver's
            length: its corners, and between them points on its ends.
        along: all corners, one number each: the drift along the strip.
        across: outer corners, three numbers each: the drift across the free edge. A panel whose ends cannot be told
            from its sides has only these, and they are its whole drift.
        sided: (panels,) whether ends can be told from sides.
        pieces: of the edges whose turn is limited.
        level: points on level seams.
        line: the free outline; of some panels taken by themselves it is not known.
    """

    corners: Array
    along: Limited
    across: Limited
    sided: BoolArray
    pieces: Pieces
    level: Level = NOT_LEVEL
    line: Line = NO_LINE

    def take(self, panels: IntArray) -> Outline:
        """The outlines of some panels, with as many corners as the largest of them has: every corner is limited."""
        along, across = self.along.take(panels), self.across.take(panels)
        count = 1 + max(int(limited.corners.max(initial=0)) for limited in (along, across))
        return Outline(
            corners=self.corners[panels, :count],
            along=along,
            across=across,
            sided=self.sided[panels],
            pieces=self.pieces.take(panels),
            level=self.level.take(panels),
        )

    def drift(self, state: State) -> Array:
        """(panels, corners, 3) from the reference's corners to the panels'."""
        return state.corners.position - self.corners
