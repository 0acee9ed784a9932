"""Runs inside FreeCAD: import one STEP file and write what FreeCAD makes of it as JSON.

`freecadcmd` opens its arguments as documents, so the two paths come through the environment. It also swallows
exceptions and exits with 0, so a failure is written to the JSON file as well.
"""

import json
import os
import traceback
from pathlib import Path
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


def main() -> None:
    """Import the file named in the environment and leave at once: FreeCAD would wait for commands."""
    try:
        answer: dict[str, Any] = {"objects": import_step(os.environ["CADPANEL_STEP_FILE"])}
    except Exception:  # noqa: BLE001 - FreeCAD would swallow it; the test shall see it
        answer = {"error": traceback.format_exc()}
    Path(os.environ["CADPANEL_ANSWER_FILE"]).write_text(json.dumps(answer), encoding="utf-8")
    os._exit(0)


main()
