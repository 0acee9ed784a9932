"""Runs inside FreeCAD: unfold every shell of one STEP file with flatmesh and write the nodes of its mesh as JSON.

As `driver.py`, it gets its two paths through the environment and writes failures to its answer.
"""

import json
import os
import traceback
from pathlib import Path
from typing import Any

CHORD = 0.05  # mm by which the mesh may lie off the shell
ITERATIONS, RELAXATION = 10, 0.95


def unfold(path: str) -> list[dict[str, Any]]:
    """Of every shell the nodes in space and in the plane, and the triangles between them."""
    import flatmesh
    import numpy as np
    import Part

    shape = Part.Shape()
    shape.read(path)
    found = []
    for shell in shape.Shells:
        points, triangles = shell.tessellate(CHORD)
        nodes = np.array([list(point) for point in points])
        unwrapper = flatmesh.FaceUnwrapper(nodes, np.array(triangles))
        unwrapper.findFlatNodes(ITERATIONS, RELAXATION)
        flat = np.array(unwrapper.ze_nodes)
        found.append({"nodes": nodes.tolist(), "flat": flat.tolist(), "triangles": triangles})
    return found


def main() -> None:
    """Unfold the file named in the environment and leave at once: FreeCAD would wait for commands."""
    try:
        answer: dict[str, Any] = {"shells": unfold(os.environ["CADPANEL_STEP_FILE"])}
    except Exception:  # noqa: BLE001 - FreeCAD would swallow it; the test shall see it
        answer = {"error": traceback.format_exc()}
    Path(os.environ["CADPANEL_ANSWER_FILE"]).write_text(json.dumps(answer), encoding="utf-8")
    os._exit(0)


main()
