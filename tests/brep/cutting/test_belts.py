"""Rings whose faces share no parameter, as a stadium's roof edge is drawn: a flat flange with a hole, a bend."""

import numpy as np
import pytest

from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_reference
from cadpanel.errors import CadpanelError
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import write_shape
from tests.round_roofs import WHOLE, band_area, roof_edge
from tests.thorough import cases

RINGS = {"whole turns": (1.0,), "halves": (0.5, 0.5), "uneven": (0.3, 0.45, 0.25)}


def cut(folder, turns, **how):
    path = write_shape(folder / "edge.brep", compound_of(roof_edge(turns)))
    return read_reference(path, ReferenceSettings(unit="mm", **how))


def assert_round(reference, count, area, rel):
    areas = np.array([panel.weights.sum() for panel in reference.panels])
    assert [panel.name for panel in reference.panels] == [f"S1-{place:02}" for place in range(1, count + 1)]
    np.testing.assert_allclose(areas, area / count, rtol=rel)
    assert len(reference.seams) == count if count > 2 else reference.seams
    assert {len(panel.edges) for panel in reference.panels} == {4}


@pytest.mark.parametrize("turns", RINGS)
@pytest.mark.parametrize("count", cases([8], [3, 8, 17]))
def test_ring_of_flange_bend_and_fascia_is_divided_round(tmp_path, turns, count):
    assert_round(cut(tmp_path, RINGS[turns], divide=count), count, WHOLE, 2e-3)


@pytest.mark.parametrize("turns", cases(["halves"], ["whole turns", "halves"]))
@pytest.mark.parametrize("width", cases([300.0], [300.0, 900.0]))
def test_band_about_the_bend_of_a_ring_is_divided_round(tmp_path, turns, width):
    assert_round(cut(tmp_path, RINGS[turns], divide=12, lip=width), 12, band_area(width), 1e-2)


def test_ring_is_not_one_panel(tmp_path):
    with pytest.raises(CadpanelError, match=r"closes to a ring, .*: divide it into a number of panels, 2"):
        cut(tmp_path, (1.0,), divide=1)
