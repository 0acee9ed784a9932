"""The two kinds of panels as plain arrays: patches between rulings, cut by planes at the ends, and polygons.

Every length is in millimetres, every angle in radians. This is what the fit hands to the solids, the report and the
measures; it knows nothing of unknowns, samples or CAD kernels.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.chain_checks import check_chain, check_chain_sheet
from cadpanel.geometry.chain_cutting import cut_chain
from cadpanel.geometry.cone_sections import chain_arcs
from cadpanel.geometry.curve_pieces import CurvePieces, segments, together
from cadpanel.geometry.leaning_sides import parallel_walk
from cadpanel.geometry.panel import CutPlane, PanelEdge, Straightened
from cadpanel.geometry.patches import Patch, PlanePatch
from cadpanel.geometry.plane_sides import end_spans, side_curve, side_curves, side_tangents
from cadpanel.geometry.polygon_checks import check_polygon, polygon_area
from cadpanel.geometry.polygon_cutting import cut_polygon
from cadpanel.geometry.slender_cones import SMALLEST_HALF_ANGLE, straighten
from cadpanel.geometry.square_walls import square_chain, square_polygon
from cadpanel.geometry.vectors import cross, unit
from cadpanel.geometry.volume import patch_areas


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelShape:
    """A panel's skin: k patches between k + 1 rulings, trimmed by one cut plane at either end.

    A ruling is an orthonormal frame: point p on the skin, direction t along the straight generatrix, unit normal n of
    the skin, which points OUTWARD (away from the inside of the building), and b = t x n, the way the walk goes.
    The first and the last ruling are the panel's long free edges. End 0 lies where t comes from, end 1 where t goes to.

    Attributes:
        name: the panel's stable name.
        feature: name of the shape feature, for example "plane-cone-plane".
        points: (k + 1, 3) a point on each ruling, mm.
        directions: (k + 1, 3) unit t.
        normals: (k + 1, 3) unit n.
        patches: the k patches in the order of the walk.
        cut_points: (2, 3) a point on the cut plane of end 0 and end 1, mm.
        cut_normals: (2, 3) unit normals of the cut planes, both with a positive component along t.
        side_leans: (2,) by how much the wall at either side leans along b for one mm along n; 0 where it stands square
            to the sheet, at the side of a cone, and in a plane that is given.
        side_planes: the planes in which the sides of round patches stand that follow no ruling; see `plane_sides`. The
            ruling is then the innermost one outside of which nothing of the sheet lies.
        square: whether the walls of its sheet stand square to it; see `squared`.
        lift: where the skin that the cut planes cut lies, mm along n: elsewhere than here only on a face of a square
            sheet that is not the panel's skin. Every corner and every point of an end lies at that skin's own, along n.
    """

    name: str
    feature: str
    points: Array
    directions: Array
    normals: Array
    patches: tuple[Patch, ...]
    cut_points: Array
    cut_normals: Array
    side_leans: Array = field(default_factory=lambda: np.zeros(2))
    side_planes: tuple[CutPlane | None, CutPlane | None] = (None, None)
    square: bool = False
    lift: float = 0.0

    def __repr__(self) -> str:
        return f"<PanelShape '{self.name}': {self.feature}, {len(self.patches)} patches>"

    def corners(self) -> Array:
        """(2, k + 1, 3) where each ruling, or a side that stands in a plane, meets the cut planes of both ends, mm."""
        corners = self.pierced()
        for side in range(2):
            curve = side_curve(self, side)
            if curve is not None:
                corners[:, -side] = curve.frame.points(curve.corners, curve.heights)
        return corners

    def pierced(self) -> Array:
        """(2, k + 1, 3) where each ruling pierces the cut plane of end 0 and of end 1, mm."""
        to_plane = self.cut_points[:, None, :] - (self.points + self.lift * self.normals)[None, :, :]
        height = np.einsum("erx,ex->er", to_plane, self.cut_normals)
        rate = np.einsum("rx,ex->er", self.directions, self.cut_normals)
        corners: Array = self.points + (height / rate)[..., None] * self.directions
        return corners

    def rulings(self) -> tuple[Array, Array, Array]:
        """Points, directions and normals of its rulings, (k + 1, 3) each."""
        return self.points, self.directions, self.normals

    def cuts(self) -> tuple[Array, Array]:
        """Points and normals of its two cut planes, (2, 3) each."""
        return self.cut_points, self.cut_normals

    def binormals(self) -> Array:
        """(k + 1, 3) unit b = t x n, the way the walk goes."""
        return cross(self.directions, self.normals)

    def offset(self, distance: float) -> PanelShape:
        """The parallel skin at `distance` mm along n (negative: inwards), cut by the same two planes.

        It has the same rulings' directions and the same half angles; only the normal radii change (exactly). A side
        whose wall leans goes with it. Of a square sheet it ends where the normals do on which this one ends.
        """
        walk = parallel_walk((self.points, self.normals, self.binormals()), self.patches, self.side_leans, distance)
        lift = self.lift - distance if self.square else 0.0
        own = self.rewalked(walk.points, self.directions, walk.normals, walk.patches)
        return replace(own, side_leans=walk.leans, lift=lift)

    @property
    def four_sided(self) -> bool:
        """It has two ends, in the cut planes, and two sides, along its first and last ruling."""
        return True

    def rewalked(self, points: Array, directions: Array, normals: Array, patches: tuple[Patch, ...]) -> PanelShape:
        """The same panel along other rulings, over other patches."""
        return replace(self, points=points, directions=directions, normals=normals, patches=patches)

    def trimmed(self, cut_points: Array, cut_normals: Array, side_leans: Array) -> PanelShape:
        """The same walk between other cuts and side walls."""
        return replace(self, cut_points=cut_points, cut_normals=cut_normals, side_leans=side_leans)

    def walled(self, side: int, plane: CutPlane | None) -> PanelShape:
        """The same with a side in another plane, or, with None, along its ruling."""
        first, last = self.side_planes
        return replace(self, side_planes=(first, plane) if side else (plane, last))

    def made_square(self) -> PanelShape:
        """The same skin, with walls square to its sheet."""
        return replace(self, square=True, side_leans=np.zeros(2))

    def edge(self, edge: str) -> PanelEdge:
        """See `Panel.edge`; a side is straight unless it stands in a plane, an end is where all patches are flat."""
        corners = edge_corners(self.corners(), edge)
        place = int(edge[-1])
        outward = 1.0 if place else -1.0
        if edge.startswith("end"):
            flat = all(isinstance(patch, PlanePatch) for patch in self.patches)
            normal = self.normals[0] if flat else None
            return PanelEdge(corners=corners, outward=outward * self.cut_normals[place], normal=normal)
        plane = self.side_planes[place]
        if plane is not None:
            return PanelEdge(corners=corners, outward=plane.normal, normal=None)
        return PanelEdge(corners=corners, outward=outward * self.binormals()[-place], normal=self.normals[-place])

    def arcs(self) -> CurvePieces:
        """See `Panel.arcs`: where planes meet the cones; a side's arc is told by the two tangents that it lies within.

        Raises:
            ValueError: the skin is the other face of a square sheet, and bends in no arcs of ellipses.
        """
        if self.lift != 0.0:
            raise ValueError(f"panel '{self.name}': the other face of a square sheet ends in no arcs of ellipses")
        ends = chain_arcs(self.rulings(), self.patches, self.cuts(), end_spans(self))
        return together([ends, *(side_tangents(curve) for curve in side_curves(self) if curve is not None)])

    def cut_back(self, planes: Mapping[str, CutPlane], depth: float) -> PanelShape:
        """See `Panel.cut_back`; the side of a round patch keeps behind its plane, and square to the sheet."""
        return cut_chain(self, planes, depth)

    def squared(self, depth: float) -> PanelShape:
        """See `Panel.squared`; an end, or a side in a plane, stays in one, back by what its walls lean in at most."""
        return square_chain(self, depth)

    def area(self) -> float:
        """Area of the trimmed skin, mm2. The shape must be buildable."""
        return float(sum(patch_areas(self)))

    def straightened(self, smallest_half_angle: float = SMALLEST_HALF_ANGLE) -> Straightened[PanelShape]:
        """The panel as it is built: a cone of at most `smallest_half_angle` is the cylinder that it has halfway."""
        return straighten(self, smallest_half_angle)

    def check(self) -> None:
        """See `Panel.check`; refused are the faults that `check_chain` lists."""
        check_chain(self)

    def check_sheet(self, away: PanelShape, thickness: float) -> None:
        """See `Panel.check_sheet`; refused is a sheet thicker than its inner radius allows, too."""
        check_chain_sheet(self, away, thickness)


@dataclass(frozen=True, slots=True, kw_only=True)
class PolygonShape:
    """A flat panel with any number of corners.

    Attributes:
        name: the panel's stable name.
        feature: name of the shape feature.
        outline: (n, 3) corners, counterclockwise about the normal, in one plane, mm.
        normal: (3,) unit normal, OUTWARD.
        posts: (n, 3) by how much each corner moves for one mm along the normal, as the walls lean; None where all
            walls stand square to the sheet.
        square: whether they were asked to.
    """

    name: str
    feature: str
    outline: Array
    normal: Array
    posts: Array | None = None
    square: bool = False

    def __repr__(self) -> str:
        return f"<PolygonShape '{self.name}': {self.feature}, {len(self.outline)} corners>"

    @property
    def patches(self) -> tuple[Patch, ...]:
        """Its one plane."""
        return (PlanePatch(),)

    def corners(self) -> Array:
        """(1, n, 3) the outline as one row, mm."""
        return self.outline[None]

    def rulings(self) -> tuple[Array, Array, Array]:
        """Its first edge on its plane: point, direction and normal, (1, 3) each."""
        return self.outline[:1], unit(self.outline[1:2] - self.outline[:1]), self.normal[None]

    def cuts(self) -> tuple[Array, Array]:
        """None: its edges lie square on it."""
        return np.empty((0, 3)), np.empty((0, 3))

    def offset(self, distance: float) -> PolygonShape:
        """The parallel panel at `distance` mm along the normal (negative: inwards)."""
        ways = self.normal if self.posts is None else self.posts
        return replace(self, outline=self.outline + distance * ways)

    def edge(self, edge: str) -> PanelEdge:
        """See `Panel.edge`: all are straight."""
        corners = edge_corners(self.corners(), edge)
        return PanelEdge(corners=corners, outward=unit(cross(corners[1] - corners[0], self.normal)), normal=self.normal)

    def arcs(self) -> CurvePieces:
        """None."""
        return segments(np.empty((0, 3)), np.empty((0, 3)))

    def cut_back(self, planes: Mapping[str, CutPlane], depth: float) -> PolygonShape:
        """See `Panel.cut_back`."""
        outline, posts = cut_polygon(self, planes, depth)
        return replace(self, outline=outline, posts=posts)

    def squared(self, depth: float) -> PolygonShape:
        """See `Panel.squared`; its edges keep their directions."""
        return replace(self, outline=square_polygon(self, self.posts, depth), posts=None, square=True)

    @property
    def four_sided(self) -> bool:
        """Its edges are alike: none is an end or a side."""
        return False

    def area(self) -> float:
        """Area inside the outline, mm2."""
        return polygon_area(self)

    def straightened(self) -> Straightened[PolygonShape]:
        """The panel itself: it has no cones."""
        return Straightened(shape=self, patches=(), largest_move=0.0)

    def check(self) -> None:
        """See `Panel.check`; refused are the faults that `check_polygon` lists."""
        check_polygon(self)

    def check_sheet(self, away: PolygonShape, thickness: float) -> None:
        """See `Panel.check_sheet`; a flat sheet may have any thickness."""


def edge_corners(corners: Array, edge: str) -> Array:
    """(m, 3) the corners along one edge of a panel, in its order.

    Args:
        corners: in rows, as shapes give them: (2, k + 1, 3) along both ends, or (1, n, 3) round a polygon.
        edge: "end 0", "end 1", "side 0" or "side 1"; of a polygon "edge 0" to "edge n - 1".

    Raises:
        ValueError: the panel has no such edge.
    """
    what, _, number = edge.partition(" ")
    if number.isdecimal():
        place = int(number)
        if what == "end" and len(corners) == 2 and place < 2:
            return np.asarray(corners[place])
        if what == "side" and len(corners) == 2 and place < 2:
            return np.asarray(corners[:, -place])
        if what == "edge" and len(corners) == 1 and place < corners.shape[1]:
            return np.asarray(corners[0, [place, (place + 1) % corners.shape[1]]])
    raise ValueError(f"a panel with corners {corners.shape} has no edge '{edge}'")
