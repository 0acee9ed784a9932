"""The faces of a sheet by what they are, as those who build it hand them on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from OCP.TopoDS import TopoDS_Face


class SheetFaces(NamedTuple):
    """The faces of a skin and of the sheet on it.

    Attributes:
        skin: of the skin, one a patch, normals outwards from the building; the same faces are among those of the sheet.
        near: the sheet's on the skin, patch by patch, normals out of the sheet.
        far: its other face's, likewise.
        walls: all others.
    """

    skin: Sequence[TopoDS_Face]
    near: Sequence[TopoDS_Face]
    far: Sequence[TopoDS_Face]
    walls: Sequence[TopoDS_Face]
