"""A strip that folds back to a knife edge is not joined there, however many segments it has."""

import numpy as np
import pytest

from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.reference.outline import find_outline
from cadpanel.reference.settings import ReferenceSettings
from tests.knife_edges import aerofoil_faces
from tests.model_files import write_shape
from tests.thorough import cases, thorough

SEGMENTS = {"one": (0.0, 5000.0), "two": (0.0, 3000.0, 5000.0), "three": (0.0, 1000.0, 3500.0, 5000.0)}
WIDTH = 150.0


def cut(folder, stations, taper=0.0, chord=1500.0, **how):
    path = write_shape(folder / "wing.brep", compound_of(aerofoil_faces(stations, chord, taper)))
    return read_raw_panels(path, ReferenceSettings(unit="mm", **how)).panels


def areas(panels):
    return [sum(face.weights.sum() for face in panel.faces) for panel in panels]


@pytest.mark.parametrize("segments", cases(["three"], [*SEGMENTS]))
@pytest.mark.parametrize("count", cases([7], [6, 7]))
def test_leading_edge_is_one_strip(tmp_path, segments, count):
    panels = cut(tmp_path, SEGMENTS[segments], divide=count, lip=WIDTH)
    assert [panel.name for panel in panels] == [f"S1-{place:02}" for place in range(1, count + 1)]
    assert areas(panels) == pytest.approx([WIDTH * 5000.0 / count] * count, rel=2e-3)
    assert all(len(find_outline(panel, "wing.brep").sides) == 4 for panel in panels)


@thorough
@pytest.mark.parametrize("segments", cases(["two"], [*SEGMENTS]))
def test_tapered_leading_edge_is_one_strip(tmp_path, segments):
    panels = cut(tmp_path, SEGMENTS[segments], taper=0.01, divide=6, lip=WIDTH)
    # The leading edge is straight along y; a band along parameter lines may be off its width by a hundredth.
    assert areas(panels) == pytest.approx([WIDTH * 5000.0 / 6] * 6, rel=2e-2)


@pytest.mark.parametrize("segments", SEGMENTS)
def test_whole_profile_is_divided_from_knife_edge_to_knife_edge(tmp_path, segments):
    panels = cut(tmp_path, SEGMENTS[segments], divide=5)
    whole = sum(areas(panels))
    assert areas(panels) == pytest.approx([whole / 5] * 5, rel=1e-4)
    for place, panel in enumerate(panels):
        points = np.concatenate([edge for face in panel.faces for edge in face.edges])
        assert points[:, 1].min() == pytest.approx(1000.0 * place, abs=1e-3)
        assert points[:, 1].max() == pytest.approx(1000.0 * (place + 1), abs=1e-3)


@pytest.mark.parametrize("width", cases([40.0], [40.0, 60.0, 300.0]))
@pytest.mark.parametrize("count", [5, 12])
def test_band_about_a_strongly_tapered_leading_edge_is_cut_however_narrow_it_is(tmp_path, width, count):
    panels = cut(tmp_path, SEGMENTS["one"], taper=0.6, chord=5000.0, divide=count, lip=width)
    assert len(panels) == count
    assert sum(areas(panels)) == pytest.approx(width * 5000.0, rel=1e-2)
    assert all(len(find_outline(panel, "wing.brep").sides) == 4 for panel in panels)
