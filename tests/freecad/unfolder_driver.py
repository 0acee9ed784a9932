"""Runs inside FreeCAD: unfolds every shell of one STEP file with flatmesh and tells the nodes of its mesh."""

import os
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


def answer() -> dict[str, Any]:
    """The shells of the file that the environment names."""
    return {"shells": unfold(os.environ["CADPANEL_STEP_FILE"])}
