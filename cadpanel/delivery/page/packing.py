"""A scene as text that a page can hold: whole numbers in 16 bits, in boxes of their own, base 64; and back again."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.page.ghosts import Ghost
from cadpanel.delivery.page.scene import PanelScene, Scene, SeamScene
from cadpanel.fitting.measures.profiles import SeamProfile

LEVELS = 65535
"""Steps between the least and the largest value of a row of numbers: 0.06 mm on 4 m."""
_ROUNDED = 4
"""Decimals of the boxes, mm and degrees."""

Packed = dict[str, Any]
"""What JSON can hold."""


def packed(scene: Scene) -> Packed:
    """A scene as JSON can hold it; panels with the same triangles share them."""
    topologies: dict[bytes, int] = {}
    panels = []
    for panel in scene.panels:
        triangles = panel.triangles.astype("<u2").tobytes()
        panels.append(
            {
                "name": panel.name,
                "feature": panel.feature,
                "radius": panel.radius,
                "topology": topologies.setdefault(triangles, len(topologies)),
                "points": _boxed(panel.points),
                "other": _boxed(panel.other),
                "deviation": _boxed(panel.deviation[:, None]),
                "ghost": _boxed(panel.ghost.points),
                "outline": panel.ghost.outline,
                "ghost_triangles": _text(panel.ghost.triangles.astype("<u2").tobytes()),
            }
        )
    return {
        "topologies": [_text(triangles) for triangles in topologies],
        "panels": panels,
        "seams": [_seam(seam) for seam in scene.seams],
    }


def unpacked(found: Packed) -> Scene:
    """The scene again, but for rounding.

    Raises:
        ValueError, KeyError, TypeError: what was found is no packed scene.
    """
    topologies = [_triangles(text) for text in found["topologies"]]
    return Scene(
        panels=tuple(
            PanelScene(
                name=panel["name"],
                feature=panel["feature"],
                radius=panel["radius"],
                points=_unboxed(panel["points"], 3),
                other=_unboxed(panel["other"], 3),
                triangles=topologies[panel["topology"]],
                deviation=_unboxed(panel["deviation"], 1)[:, 0],
                ghost=Ghost(
                    points=_unboxed(panel["ghost"], 3),
                    outline=panel["outline"],
                    triangles=_triangles(panel["ghost_triangles"]),
                ),
            )
            for panel in found["panels"]
        ),
        seams=tuple(_scene_of_seam(seam) for seam in found["seams"]),
    )


def _seam(seam: SeamScene) -> Packed:
    profile = seam.profile
    columns = [profile.along, profile.gap, profile.width, profile.step, np.degrees(profile.kink)]
    return {
        "panels": list(seam.panels),
        "points": _boxed(profile.points),
        "profile": _boxed(np.stack(columns, axis=1)),
    }


def _scene_of_seam(seam: Packed) -> SeamScene:
    first, second = seam["panels"]
    along, gap, width, step, kink = _unboxed(seam["profile"], 5).T
    profile = SeamProfile(
        points=_unboxed(seam["points"], 3), along=along, gap=gap, width=width, step=step, kink=np.radians(kink)
    )
    return SeamScene(panels=(first, second), profile=profile)


def _boxed(rows: Array) -> Packed:
    """Rows (n, c) as whole numbers of steps above the least value of each column."""
    low = np.round(rows.min(axis=0), _ROUNDED)
    step = np.maximum(rows.max(axis=0) - low, 0.0) / LEVELS
    # Steps are rounded to what JSON tells of them before they are counted with.
    step = np.array([float(f"{one:.9e}") for one in step])
    counts = np.rint((rows - low) / np.where(step > 0.0, step, 1.0)).clip(0, LEVELS)
    return {"low": low.tolist(), "step": step.tolist(), "data": _text(counts.astype("<u2").tobytes())}


def _unboxed(box: Packed, columns: int) -> Array:
    counts = np.frombuffer(base64.b64decode(box["data"], validate=True), dtype="<u2").reshape(-1, columns)
    return np.asarray(np.array(box["low"]) + counts * np.array(box["step"]))


def _triangles(text: str) -> Any:
    return np.frombuffer(base64.b64decode(text, validate=True), dtype="<u2").reshape(-1, 3).astype(np.intp)


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")
