"""Drawings are read back and measured: whatever was changed in one of them shows."""

import shutil
from dataclasses import replace

import numpy as np
import pytest

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.drawing import proof as module
from cadpanel.delivery.drawing.proof import prove_drawings
from cadpanel.delivery.outputs.flat_dxf import FLAT, FlatDxf
from cadpanel.delivery.outputs.output import Delivery
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError
from tests.flat_parts import SHEET, strip_records

SHOPS = {
    "polyline": ShopSettings(),
    "lines": ShopSettings(dxf_entities="lines", chord=0.1),
    "contour": ShopSettings(dxf_contour_only=True, dxf_entities="lines"),
    "layers": ShopSettings(dxf_layers=(("CUT", "Kont\u00fcr"), ("BEND", "\u7a97"), ("ROLL", "MARK"))),
}
ELSEWHERE = "'N 3.dxf' holds other entities than 'all.dxf' has of this part."


def contents(shop):
    records, seams, parts = strip_records(shop)
    return Contents(title="strip", sheet=SHEET, shop=shop, records=records, seams=seams, parts=parts)


@pytest.fixture(scope="module", params=SHOPS)
def drawn(request, tmp_path_factory):
    shop = SHOPS[request.param]
    told = contents(shop)
    folder = tmp_path_factory.mktemp("drawn")
    slots = ("title", "sheet", "shop", "records", "seams", "parts")
    FlatDxf().write(folder, Delivery(panels=(), **{name: getattr(told, name) for name in slots}))
    return folder / FLAT, told


def test_what_was_just_drawn_is_not_drawn_again_and_a_change_shows_as_well(tmp_path, monkeypatch):
    told = contents(ShopSettings())
    slots = ("title", "sheet", "shop", "records", "seams", "parts")
    delivery = Delivery(panels=(), **{name: getattr(told, name) for name in slots})
    monkeypatch.setattr(module, "drawings_of", lambda _: pytest.fail("it is drawn again"))
    for part, says in ((b"INFO", False), (b"INFA", True)):
        shutil.rmtree(tmp_path / FLAT, ignore_errors=True)
        FlatDxf().write(tmp_path, delivery)
        file = tmp_path / FLAT / f"{next(iter(delivery.drawn))}.dxf"
        before, word, after = file.read_bytes().rpartition(b"INFO")
        assert word
        file.write_bytes(before + part + after)
        assert not replace(delivery, title="other").drawn
        assert bool(prove_drawings(tmp_path / FLAT, delivery).failures) == says
        assert not delivery.drawn


@pytest.fixture
def changed(drawn, tmp_path):
    """A copy, and a way to put one text for another in one of its files, where it stands first."""
    folder = shutil.copytree(drawn[0], tmp_path / "flat")

    def change(file, before, after):
        data = (folder / file).read_bytes()
        assert before in data
        (folder / file).write_bytes(data.replace(before, after, 1))
        return prove_drawings(folder, drawn[1]).failures

    return folder, change


def test_what_was_drawn_holds(drawn):
    folder, told = drawn
    proof = prove_drawings(folder, told)
    assert proof.failures == ()
    assert proof.numbers["drawings"] == 4
    assert proof.numbers["audit_errors"] == 0
    assert 0.0 < proof.numbers["contour_error"] <= told.shop.chord


def test_a_corner_that_was_moved_by_a_hair_shows(drawn, changed):
    _, change = changed
    corner = drawn[1].parts[0].pattern.curves.start[1]
    before, after = (f"\r\n{x!r}\r\n".encode() for x in (float(corner[0]), float(corner[0]) + 1e-3))
    failures = change("N 1.dxf", before, after)
    assert failures
    assert "'N 1.dxf'" in failures[0]


def test_a_contour_that_is_open_or_missing_shows(changed):
    folder, change = changed
    kind = b"LWPOLYLINE" if b"LWPOLYLINE" in (folder / "N 2.dxf").read_bytes() else b"  0\r\nARC"
    (failure,) = change("N 2.dxf", kind, kind.replace(b"LWPOLYLINE", b"HELIX").replace(b"ARC", b"RAY"))
    assert failure == "'N 2.dxf': it holds 0 closed contours on the layer that is cut instead of one."


def test_a_bend_that_was_moved_shows(drawn, changed):
    folder, change = changed
    if drawn[1].shop.dxf_contour_only:
        assert b"AcDbText\r\n" not in (folder / "N 1.dxf").read_bytes()
        return
    x = float(drawn[1].parts[0].pattern.tangents[0, 1, 0])
    (failure,) = change("N 1.dxf", f" 11\r\n{x!r}\r\n".encode(), f" 11\r\n{x + 1e-4!r}\r\n".encode())
    assert failure == "'N 1.dxf': its lines on the layer BEND lie elsewhere."


def test_a_frame_that_was_changed_shows(changed):
    _, change = changed
    (failure,) = change("N 3.dxf", b"$INSUNITS\r\n 70\r\n4\r\n", b"$INSUNITS\r\n 70\r\n1\r\n")
    assert failure == "'N 3.dxf': what stands about its entities is not what 'all.dxf' has."


def test_what_ezdxf_finds_in_the_drawing_of_all_parts_shows(changed):
    folder, change = changed
    begin = (folder / "all.dxf").read_bytes().partition(b"ENTITIES\r\n")[2].partition(b"  8\r\n")[0]
    failures = change("all.dxf", begin + b"  8\r\n", begin + b"  6\r\nNOSUCHTYPE\r\n  8\r\n")
    assert any("ezdxf finds" in failure for failure in failures)


def test_a_part_that_is_missing_among_all_shows(drawn, changed):
    folder, _ = changed
    whole, one = (folder / "all.dxf").read_bytes(), (folder / "N 1.dxf").read_bytes()
    (folder / "all.dxf").write_bytes(one)
    failures = prove_drawings(folder, drawn[1]).failures
    assert "'all.dxf' holds 1 contours, expected 3." in failures
    (folder / "all.dxf").write_bytes(whole)
    assert prove_drawings(folder, drawn[1]).failures == ()


def test_a_part_that_is_another_one_among_all_shows(drawn, changed):
    folder, _ = changed
    entities, end, tail = (folder / "all.dxf").read_bytes().partition(b"ENDSEC\r\n  0\r\nSECTION\r\n  2\r\nOBJECTS")
    before, code, rest = entities.rpartition(b"\r\n 10\r\n")
    value, line, after = rest.partition(b"\r\n")
    other = before + code + repr(float(value) + 1e-5).encode() + line + after
    (folder / "all.dxf").write_bytes(other + end + tail)
    failures = prove_drawings(folder, drawn[1]).failures
    # Where nothing but contours is drawn, one of them is open now.
    shows = "'all.dxf' holds 0 contours, expected 3." if drawn[1].shop.dxf_contour_only else ELSEWHERE
    assert failures[0] == shows
    (folder / "all.dxf").write_bytes(entities.replace(b"AcDbEntity", b"AcDbEntitx", 1) + end + tail)
    assert prove_drawings(folder, drawn[1]).failures


def test_a_drawing_of_no_panel_shows_and_a_missing_or_damaged_one_is_refused(drawn, changed):
    folder, _ = changed
    shutil.copy(folder / "N 1.dxf", folder / "N 9.dxf")
    (failure,) = prove_drawings(folder, drawn[1]).failures
    assert failure.startswith("'N 9.dxf' stands among the drawings")
    data = (folder / "N 1.dxf").read_bytes()
    for damage in (data[: len(data) // 2], b"", data.replace(b"ENTITIES", b"NOTHINGS"), data[9:]):
        (folder / "N 1.dxf").write_bytes(damage)
        with pytest.raises(DeliveryError, match=r"N 1\.dxf' cannot be read"):
            prove_drawings(folder, drawn[1])
    (folder / "N 1.dxf").unlink()
    with pytest.raises(DeliveryError, match=r"N 1\.dxf' cannot be read: No such file"):
        prove_drawings(folder, drawn[1])


def test_numbers_that_are_none_are_refused(changed, drawn):
    folder, _ = changed
    head, mark, rest = (folder / "N 1.dxf").read_bytes().partition(b"ENTITIES")
    (folder / "N 1.dxf").write_bytes(head + mark + rest.replace(b"\r\n 20\r\n", b"\r\n 20\r\nno number", 1))
    with pytest.raises(DeliveryError, match=r"N 1\.dxf' cannot be read"):
        prove_drawings(folder, drawn[1])


def test_wider_arcs_than_the_tolerance_allows_show(drawn):
    folder, told = drawn
    finer = Contents(
        title=told.title,
        sheet=told.sheet,
        shop=ShopSettings(chord=1e-3, dxf_contour_only=True, dxf_layers=told.shop.dxf_layers),
        records=told.records,
        seams=told.seams,
        parts=told.parts,
    )
    failures = prove_drawings(folder, finer).failures
    assert any("mm off the exact one" in failure for failure in failures)
    assert np.all([failure.startswith("'") for failure in failures])
