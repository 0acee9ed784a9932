"""Curves and meshes over the strip of `tests.model_files`, by its parameters."""

import numpy as np

from tests.drawn import POINTS, curve
from tests.model_files import STRIP


def across(v, lift=0.0, start=0.0, stop=3.0):
    u = np.linspace(start, stop, POINTS)
    return curve(STRIP(u, np.full(POINTS, v)) + np.array([0.0, 0.0, lift]))


def along(u, start=0.0, stop=1.0):
    return curve(STRIP(np.full(POINTS, u), np.linspace(start, stop, POINTS)))


def quads(rows, columns, move=lambda u, v: (u, v)):
    """The corners of a grid over the strip's parameters, and its faces."""
    places = [(3.0 * r / rows, c / columns) for r in range(rows + 1) for c in range(columns + 1)]
    corners = np.array([STRIP(np.array(u), np.array(v)) for u, v in (move(*place) for place in places)])
    width = columns + 1
    faces = [
        (r * width + c, r * width + c + 1, (r + 1) * width + c + 1, (r + 1) * width + c)
        for r in range(rows)
        for c in range(columns)
    ]
    return corners, faces


def write_mesh(path, corners, faces):
    if path.suffix == ".off":
        rows = [" ".join(map(repr, corner)) for corner in corners.tolist()]
        rows += [" ".join(map(str, (len(face), *face))) for face in faces]
        path.write_text(f"OFF\n{len(corners)} {len(faces)} 0\n" + "\n".join(rows) + "\n")
    else:
        rows = ["v " + " ".join(map(repr, corner)) for corner in corners.tolist()]
        rows += ["f " + " ".join(f"{corner + 1}//1" for corner in face) for face in faces]
        path.write_text("# panels\n" + "\n".join(rows) + "\n")
    return path
