"""The page of a fit that is not delivered, for a cell of a notebook."""

from __future__ import annotations

import html
from pathlib import Path
from typing import Any

import numpy as np

from cadpanel.delivery.page.flats import packed_flats
from cadpanel.delivery.page.html import page_bytes
from cadpanel.delivery.page.packing import packed
from cadpanel.delivery.page.scene import Scene
from cadpanel.fitting.result import FitResult
from cadpanel.geometry.unroll import unroll_all

_HEIGHT = 640


def frame_of_fit(result: FitResult, scene: Scene) -> str:
    """A frame with the whole page in it, which needs neither files nor a network."""
    title = Path(result.reference.source).stem
    flats = packed_flats(unroll_all(result.shapes, np.zeros(len(result.shapes))))
    page = page_bytes(title, fit_numbers(result, scene), {**packed(scene), "flats": flats}).decode("utf-8")
    return (
        f'<iframe title="{html.escape(title)}" srcdoc="{html.escape(page)}" sandbox="allow-scripts" '
        f'style="width: 100%; height: {_HEIGHT}px; border: 1px solid #d6dde3"></iframe>'
    )


def fit_numbers(result: FitResult, scene: Scene) -> dict[str, Any]:
    """What the page tells of a fit: that of a delivery but for what only sheets have."""
    m = result.measures
    panels = [
        {
            "name": shape.name,
            "feature": shape.feature,
            "rms": float(m.rms_deviation[place]),
            "deviation": float(m.max_deviation[place]),
            "drift": float(m.drift[place]),
            "area": shape.area(),
            "mass": None,
            "blank": None,
            "bends": [],
            "radii": [] if shown.radius is None else [[shown.radius, shown.radius]],
            "notes": [],
        }
        for place, (shape, shown) in enumerate(zip(result.shapes, scene.panels, strict=True))
    ]
    seams = [
        {
            "panels": list(shown.panels),
            "edges": [],
            "gap": float(m.seam_gap[place]),
            "width": float(m.seam_width[place]),
            "step": float(m.seam_step[place]),
            "shift": float(m.seam_shift[place]),
            "kink": float(np.degrees(m.kink[place])),
        }
        for place, shown in enumerate(scene.seams)
    ]
    return {
        "title": Path(result.reference.source).stem,
        "sheet": None,
        "summary": {"tolerance_met": result.tolerance_met},
        "panels": panels,
        "seams": seams,
    }
