"""What a drawing is made of: closed contours of arcs, lines, circles and single-line text, each on a layer. In mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array


@dataclass(frozen=True, slots=True)
class Contour:
    """A closed chain of arcs: (v, 3) the start of each, and its bulge."""

    layer: str
    vertices: Array

    def moved(self, shift: Array) -> Contour:
        """The same elsewhere."""
        return replace(self, vertices=self.vertices + np.append(shift, 0.0))


@dataclass(frozen=True, slots=True)
class Line:
    """A line between two points (2,)."""

    layer: str
    start: Array
    stop: Array

    def moved(self, shift: Array) -> Line:
        """The same elsewhere."""
        return replace(self, start=self.start + shift, stop=self.stop + shift)


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle about a point (2,)."""

    layer: str
    middle: Array
    radius: float

    def moved(self, shift: Array) -> Circle:
        """The same elsewhere."""
        return replace(self, middle=self.middle + shift)


@dataclass(frozen=True, slots=True)
class Text:
    """A line of text about a point (2,), or to the right of it, of a height in mm, turned by an angle in radians."""

    layer: str
    words: str
    place: Array
    height: float
    angle: float = 0.0
    left: bool = False

    def moved(self, shift: Array) -> Text:
        """The same elsewhere."""
        return replace(self, place=self.place + shift)


Entity = Contour | Line | Circle | Text
Drawing = tuple[Entity, ...]
WIDTH_OF_A_SIGN = 0.9
"""Of a text's height, about."""


def moved(drawing: Sequence[Entity], shift: Array) -> Drawing:
    """A drawing elsewhere."""
    return tuple(entity.moved(shift) for entity in drawing)


def extents(drawing: Sequence[Entity]) -> tuple[Array, Array]:
    """Lower left and upper right corner (2,) of a box about a drawing, and of its texts by about their size."""
    points: list[Array] = []
    for entity in drawing:
        if isinstance(entity, Contour):
            points.append(_reach(entity.vertices))
        elif isinstance(entity, Line):
            points.append(np.stack([entity.start, entity.stop]))
        elif isinstance(entity, Circle):
            points.append(np.stack([entity.middle - entity.radius, entity.middle + entity.radius]))
        else:
            way = np.array([np.cos(entity.angle), np.sin(entity.angle)])
            half = 0.5 * WIDTH_OF_A_SIGN * entity.height * len(entity.words) * way
            rise = 0.5 * entity.height * np.array([-way[1], way[0]])
            middle = entity.place + half if entity.left else entity.place
            points.append(middle + np.stack([half + rise, half - rise, -half + rise, -half - rise]))
    together = np.concatenate(points)
    return together.min(axis=0), together.max(axis=0)


def _reach(vertices: Array) -> Array:
    """The vertices, and the tops of the arcs between them."""
    start, stop = vertices[:, :2], np.roll(vertices[:, :2], -1, axis=0)
    chord = stop - start
    tops = 0.5 * (start + stop) + 0.5 * vertices[:, 2:] * np.stack([chord[:, 1], -chord[:, 0]], axis=-1)
    return np.concatenate([start, tops])
