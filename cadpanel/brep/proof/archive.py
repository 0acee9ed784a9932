"""Archives that keep shapes, as FreeCAD's documents do: read through the kernel and measured."""

from __future__ import annotations

import zlib
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from OCP.TopAbs import TopAbs_EDGE, TopAbs_SOLID
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cadpanel.brep.building.mass_properties import areas_and_centroids
from cadpanel.brep.building.sheet import volume_of
from cadpanel.brep.kernel.kept import kept_shape
from cadpanel.brep.kernel.shapes import faces_of, shapes_of
from cadpanel.brep.proof.inspection import vertices_of
from cadpanel.brep.proof.kept_facts import KeptFacts
from cadpanel.brep.proof.loft_facts import close_area
from cadpanel.brep.proof.shown import has_triangles, shown_fault
from cadpanel.errors import DeliveryError

SHAPE_ENDING = ".bin"


def kept_facts(path: Path) -> dict[str, KeptFacts]:
    """Facts of every shape in an archive, by the names of their files.

    Raises:
        DeliveryError: it cannot be read, or a shape in it is none.
    """
    return {name: _measured(shape) for name, shape in _shapes(path).items()}


def kept_areas(path: Path) -> dict[str, float]:
    """Areas in mm2 of every shape in an archive, integrated as closely as those of a loft's STEP file.

    Raises:
        DeliveryError: it cannot be read, or a shape in it is none.
    """
    return {name: close_area(shape) for name, shape in _shapes(path).items()}


def _shapes(path: Path) -> dict[str, TopoDS_Shape]:
    try:
        with ZipFile(path) as archive:
            kept = {name: archive.read(name) for name in archive.namelist() if name.endswith(SHAPE_ENDING)}
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except (BadZipFile, zlib.error) as error:
        raise DeliveryError(f"'{path}' cannot be read: it is damaged ({error}); write the delivery again.") from error
    found = {name: kept_shape(data) for name, data in kept.items()}
    for name, shape in found.items():
        if shape.IsNull():
            raise DeliveryError(
                f"'{path}' cannot be read: the shape '{name}' in it is damaged; write the delivery again."
            )
    return found


def _measured(shape: TopoDS_Shape) -> KeptFacts:
    solids = len(shapes_of(shape, TopAbs_SOLID))
    faces, triangles = faces_of(shape), has_triangles(shape)
    return KeptFacts(
        solids=solids,
        faces=len(faces),
        edges=_edges(shape),
        volume=volume_of(shape) if solids else 0.0,
        area=0.0 if solids else float(areas_and_centroids(faces)[0].sum()),
        vertices=vertices_of(shape),
        triangles=triangles,
        triangles_fault=shown_fault(shape) if triangles else "",
    )


def _edges(shape: TopoDS_Shape) -> int:
    known = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_EDGE, known)
    return int(known.Extent())
