"""Runs inside FreeCAD, with or without a window: opens a document and tells what FreeCAD makes of it.

With a window it looks at the colours on the screen, too.
"""

import os
from collections import Counter
from pathlib import Path
from typing import Any

SHADES = 32
"""Of every primary colour, that are told apart in a picture."""


def described(thing: Any) -> dict[str, Any]:
    """One object: its place in the tree, its properties and its shape."""
    own = [name for name in thing.PropertiesList if thing.getGroupOfProperty(name) not in ("", "Base", "Spreadsheet")]
    found: dict[str, Any] = {
        "type": thing.TypeId,
        "label": thing.Label,
        "inside": [parent.Label for parent in thing.InList],
        "visible": thing.Visibility,
        "touched": "Touched" in thing.State,
        "properties": {name: [thing.getTypeIdOfProperty(name), plain(getattr(thing, name))] for name in own},
        "fixed": [name for name in own if "ReadOnly" in thing.getEditorMode(name)],
    }
    if thing.TypeId == "Part::Feature":
        shape = thing.Shape
        vertices = [list(vertex.Point) for vertex in shape.Vertexes]
        found |= {"shape": shape.ShapeType, "valid": shape.isValid(), "area": shape.Area, "vertices": vertices}
        found |= {"volume": shape.Volume, "edges": len(shape.Edges)}
    if thing.TypeId == "Spreadsheet::Sheet":
        found["cells"] = {cell: thing.get(cell) for cell in ("A1", "B2", "E2")}
    return found


def plain(value: Any) -> Any:
    """A property's value as JSON knows it: of a quantity the number in FreeCAD's own units."""
    if hasattr(value, "Value"):
        return value.Value
    return list(value) if type(value).__name__ == "Vector" else value


def seen(document: Any) -> dict[str, Any]:
    """What stands on the screen as it was opened: colours of panels, and how often those of a picture occur."""
    import FreeCADGui

    try:
        from PySide import QtGui
    except ImportError:
        from PySide2 import QtGui
    FreeCADGui.updateGui()
    picture = str(Path(os.environ["CADPANEL_ANSWER_FILE"]).with_suffix(".png"))
    FreeCADGui.getDocument(document.Name).activeView().saveImage(picture, 400, 300, "White")
    image = QtGui.QImage(picture)
    colors = (image.pixelColor(x, y) for x in range(image.width()) for y in range(image.height()))
    shades = Counter(tuple(part // SHADES for part in (color.red(), color.green(), color.blue())) for color in colors)
    return {
        "colors": {
            one.Label: one.ViewObject.ShapeColor[:3] for one in document.Objects if "Shape" in one.PropertiesList
        },
        "lines": {one.Label: one.ViewObject.LineColor[:3] for one in document.Objects if "Shape" in one.PropertiesList},
        "triangles": {
            one.Label: triangles_shown(one.ViewObject) for one in document.Objects if "Shape" in one.PropertiesList
        },
        "pixels": [[list(shade), count] for shade, count in shades.most_common()],
    }


def triangles_shown(view: Any) -> int:
    """How many triangles an object is shown by."""
    from pivy import coin

    search = coin.SoSearchAction()
    search.setType(coin.SoType.fromName("SoBrepFaceSet"))
    search.setSearchingAll(True)
    search.apply(view.RootNode)  # which FreeCAD 1.0 only gives to those who know pivy
    return int(search.getPath().getTail().getField("coordIndex").getNum()) // 4


def answer() -> dict[str, Any]:
    """What is in the document that the environment names."""
    import FreeCAD

    document = FreeCAD.openDocument(os.environ["CADPANEL_DOCUMENT"])
    found: dict[str, Any] = {"objects": [described(thing) for thing in document.Objects]}
    if FreeCAD.GuiUp:
        found["screen"] = seen(document)
    found["recomputed"] = document.recompute()
    return found
