"""Corners and faces from the text of an OBJ or OFF file."""

from __future__ import annotations

import re
from collections.abc import Sequence

# The letters before it say what stands in a corner's line after its coordinates: texture, colour, normal.
OFF = re.compile(r"(ST)?C?N?OFF", re.IGNORECASE)
COORDINATES = 3

Corners = list[list[float]]
Faces = list[tuple[int, ...]]
Rows = Sequence[Sequence[str]]


def corners_and_faces(text: str) -> tuple[Corners, Faces]:
    """The coordinates of each corner, and for each face the indices of its corners in order round it.

    A number in the text that stands for no corner comes out as an index below 0, or beyond the last.

    Raises:
        ValueError: the text breaks off, or what should be a number is none.
    """
    # Comments go first: one may end with the backslash that elsewhere joins a line to the next.
    bare = "\n".join(line.split("#", 1)[0].rstrip() for line in text.splitlines()).replace("\\\n", " ")
    rows = [line.split() for line in bare.splitlines() if line.strip()]
    corners, faces = _off(rows) if rows and OFF.fullmatch(rows[0][0]) else _obj(rows)
    if any(len(corner) != COORDINATES for corner in corners):
        raise ValueError("a corner has fewer than three coordinates")
    return corners, faces


def _obj(rows: Rows) -> tuple[Corners, Faces]:
    corners: Corners = []
    faces: Faces = []
    for word, *others in rows:
        if word == "v":
            corners.append([float(number) for number in others[:COORDINATES]])
        elif word == "f":
            # They count from 1, or back from the last corner so far; there is no corner 0.
            numbers = [int(corner.split("/", 1)[0]) for corner in others]
            faces.append(tuple(number - 1 if number >= 0 else len(corners) + number for number in numbers))
    return corners, faces


def _off(rows: Rows) -> tuple[Corners, Faces]:
    # The counts may share the header's line.
    rows = [row for row in (rows[0][1:], *rows[1:]) if row]
    if not rows or len(rows[0]) < 2:
        raise ValueError("it does not say how many corners and faces it has")
    count, face_count = int(rows[0][0]), int(rows[0][1])
    if count < 0 or face_count < 0 or 1 + count + face_count > len(rows):
        raise ValueError("it breaks off before its last corner or face")
    corners = [[float(word) for word in row[:COORDINATES]] for row in rows[1 : 1 + count]]
    faces: Faces = []
    for row in rows[1 + count : 1 + count + face_count]:  # they may end with a colour
        size = int(row[0])
        faces.append(tuple(int(word) for word in row[1 : 1 + size]))
        if len(faces[-1]) != size:
            raise ValueError("a face has fewer corners than it says")
    return corners, faces
