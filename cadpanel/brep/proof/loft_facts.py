"""What the STEP file of a loft shows when it is read back."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GeomAbs import GeomAbs_Cone, GeomAbs_Cylinder, GeomAbs_Plane
from OCP.GProp import GProp_GProps
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.kernel.shapes import faces_of
from cadpanel.brep.step.file import read_step_shapes

_KINDS = {GeomAbs_Plane: "plane", GeomAbs_Cylinder: "cylinder", GeomAbs_Cone: "cone"}
_ACCURACY = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class LoftFacts:
    """What was measured.

    Attributes:
        name: of the product.
        valid: whether the kernel's check passes.
        faces: what each face lies on; "ruled" for a spline surface.
        area: of all faces, mm2.
    """

    name: str
    valid: bool
    faces: tuple[str, ...]
    area: float


def loft_facts(path: Path) -> LoftFacts:
    """Read a loft's STEP file as other programs do: edges that shrink to a point, at fans, are put in by the reader.

    Raises:
        DeliveryError: it is missing, or damaged.
    """
    name, shape = read_step_shapes(path, heal=True)[0]
    return LoftFacts(
        name=name,
        valid=bool(BRepCheck_Analyzer(shape).IsValid()),
        faces=tuple(_KINDS.get(BRepAdaptor_Surface(face).GetType(), "ruled") for face in faces_of(shape)),
        area=close_area(shape),
    )


def close_area(shape: TopoDS_Shape) -> float:
    """The area of a shape's faces, mm2, integrated until it changes by less than a billionth."""
    measured = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, measured, _ACCURACY)
    return float(measured.Mass())
