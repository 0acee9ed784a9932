"""Entities are read as ezdxf reads them, damage is refused, and whatever is not just moved shows."""

import io

import numpy as np
import pytest
from ezdxf.addons import iterdxf

from cadpanel.delivery.drawing.dxf import MARK, Frame, dxf_bytes
from cadpanel.delivery.drawing.entities import Circle, Contour, Entity, Line, Text, moved
from cadpanel.delivery.drawing.proof import _by_ezdxf
from cadpanel.delivery.drawing.reading import drawn_in, moved_only

ROUND = np.array([[0.0, 0.0, 0.2], [100.0, 3.0, -0.3], [104.0, 50.0, 0.0], [2.0, 51.0, 1e-4]])
DRAWING: tuple[Entity, ...] = (
    Contour("Kont\u00fcr", ROUND),
    Circle("CUT", np.array([50.0, 10.0]), 3.0),
    Line("\u7a97", np.array([20.0, 0.0]), np.array([20.0, 10.0])),
    Text("INFO", "A1, K-factor 0.5 \u00d8", np.array([5.0, 5.0]), 4.0, angle=0.3),
)
BEGIN = (
    b"  0\r\nSECTION\r\n  2\r\nHEADER\r\n  9\r\n$ACADVER\r\n  1\r\nAC1015\r\n  0\r\nENDSEC\r\n"
    b"  0\r\nSECTION\r\n  2\r\nENTITIES\r\n"
)
END = b"  0\r\nPOINT\r\n  8\r\n0\r\n  0\r\nENDSEC\r\n"
both_ways = pytest.mark.parametrize("entities", ["polyline", "lines"])


def written(drawing=DRAWING, entities="polyline"):
    return dxf_bytes(drawing, Frame("", "", "1F"), entities).removeprefix(MARK)


@both_ways
def test_entities_are_what_ezdxf_reads(entities):
    text = written(entities=entities)
    own = drawn_in(text)
    others = [_by_ezdxf(one) for one in iterdxf.single_pass_modelspace(io.BytesIO(BEGIN + text + END))]
    kinds = ["LWPOLYLINE"] if entities == "polyline" else ["ARC", "ARC", "LINE", "ARC"]
    assert [one.kind for one in own] == [*kinds, "CIRCLE", "LINE", "TEXT"]
    assert [(one.kind, one.layer, one.closed) for one in own] == [(one.kind, one.layer, one.closed) for one in others]
    for one, other in zip(own, others, strict=True):
        if other.kind != "CIRCLE":
            assert np.allclose(np.array(one.vertices), np.array(other.vertices), rtol=0.0, atol=1e-9)
    assert own[len(kinds)].vertices == ((50.0, 10.0, 3.0),)


@both_ways
def test_a_drawing_that_was_moved_is_the_same_and_one_in_which_anything_was_moved_is_not(entities):
    shift = np.array([1234.5, -8765.25])
    one, other = (drawn_in(written(drawing, entities)) for drawing in (DRAWING, moved(DRAWING, shift)))
    assert moved_only(one, other)
    assert not moved_only(one[:-1], other)
    for place, entity in enumerate(DRAWING):
        hair = (*DRAWING[:place], entity.moved(np.array([0.0, 1e-5])), *DRAWING[place + 1 :])
        assert not moved_only(one, drawn_in(written(moved(hair, shift), entities)))


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (b"K-factor 0.5", b"K-factor 0.4"),
        (b"INFO", b"INFA"),
        (b" 70\r\n1\r\n", b" 70\r\n0\r\n"),
        (b" 40\r\n3.0\r\n", b" 40\r\n3.1\r\n"),
        (b"AcDbLine\r\n", b"AcDbLine\r\n 62\r\n1\r\n"),
        (b"\r\n330\r\n1F\r\n", b"\r\n330\r\n1E\r\n"),
    ],
)
def test_another_word_number_or_code_shows_and_another_handle_does_not(before, after):
    text = written()
    assert before in text
    assert not moved_only(drawn_in(text), drawn_in(text.replace(before, after, 1)))
    assert moved_only(drawn_in(text), drawn_in(text.replace(b"  5\r\n1000\r\n", b"  5\r\nFFFF\r\n")))


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        (b"  0\r\nLWPOLYLINE", b"  0\r\nLWPOLYLINE\r\n", "not whole"),
        (b" 20\r\n", b" 20\r\nno number", "no number"),
        (b" 70\r\n1", b" 70\r\none", "one"),
        (b" 40\r\n3.0\r\n", b"", "CIRCLE of it has no code 40"),
        (b"  0\r\nLWPOLYLINE", b"  8\r\nLWPOLYLINE", "codes that are none"),
        (b"  8\r\nINFO", b" -8\r\nINFO", "codes that are none"),
        (b"  8\r\nINFO", b"1072\r\nINFO", "codes that are none"),
    ],
)
def test_what_is_no_drawing_is_refused(before, after, says):
    text = written()
    assert before in text
    with pytest.raises(ValueError, match=says):
        drawn_in(text.replace(before, after, 1))
