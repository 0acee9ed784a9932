"""A loft as a FreeCAD document: its surface and its flat pattern, each with what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.building.drawn import flat_face
from cadpanel.brep.kernel.kept import kept_binary
from cadpanel.brep.step.file import read_step_shapes
from cadpanel.delivery.document.archive import camera, packed
from cadpanel.delivery.document.colors import FLAT, SKIN
from cadpanel.delivery.document.objects import AnyProperty, Body, Lines, Look, Number, NumberKind
from cadpanel.delivery.document.xml import document_xml, gui_xml
from cadpanel.lofting.loft import Loft

SURFACE_FILE, FLAT_FILE = "Surface.bin", "FlatPattern.bin"
# Rulings of each piece by which the camera is set.
_SEEN = 9


def loft_bytes(loft: Loft, step: Path, contour: Array, rulings: Array) -> bytes:
    """The whole file.

    Args:
        loft: the surface.
        step: its STEP file, whose reader puts in the edges that shrink to a point at fans, without which FreeCAD finds
            the shape to be broken.
        contour: (v, 3) its flat pattern as a closed chain of arcs, starts and bulges, mm.
        rulings: (m, 2, 2) lines on it along which to roll, mm.

    Raises:
        DeliveryError: the STEP file is missing, or damaged.
        SettingsError: SOURCE_DATE_EPOCH is no number of seconds.
    """
    _, surface = read_step_shapes(step, heal=True)[0]
    objects = (
        Body(
            name="Surface",
            label=loft.name,
            look=Look(faces=SKIN),
            properties=tuple(_surface_properties(loft)),
            file=SURFACE_FILE,
        ),
        Body(
            name="FlatPattern",
            label=f"{loft.name} flat",
            look=Look(visible=False, faces=FLAT),
            properties=tuple(_flat_properties(loft)),
            file=FLAT_FILE,
        ),
    )
    seen = np.concatenate([np.concatenate(ends) for ends in loft.rulings(_SEEN)])
    shapes = (
        (SURFACE_FILE, kept_binary(surface)),
        (FLAT_FILE, kept_binary(flat_face(contour, rulings, np.empty((0, 3))))),
    )
    return packed(document_xml(loft.name, objects), gui_xml(objects, camera(seen)), shapes)


def _surface_properties(loft: Loft) -> Sequence[AnyProperty]:
    kinds = ["ruled" if face is None else face.word for face in loft.faces]
    return [
        *_numbers(
            [
                (
                    "LargestWarp",
                    "between the tangent planes of a ruling",
                    "Angle",
                    float(np.degrees(loft.max_warp)),
                ),
                ("OffRails", "farthest of its edges from the curves", "Length", loft.off),
                ("SkinArea", "of the surface", "Area", loft.flat[1].surface),
            ],
            "Loft",
        ),
        Lines(name="Faces", group="Loft", tip="what each face lies on", value=kinds),
    ]


def _flat_properties(loft: Loft) -> Sequence[AnyProperty]:
    error = loft.flat[1]
    return _numbers(
        [
            ("LengthError", "by which a line on the surface is longer or shorter at most", "Length", abs(error.length)),
            ("AreaError", "by which its area differs from the surface's", "Area", abs(error.area)),
        ],
        "Flat pattern",
    )


def _numbers(told: Sequence[tuple[str, str, NumberKind, float]], group: str) -> list[AnyProperty]:
    return [Number(name=name, group=group, tip=tip, kind=kind, value=value) for name, tip, kind, value in told]
