"""Records of a panel as a flat part: its blank, its bends, the planes that cut its ends. Millimetres and degrees."""

from __future__ import annotations

from typing import Literal

from cadpanel.delivery.records.jsonfile import Direction, NonNegative, NonNegativeCount, Positive, Record, Vector

Pair = tuple[float, float]


class BlankModel(Record):
    """A panel as a flat part.

    Attributes:
        width, height: sides of the smallest rectangle about it, the longer one first, mm, to 0.01 mm.
        area: inside its contour, mm2.
        edges: exact length of each edge of the contour, mm.
        stock: the smallest sheet of the stock that it fits on, "1500x3000"; None where it fits none, or there is none.
        file: name of its drawing in the folder of drawings, without the ending.
    """

    width: Positive
    height: Positive
    area: Positive
    edges: dict[str, Positive]
    stock: str | None = None
    file: str


class BendModel(Record):
    """A part of a panel that is rolled or folded round; of two values the first is that at end 0.

    Attributes:
        patch: which patch of the panel.
        direction: "down" where the sheet turns away from who looks at the outer face, else "up".
        radius: least and largest radius of the sheet's inner face there, from the bend's axis, mm.
        half_angle: of the cone, 0 for a cylinder.
        sweep: by which the sheet turns about the bend's axis.
        lengths: along the ends, on the surface that keeps its lengths, mm.
        angles: by which the edge turns, seen square to the plane in which the end lies: those of a template.
        hits: strokes of a press that bends it in facets of the height that the settings say.
    """

    patch: NonNegativeCount
    direction: Literal["up", "down"]
    radius: Pair
    half_angle: NonNegative
    sweep: NonNegative
    lengths: Pair
    angles: Pair
    hits: NonNegativeCount


class FixingModel(Record):
    """A fixing hole.

    Attributes:
        edge: along which it stands.
        patch: of the panel in which it lies.
        flat: its middle on the flat pattern, mm.
        point: its middle on the panel's skin, mm.
        normal: of the skin there, along which it is drilled.
    """

    edge: str
    patch: NonNegativeCount
    flat: Pair
    point: Vector
    normal: Vector


class CutModel(Record):
    """A plane that cuts an end or a side: its unit normal, and how far it lies from the origin along that, mm."""

    normal: Direction
    offset: float
