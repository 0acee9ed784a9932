"""Panels as the objects of cadquery and build123d, which share the kernel's shapes: nothing is copied or converted.

Both packages take seconds to import, so each function imports its own.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from OCP.TopoDS import TopoDS_Shape

if TYPE_CHECKING:
    import build123d
    import cadquery


def to_cadquery_shape(shape: TopoDS_Shape) -> cadquery.Shape:
    """A cadquery Solid or Shell, as the shape is."""
    import cadquery

    return cadquery.Shape.cast(shape)


def to_workplane(shape: TopoDS_Shape) -> cadquery.Workplane:
    """A cadquery Workplane with the shape on its stack, ready for fillets, holes and selectors."""
    import cadquery

    return cadquery.Workplane("XY").newObject([cadquery.Shape.cast(shape)])


def to_build123d_part(solid: TopoDS_Shape, name: str = "") -> build123d.Part:
    """A build123d Part around one solid, labelled with the panel's name."""
    import build123d

    part = build123d.Part([build123d.Solid(solid)])
    part.label = name
    return part


def to_build123d_compound(solids: Iterable[tuple[str, TopoDS_Shape]], name: str = "") -> build123d.Compound:
    """A build123d Compound of named solids, one child a panel."""
    import build123d

    children = []
    for panel_name, shape in solids:
        solid = build123d.Solid(shape)
        solid.label = panel_name
        children.append(solid)
    return build123d.Compound(label=name, children=children)
