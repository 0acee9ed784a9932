"""DXF as it is written: what ezdxf reads is what was drawn, and the same drawing gives the same bytes."""

import math

import numpy as np
import pytest
from ezdxf.filemanagement import readfile
from ezdxf.lldxf.encoding import decode_dxf_unicode

from cadpanel.delivery.drawing.dxf import MARK, dxf_bytes, frame_of
from cadpanel.delivery.drawing.entities import Contour, Line, Text
from cadpanel.delivery.outputs.flat_dxf import FLAT, FlatDxf
from cadpanel.delivery.shop_settings import ShopSettings

DRAWING = (
    Contour("CUT", np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.25], [100.0, 50.0, 0.0], [0.0, 50.0, -0.1]])),
    Line("BEND", np.array([10.0, 0.0]), np.array([10.0, 50.0])),
    Text("MARK", "N\u00f6rd 100%%d ^x", np.array([50.0, 25.0]), 5.0, math.pi / 2.0),
    Text("INFO", "\u7a97 1\n2", np.array([0.0, -20.0]), 5.0, left=True),
)


def read(tmp_path, shop, drawing=DRAWING):
    path = tmp_path / "drawing.dxf"
    path.write_bytes(dxf_bytes(drawing, frame_of(shop), shop.dxf_entities))
    document = readfile(path)
    audit = document.audit()
    assert (audit.errors, audit.fixes) == ([], [])
    return document


def test_ezdxf_reads_what_was_drawn(tmp_path):
    document = read(tmp_path, ShopSettings())
    contour, line, mark, info = document.modelspace()
    assert (document.dxfversion, document.units) == ("AC1015", 4)
    assert contour.closed
    assert np.array(contour.get_points("xyb")) == pytest.approx(DRAWING[0].vertices, abs=0.0)
    assert [e.dxf.layer for e in (contour, line, mark, info)] == ["CUT", "BEND", "MARK", "INFO"]
    assert (line.dxf.start.vec2, line.dxf.end.vec2) == ((10.0, 0.0), (10.0, 50.0))
    assert (mark.dxf.height, mark.dxf.rotation) == (5.0, pytest.approx(90.0))
    assert mark.get_placement()[1] == (50.0, 25.0)
    assert decode_dxf_unicode(info.dxf.text) == "\u7a97 1 2"
    assert {layer.dxf.name for layer in document.layers} >= {"CUT", "BEND", "ROLL", "MARK", "INFO"}


def test_signs_that_would_begin_a_code_are_shown_as_they_are(tmp_path):
    mark = list(read(tmp_path, ShopSettings()).modelspace())[2]
    assert mark.dxf.text == "N\u00f6rd 100%%%%%%d ^ x"  # AutoCAD shows %%% as one sign, and "^ " as ^


def test_lines_and_arcs_follow_the_same_contour(tmp_path):
    document = read(tmp_path, ShopSettings(dxf_entities="lines"), DRAWING[:1])
    pieces = list(document.modelspace())
    assert [piece.dxftype() for piece in pieces] == ["LINE", "ARC", "LINE", "ARC"]
    corners = DRAWING[0].vertices[:, :2]
    for piece, start, stop in zip(pieces, corners, np.roll(corners, -1, axis=0), strict=True):
        ends = (piece.start_point, piece.end_point) if piece.dxftype() == "ARC" else (piece.dxf.start, piece.dxf.end)
        found = sorted(tuple(np.round(end.vec2, 9)) for end in ends)
        assert np.array(found) == pytest.approx(np.array(sorted(map(tuple, (start, stop)))), abs=1e-9)
    sweeps = [(arc.dxf.end_angle - arc.dxf.start_angle) % 360.0 for arc in pieces if arc.dxftype() == "ARC"]
    assert sweeps == pytest.approx([math.degrees(4.0 * math.atan(bulge)) for bulge in (0.25, 0.1)])


def test_an_arc_that_hardly_bows_is_a_line(tmp_path):
    flat = Contour("CUT", np.array([[0.0, 0.0, 1e-9], [100.0, 0.0, 0.0], [0.0, 50.0, 0.0]]))
    document = read(tmp_path, ShopSettings(dxf_entities="lines"), [flat])
    assert {piece.dxftype() for piece in document.modelspace()} == {"LINE"}


def test_the_same_drawing_gives_the_same_bytes_and_other_bytes_at_another_date(monkeypatch):
    shop = ShopSettings()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    one, two = (dxf_bytes(DRAWING, frame_of(shop), "polyline") for _ in range(2))
    assert one == two
    assert one.startswith(MARK)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    dated = dxf_bytes(DRAWING, frame_of(shop), "polyline")
    assert dated != one
    written = float(dated.partition(b"$TDCREATE\r\n 40\r\n")[2].split(b"\r\n")[0])
    assert written == pytest.approx(2440587.5 + 1700000000 / 86400, abs=1.0)


def test_the_mark_is_the_one_by_which_folders_are_known():
    assert FlatDxf.folders[FLAT] == MARK
