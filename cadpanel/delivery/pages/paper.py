"""A page of a drawing: lines, areas and words in millimetres from its lower left corner, A3 landscape."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from reportlab.pdfgen.canvas import Canvas

from cadpanel.arrays import Array
from cadpanel.delivery.pages.fonts import load_fonts, runs, width_in_points

WIDTH, HEIGHT = 420.0, 297.0
MARGIN = 10.0
POINT = 72.0 / 25.4
"""Points of a printer in a millimetre."""
SCALES = (1, 2, 5, 10, 15, 20, 25, 50, 100, 200, 500, 1000)
Anchor = Literal["left", "middle", "right"]
Grey = float


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """A rectangle on a page, mm."""

    left: float
    bottom: float
    width: float
    height: float

    @property
    def middle(self) -> Array:
        """(2,) its middle."""
        return np.array([self.left + 0.5 * self.width, self.bottom + 0.5 * self.height])


def width_of(words: str, height: float, *, bold: bool = False) -> float:
    """How long words are on paper, mm."""
    return width_in_points(words, height * POINT, bold=bold) / POINT


def standard_scale(size: Array, box: Box) -> float:
    """One over the first of SCALES at which a size (2,) fits a box; smaller ones in whole thousands."""
    needed = max(float(size[0]) / box.width, float(size[1]) / box.height)
    fitting = [scale for scale in SCALES if scale >= needed * (1.0 - 1e-9)]
    return 1.0 / (fitting[0] if fitting else 1000 * math.ceil(needed / 1000.0 - 1e-9))


class Paper:
    """Pages, one after the other."""

    def __init__(self, title: str, author: str) -> None:
        """Begin with an empty page; the file's time is the present, or that of SOURCE_DATE_EPOCH."""
        load_fonts()
        self._stream = io.BytesIO()
        self._canvas = Canvas(self._stream, pagesize=(WIDTH * POINT, HEIGHT * POINT), pageCompression=1)
        self._canvas.setTitle(title)
        self._canvas.setAuthor(author)
        self._canvas.setCreator("cadpanel")
        self._canvas.setProducer("cadpanel")

    def turn(self) -> None:
        """Go on to the next page."""
        self._canvas.showPage()

    def data(self) -> bytes:
        """The whole file."""
        self._canvas.save()
        return self._stream.getvalue()

    def lines(self, points: Array, *, width: float = 0.18, grey: Grey = 0.0, dashed: bool = False) -> None:
        """A chain of lines through points (n, 2)."""
        self._draw(points, close=False, width=width, grey=grey, dashed=dashed)

    def contour(self, points: Array, *, width: float = 0.35, fill: tuple[float, float, float] | None = None) -> None:
        """A closed chain of lines through points (n, 2), filled if a colour is given."""
        self._draw(points, close=True, width=width, fill=fill)

    def circle(self, middle: Array, radius: float, *, width: float = 0.18) -> None:
        """A circle about a point (2,)."""
        self._canvas.setLineWidth(width * POINT)
        self._canvas.setDash([])
        self._canvas.setStrokeGray(0.0)
        self._canvas.circle(float(middle[0]) * POINT, float(middle[1]) * POINT, radius * POINT, stroke=1, fill=0)

    def area(self, points: Array, colour: tuple[float, float, float]) -> None:
        """A filled area with points (n, 2) round it, and a hair more, so that neighbours leave no gap."""
        self._draw(points, close=True, width=0.15, fill=colour, stroke=colour)

    def words(
        self,
        words: str,
        place: Sequence[float] | Array,
        height: float = 2.5,
        *,
        anchor: Anchor = "left",
        angle: float = 0.0,
        bold: bool = False,
        halo: bool = False,
    ) -> None:
        """A line of words at the foot of its letters, turned by an angle in radians; on white if there is a halo."""
        canvas = self._canvas
        back = {"left": 0.0, "middle": 0.5, "right": 1.0}[anchor] * width_of(words, height, bold=bold)
        canvas.saveState()
        canvas.translate(float(place[0]) * POINT, float(place[1]) * POINT)
        canvas.rotate(math.degrees(angle))
        if halo:
            canvas.setFillGray(1.0)
            long = width_of(words, height, bold=bold)
            canvas.rect(
                -(back + 0.3) * POINT, -0.4 * POINT, (long + 0.6) * POINT, (height + 0.4) * POINT, stroke=0, fill=1
            )
        canvas.setFillGray(0.0)
        text = canvas.beginText(-back * POINT, 0.0)
        for font, signs in runs(words, bold=bold):
            text.setFont(font, height * POINT)
            text.textOut(signs)
        canvas.drawText(text)
        canvas.restoreState()

    def _draw(
        self,
        points: Array,
        *,
        close: bool,
        width: float,
        grey: Grey = 0.0,
        dashed: bool = False,
        fill: tuple[float, float, float] | None = None,
        stroke: tuple[float, float, float] | None = None,
    ) -> None:
        canvas = self._canvas
        canvas.setLineWidth(width * POINT)
        canvas.setLineJoin(1)
        canvas.setDash([3.0 * POINT, 1.0 * POINT] if dashed else [])
        if stroke is None:
            canvas.setStrokeGray(grey)
        else:
            canvas.setStrokeColorRGB(*stroke)
        if fill is not None:
            canvas.setFillColorRGB(*fill)
        path = canvas.beginPath()
        for place, (x, y) in enumerate((np.asarray(points) * POINT).tolist()):
            (path.lineTo if place else path.moveTo)(x, y)
        if close:
            path.close()
        canvas.drawPath(path, stroke=1, fill=0 if fill is None else 1)
