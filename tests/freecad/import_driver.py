"""Runs inside FreeCAD: imports one STEP file and tells what FreeCAD makes of it."""

import os
from typing import Any


def describe(thing: Any) -> dict[str, Any]:
    """One object of the document, in the document's coordinates."""
    shape = thing.Shape.copy()
    shape.Placement = thing.getGlobalPlacement()
    box = shape.BoundBox
    return {
        "label": thing.Label,
        "shape_type": shape.ShapeType,
        "solids": len(shape.Solids),
        "valid": shape.isValid(),
        "closed": all(shell.isClosed() for shell in shape.Shells),
        "volume": shape.Volume,
        "area": shape.Area,
        "face_types": [type(face.Surface).__name__ for face in shape.Faces],
        "bounding_box": [[box.XMin, box.YMin, box.ZMin], [box.XMax, box.YMax, box.ZMax]],
    }


def import_step(path: str) -> list[dict[str, Any]]:
    """Every object with a shape of its own, in the order of the file."""
    import FreeCAD
    import Import

    document = FreeCAD.newDocument("imported")
    # Given the document itself, or left to merge, an assembly crashes the program where there is no window.
    Import.insert(path, document.Name, merge=False)
    document.recompute()
    return [describe(thing) for thing in document.Objects if thing.isDerivedFrom("Part::Feature")]


def answer() -> dict[str, Any]:
    """The objects of the file that the environment names."""
    return {"objects": import_step(os.environ["CADPANEL_STEP_FILE"])}
