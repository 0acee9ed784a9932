"""A drawing is known again by all that it holds, and another one, or another way to write it, is not taken for it."""

import numpy as np
import pytest

from cadpanel.delivery.drawing.dxf import MARK, Frame, dxf_bytes
from cadpanel.delivery.drawing.entities import Circle, Contour, Entity, Line, Text
from cadpanel.delivery.drawing.redrawn import holds

ROUND = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.3], [100.0, 50.0, 0.0]])
DRAWING: tuple[Entity, ...] = (
    Contour("CUT", ROUND),
    Circle("CUT", np.array([50.0, 10.0]), 3.0),
    Line("BEND", np.array([20.0, 0.0]), np.array([20.0, 10.0])),
    Text("INFO", "A1, K-factor 0.5", np.array([5.0, 5.0]), 4.0),
)


def written(drawing=DRAWING, entities="polyline", owner="1F"):
    return dxf_bytes(drawing, Frame("", "", owner), entities).removeprefix(MARK)


@pytest.mark.parametrize(("entities", "others"), [("polyline", "lines"), ("lines", "polyline")])
def test_what_was_written_is_known_whatever_it_belongs_to(entities, others):
    assert holds(written(entities=entities), DRAWING, entities)
    assert not holds(written(entities=entities), DRAWING, others)


def test_last_digits_are_another_processors_and_no_more():
    assert holds(written(), (DRAWING[0], Circle("CUT", np.array([50.0, 10.0 + 1e-9]), 3.0), *DRAWING[2:]), "polyline")
    assert not holds(written(), (DRAWING[0], Circle("CUT", np.array([50.0, 10.1]), 3.0), *DRAWING[2:]), "polyline")


@pytest.mark.parametrize("place", range(len(DRAWING)))
def test_an_entity_left_out_on_another_layer_or_in_another_order_is_told(place):
    others = [one for at, one in enumerate(DRAWING) if at != place]
    assert not holds(written(), others, "polyline")
    assert not holds(written(), [*others, DRAWING[place]] if place < 3 else [DRAWING[3], *others], "polyline")
    assert not holds(written().replace(DRAWING[place].layer.encode(), b"OTHER"), DRAWING, "polyline")


def test_other_words_are_told():
    assert not holds(written().replace(b"K-factor 0.5", b"K-factor 0.4"), DRAWING, "polyline")
