"""Shells and solids of exact planes, cones and cylinders as STEP entities, digit for digit.

Edges on cones and cylinders carry their parameter curves: left to itself, the kernel's reader lays curves that are off
by 1e-4 mm. On planes it needs none.
"""

from __future__ import annotations

import math

from OCP.BRep import BRep_Tool
from OCP.Geom import (
    Geom_BSplineCurve,
    Geom_BSplineSurface,
    Geom_Circle,
    Geom_ConicalSurface,
    Geom_Curve,
    Geom_CylindricalSurface,
    Geom_Ellipse,
    Geom_Line,
    Geom_Plane,
    Geom_Surface,
)
from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_Curve, Geom2d_Line
from OCP.gp import gp_Dir, gp_Pnt
from OCP.TopAbs import TopAbs_REVERSED, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Vertex
from OCP.TopTools import TopTools_IndexedMapOfShape

from cadpanel.brep.kernel.shapes import children
from cadpanel.brep.step.text import StepText, real, references


class UnsupportedGeometry(ValueError):
    """A shape holds something else than lines, circles, ellipses, planes, cones, cylinders and plain splines."""


class TopologyWriter:
    """Writes one shape's faces, edges and vertices, each once."""

    def __init__(self, text: StepText) -> None:
        self._text = text
        self._map = TopTools_IndexedMapOfShape()
        self._ids: dict[int, int] = {}
        self._curved: dict[int, list[tuple[TopoDS_Face, int]]] = {}
        self._parameter_planes: dict[int, int] = {}
        text.forget()

    def item(self, shape: TopoDS_Shape) -> int:
        """A solid as MANIFOLD_SOLID_BREP, an open shell as SHELL_BASED_SURFACE_MODEL."""
        shells = list(children(shape, oriented=False)) if shape.ShapeType() == TopAbs_SOLID else [shape]
        if len(shells) != 1 or shells[0].ShapeType() != TopAbs_SHELL:
            raise UnsupportedGeometry("neither a solid with one shell nor a shell")
        found = [TopoDS.Face_s(face) for face in children(shells[0], oriented=False)]
        surfaces = [self._surface(face) for face in found]
        faces = references([self._face(face, surface) for face, surface in zip(found, surfaces, strict=True)])
        if shape.ShapeType() == TopAbs_SOLID:
            shell = self._text.add(f"CLOSED_SHELL('',{faces})")
            return self._text.add(f"MANIFOLD_SOLID_BREP('',#{shell})")
        shell = self._text.add(f"OPEN_SHELL('',{faces})")
        return self._text.add(f"SHELL_BASED_SURFACE_MODEL('',(#{shell}))")

    def _face(self, face: TopoDS_Face, surface: int) -> int:
        reversed_face = face.Orientation() == TopAbs_REVERSED
        bounds: list[int] = []
        for wire in children(face, oriented=False):
            # The bound turns about the face's normal, not the surface's: compose face and wire.
            turned = reversed_face != (wire.Orientation() == TopAbs_REVERSED)
            loop = list(children(wire, oriented=False))
            oriented = []
            for child in reversed(loop) if turned else loop:
                edge = TopoDS.Edge_s(child)
                forward = (edge.Orientation() == TopAbs_REVERSED) == turned
                number = self._edge(edge)
                oriented.append(self._text.add(f"ORIENTED_EDGE('',*,*,#{number},{_flag(forward)})"))
            edge_loop = self._text.add(f"EDGE_LOOP('',{references(oriented)})")
            kind = "FACE_BOUND" if bounds else "FACE_OUTER_BOUND"  # holes come behind the outline
            bounds.append(self._text.add(f"{kind}('',#{edge_loop},.T.)"))
        return self._text.add(f"ADVANCED_FACE('',{references(bounds)},#{surface},{_flag(not reversed_face)})")

    def _surface(self, face: TopoDS_Face) -> int:
        """The surface's number; a curved one is noted for every edge of the face."""
        surface = BRep_Tool.Surface_s(face)
        number = self._surface_itself(surface)
        if isinstance(surface, Geom_Plane):
            return number
        self._parameter_planes[number] = self._text.add(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()"
            "REPRESENTATION_CONTEXT('2D SPACE',''))"
        )
        for wire in children(face, oriented=False):
            for edge in children(wire, oriented=False):
                self._curved.setdefault(self._map.Add(edge), []).append((face, number))
        return number

    def _surface_itself(self, surface: Geom_Surface) -> int:
        if isinstance(surface, Geom_BSplineSurface):
            return self._spline_surface(surface)
        if not isinstance(surface, (Geom_Plane, Geom_ConicalSurface, Geom_CylindricalSurface)):
            raise UnsupportedGeometry(f"a face on a {type(surface).__name__}")
        axes = surface.Position()
        placement = self._placement(axes.Location(), axes.Direction(), axes.XDirection())
        if isinstance(surface, Geom_Plane):
            return self._text.add(f"PLANE('',#{placement})")
        if isinstance(surface, Geom_CylindricalSurface):
            return self._text.add(f"CYLINDRICAL_SURFACE('',#{placement},{real(surface.Radius())})")
        radius, half_angle = real(surface.RefRadius()), real(surface.SemiAngle())
        return self._text.add(f"CONICAL_SURFACE('',#{placement},{radius},{half_angle})")

    def _spline_surface(self, surface: Geom_BSplineSurface) -> int:
        """A surface of poles without weights that closes nowhere."""
        if surface.IsURational() or surface.IsVRational() or surface.IsUPeriodic() or surface.IsVPeriodic():
            raise UnsupportedGeometry("a face on a spline surface with weights, or that closes")
        rows = [
            references([self._point(surface.Pole(u, v)) for v in range(1, surface.NbVPoles() + 1)])
            for u in range(1, surface.NbUPoles() + 1)
        ]
        counts = [
            f"({','.join(str(of(index)) for index in range(1, number + 1))})"
            for of, number in (
                (surface.UMultiplicity, surface.NbUKnots()),
                (surface.VMultiplicity, surface.NbVKnots()),
            )
        ]
        knots = [
            f"({','.join(real(of(index)) for index in range(1, number + 1))})"
            for of, number in ((surface.UKnot, surface.NbUKnots()), (surface.VKnot, surface.NbVKnots()))
        ]
        grid = ",\n".join(rows)
        return self._text.add(
            f"B_SPLINE_SURFACE_WITH_KNOTS('',{surface.UDegree()},{surface.VDegree()},({grid}),.UNSPECIFIED.,.F.,.F.,.F.,"
            f"{counts[0]},{counts[1]},{knots[0]},{knots[1]},.UNSPECIFIED.)"
        )

    def _edge(self, edge: TopoDS_Edge) -> int:
        index = self._map.Add(edge)
        known = self._ids.get(index)
        if known is not None:
            return known
        number = self._curve(BRep_Tool.Curve_s(edge, 0.0, 0.0))
        pcurves = [self._parameter_curve(edge, face, surface) for face, surface in self._curved.get(index, ())]
        if pcurves:
            number = self._text.add(f"SURFACE_CURVE('',#{number},{references(pcurves)},.CURVE_3D.)")
        first = self._vertex(TopExp.FirstVertex_s(edge))
        last = self._vertex(TopExp.LastVertex_s(edge))
        self._ids[index] = self._text.add(f"EDGE_CURVE('',#{first},#{last},#{number},.T.)")
        return self._ids[index]

    def _curve(self, curve: Geom_Curve) -> int:
        if isinstance(curve, Geom_Line):
            axis = curve.Position()
            start = self._point(axis.Location())
            vector = self._text.add(f"VECTOR('',#{self._direction(axis.Direction())},1.)")
            return self._text.add(f"LINE('',#{start},#{vector})")
        if isinstance(curve, Geom_Ellipse):
            axes = curve.Position()
            placement = self._placement(axes.Location(), axes.Direction(), axes.XDirection())
            return self._text.add(f"ELLIPSE('',#{placement},{real(curve.MajorRadius())},{real(curve.MinorRadius())})")
        if isinstance(curve, Geom_Circle):
            axes = curve.Position()
            placement = self._placement(axes.Location(), axes.Direction(), axes.XDirection())
            return self._text.add(f"CIRCLE('',#{placement},{real(curve.Radius())})")
        if isinstance(curve, Geom_BSplineCurve) and not (curve.IsRational() or curve.IsPeriodic()):
            return self._spline(curve, [self._point(curve.Pole(index)) for index in range(1, curve.NbPoles() + 1)])
        raise UnsupportedGeometry(f"an edge on a {type(curve).__name__}")

    def _parameter_curve(self, edge: TopoDS_Edge, face: TopoDS_Face, surface: int) -> int:
        curve = self._flat_curve(BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0), _axial_share(face))
        context = self._parameter_planes[surface]
        definition = self._text.add(f"DEFINITIONAL_REPRESENTATION('',(#{curve}),#{context})")
        return self._text.add(f"PCURVE('',#{surface},#{definition})")

    def _flat_curve(self, curve: Geom2d_Curve | None, share: float) -> int:
        """A line or spline of a surface's parameter plane, its second coordinate times `share`."""
        if isinstance(curve, Geom2d_Line):
            start, toward = curve.Location(), curve.Direction()
            point = self._text.shared("CARTESIAN_POINT", (start.X(), share * start.Y()))
            direction = self._text.shared("DIRECTION", (toward.X(), toward.Y()))
            vector = self._text.add(f"VECTOR('',#{direction},1.)")
            return self._text.add(f"LINE('',#{point},#{vector})")
        if not isinstance(curve, Geom2d_BSplineCurve):
            raise UnsupportedGeometry("an edge on a cone without its exact parameter curve")
        poles = [curve.Pole(index) for index in range(1, curve.NbPoles() + 1)]
        return self._spline(
            curve, [self._text.shared("CARTESIAN_POINT", (pole.X(), share * pole.Y())) for pole in poles]
        )

    def _spline(self, curve: Geom_BSplineCurve | Geom2d_BSplineCurve, points: list[int]) -> int:
        knots = range(1, curve.NbKnots() + 1)
        multiplicities = ",".join(str(curve.Multiplicity(index)) for index in knots)
        values = ",".join(real(curve.Knot(index)) for index in knots)
        return self._text.add(
            f"B_SPLINE_CURVE_WITH_KNOTS('',{curve.Degree()},{references(points)},.UNSPECIFIED.,.F.,.F.,({multiplicities}),"
            f"({values}),.UNSPECIFIED.)"
        )

    def _vertex(self, vertex: TopoDS_Vertex) -> int:
        index = self._map.Add(vertex)
        if index not in self._ids:
            self._ids[index] = self._text.add(f"VERTEX_POINT('',#{self._point(BRep_Tool.Pnt_s(vertex))})")
        return self._ids[index]

    def _placement(self, origin: gp_Pnt, z_axis: gp_Dir, x_axis: gp_Dir) -> int:
        ids = self._point(origin), self._direction(z_axis), self._direction(x_axis)
        return self._text.add("AXIS2_PLACEMENT_3D('',#{},#{},#{})".format(*ids))

    def _point(self, point: gp_Pnt) -> int:
        return self._text.shared("CARTESIAN_POINT", (point.X(), point.Y(), point.Z()))

    def _direction(self, direction: gp_Dir) -> int:
        return self._text.shared("DIRECTION", (direction.X(), direction.Y(), direction.Z()))


def _axial_share(face: TopoDS_Face) -> float:
    """A cone's second parameter is counted along the axis in STEP, along the generatrix in the kernel."""
    surface = BRep_Tool.Surface_s(face)
    return math.cos(surface.SemiAngle()) if isinstance(surface, Geom_ConicalSurface) else 1.0


def _flag(value: bool) -> str:
    return ".T." if value else ".F."
