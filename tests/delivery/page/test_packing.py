"""Scenes come back from their text, panels alike share triangles, and 300 panels with their seams are below 5 MB."""

import json
from dataclasses import replace

import numpy as np
import pytest

from cadpanel.delivery.page.flats import packed_flats
from cadpanel.delivery.page.html import page_bytes
from cadpanel.delivery.page.numbers import page_numbers
from cadpanel.delivery.page.packing import packed, unpacked
from cadpanel.delivery.page.scene import Scene
from tests.pages import delivery, scene


def test_a_scene_comes_back_to_a_twentieth_of_a_millimetre():
    found = unpacked(json.loads(json.dumps(packed(scene()))))
    for there, here in zip(found.panels, scene().panels, strict=True):
        assert there.name == here.name
        assert np.array_equal(there.triangles, here.triangles)
        assert np.array_equal(there.ghost.triangles, here.ghost.triangles)
        assert there.ghost.outline == here.ghost.outline
        for what in ("points", "other", "deviation"):
            assert getattr(there, what) == pytest.approx(getattr(here, what), abs=0.05)
        assert there.ghost.points == pytest.approx(here.ghost.points, abs=0.05)
    for seam, was in zip(found.seams, scene().seams, strict=True):
        assert seam.panels == was.panels
        assert seam.profile.points == pytest.approx(was.profile.points, abs=0.05)
        for what in ("along", "gap", "width", "step", "kink"):
            assert getattr(seam.profile, what) == pytest.approx(getattr(was.profile, what), abs=0.05)


def test_panels_alike_share_their_triangles():
    assert len(packed(scene())["topologies"]) == 1
    other = replace(scene().panels[1], triangles=scene().panels[1].triangles[::-1])
    assert len(packed(replace(scene(), panels=(scene().panels[0], other)))["topologies"]) == 2


def test_a_page_of_300_panels_and_580_seams_is_below_5_mb():
    told = delivery()
    many = Scene(panels=100 * scene().panels, seams=290 * scene().seams)
    shapes = {**packed(many), "flats": packed_flats([part.pattern for part in 100 * told.parts])}
    numbers = page_numbers(replace(told, records=100 * told.records, seams=290 * told.seams))
    assert len(page_bytes("many", numbers, shapes)) < 5e6
