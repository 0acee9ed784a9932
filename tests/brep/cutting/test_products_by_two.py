"""A file that two processes read gives what one finds, digit for digit, or is left to one."""

import io
import os
import signal
from pathlib import Path

import numpy as np
import pytest

from cadpanel.brep import server
from cadpanel.brep.cutting import products_by_two as by_two
from cadpanel.brep.cutting import raw_panels as whole
from cadpanel.brep.files.loading import load_reference
from cadpanel.brep.files.step import read_plain_products
from cadpanel.brep.isolation import requests
from cadpanel.brep.isolation.beside import POSSIBLE
from cadpanel.reference.outline import find_outline
from cadpanel.reference.settings import ReferenceSettings

pytestmark = pytest.mark.skipif(not POSSIBLE, reason="this system copies no processes")

FIXTURES = Path(__file__).parents[3] / "fixtures"
HOW = ReferenceSettings()


@pytest.fixture(autouse=True)
def every_file(monkeypatch):
    monkeypatch.setattr(by_two, "WORTHWHILE_BYTES", 0)
    monkeypatch.setattr(by_two, "processors", lambda: 2)
    for module in (by_two, whole):
        monkeypatch.setattr(module, "PANELS_AT_ONCE", 2)


def read_by_two(path, how=HOW, go_on=lambda: None):
    return by_two.products_by_two(path, how, go_on)


def read_whole(path):
    return whole.raw_panels(load_reference(path, HOW), HOW)


def arrays(panel):
    return [
        array
        for face in panel.faces
        for array in (face.points, face.normals, face.weights, *face.edges, *face.edge_normals)
    ]


def assert_same(found, wanted):
    assert found is not None
    assert [panel.name for panel in found.panels] == [panel.name for panel in wanted.panels]
    assert found.notes == wanted.notes
    assert found.origin == wanted.origin
    wanted_outlines = [find_outline(panel, "changed.step", HOW.seam_tolerance) for panel in wanted.panels]
    for own, same in zip((*found.outlines, *wanted.outlines), (*wanted_outlines, *wanted_outlines), strict=True):
        assert own.face_signs == same.face_signs
        for side, other in zip(own.sides, same.sides, strict=True):
            np.testing.assert_array_equal(side.points, other.points)
    for one, other in zip(found.panels, wanted.panels, strict=True):
        for array, same in zip(arrays(one), arrays(other), strict=True):
            np.testing.assert_array_equal(array, same)


@pytest.mark.parametrize("name", ["kai_tak_nw", "kai_tak_se_east", "kai_tak_se_south"])
def test_two_find_what_one_finds(name):
    path = FIXTURES / f"{name}.step"
    assert_same(read_by_two(path), read_whole(path))


def changed(tmp_path, *changes):
    text = (FIXTURES / "kai_tak_nw.step").read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "changed.step"
    path.write_text(text)
    return path


def test_names_are_told_apart_over_both_halves(tmp_path):
    path = changed(tmp_path, *((f"'{names[0]}'", "'one name'") for names in [[name] for name in panel_names()]))
    assert_same(read_by_two(path), read_whole(path))


def panel_names():
    return [panel.name for panel in read_whole(FIXTURES / "kai_tak_nw.step").panels]


def test_a_model_far_away_is_moved_as_a_whole(tmp_path, monkeypatch):
    monkeypatch.setattr("cadpanel.brep.files.loading.FAR", 1.0)
    path = changed(tmp_path)
    found = read_by_two(path)
    assert_same(found, read_whole(path))
    assert found is not None
    assert any(found.origin)


@pytest.mark.parametrize("old", ["ADVANCED_FACE", "#20", "LENGTH_UNIT()"])
def test_a_file_with_a_fault_is_left_to_one(tmp_path, old):
    assert read_by_two(changed(tmp_path, (old, f"X{old}"))) is None


@pytest.mark.parametrize("error", [ValueError, MemoryError, AttributeError])
def test_a_half_that_fails_however_leaves_the_file_to_one(monkeypatch, error):
    def fails(*_):
        raise error("no half")

    monkeypatch.setattr(by_two, "mended_products", fails)
    assert read_by_two(FIXTURES / "kai_tak_nw.step") is None


def test_the_other_process_crashing_leaves_the_file_to_one(monkeypatch):
    own, read = os.getpid(), read_plain_products

    def crashes(path, count):
        if os.getpid() != own:
            os.kill(os.getpid(), signal.SIGSEGV)
        return read(path, count)

    monkeypatch.setattr(by_two, "read_plain_products", crashes)
    assert read_by_two(FIXTURES / "kai_tak_nw.step") is None


def test_two_read_under_a_python_that_knows_no_files_in_memory(monkeypatch):
    monkeypatch.delattr(os, "memfd_create", raising=False)
    path = FIXTURES / "kai_tak_nw.step"
    assert_same(read_by_two(path), read_whole(path))


def test_the_work_begins_once_both_halves_are_read(monkeypatch):
    happened = []
    work = whole.mended_products

    def noted(*how):
        happened.append("work")
        return work(*how)

    monkeypatch.setattr(by_two, "mended_products", noted)
    assert read_by_two(FIXTURES / "kai_tak_nw.step", go_on=lambda: happened.append("go on")) is not None
    assert happened == ["go on", "work"]


def test_a_file_that_two_cannot_read_is_still_being_read(tmp_path):
    told = []
    path = changed(tmp_path, ("ADVANCED_FACE", "XADVANCED_FACE"))
    assert read_by_two(path, go_on=lambda: told.append("go on")) is None
    assert not told


@pytest.mark.parametrize("fails", [False, True])
def test_whoever_asked_hears_once_that_the_work_begins(monkeypatch, fails):
    monkeypatch.chdir(FIXTURES)
    limits: list[float] = []
    answers = io.BytesIO()
    monkeypatch.setattr(server, "limit_time", limits.append)
    if fails:
        monkeypatch.setattr(by_two, "all_of", lambda _: None)
    path = FIXTURES / "kai_tak_nw.step"
    found = server.answer(requests.work_request("panels", path, HOW), answers)
    assert answers.getvalue() == requests.NEXT_STAGE
    assert limits == [requests.seconds_to_read(path), requests.SECONDS_TO_WORK]
    assert_same(found, read_whole(path))


@pytest.mark.parametrize("how", [{"divide": 3}, {"unit": "cm"}, {"faces": "all"}])
def test_what_is_asked_beside_products_is_for_one(how):
    assert read_by_two(FIXTURES / "kai_tak_nw.step", ReferenceSettings(**how)) is None


def test_a_small_file_and_one_that_is_not_there_are_for_one(monkeypatch):
    assert read_by_two(FIXTURES / "missing.step") is None
    monkeypatch.setattr(by_two, "WORTHWHILE_BYTES", 10**9)
    assert read_by_two(FIXTURES / "kai_tak_nw.step") is None
