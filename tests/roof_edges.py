"""The lips of fixtures/lips.py as one strip of three faces each, to be cut into panels."""

from __future__ import annotations

from OCP.TopoDS import TopoDS_Face

from cadpanel.arrays import Array
from fixtures.lips import BLEND, LOWER, UPPER, Lip
from tests.reference_shapes import kernel_face

CURVED = Lip(panels=9, twist=(2.0, 2.0), plan=(6.0, 6.0), rise=(3.0, 3.0))
"""A lip that twists and bends both ways: its flanges want seams that lean by 32 and 10 degrees."""


def roof_edge(lip: Lip = CURVED, poles: int = 48) -> list[TopoDS_Face]:
    """The three faces, from end to end."""

    def face(part: int) -> TopoDS_Face:
        def surface(u: Array, v: Array) -> Array:
            return lip.points(v[0] * lip.panels, part, u[:, 0]).transpose(1, 0, 2)

        return kernel_face(surface, (0.0, 1.0), poles=poles)

    return [face(part) for part in (LOWER, BLEND, UPPER)]
