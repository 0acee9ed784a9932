"""Samples weigh what their face covers, however it and its border wave."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere, BRepPrimAPI_MakeTorus
from OCP.TopAbs import TopAbs_FACE

from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.splitting.splitter import area_of
from tests.drawn import LENGTH, WAVE, WIDTH, curve, cut_points, plate, raw, wave
from tests.model_files import STRIP, strip_faces
from tests.reference_shapes import kernel_face
from tests.thorough import cases

# Parts of the area.
PLANE_ERROR = 1e-7
SPLINE_ERROR = 2e-5


def weight(panel):
    return sum(face.weights.sum() for face in panel.faces)


# Four, eight, 16 and 32 periods put every one of 33 even points where the wave crosses its own middle.
@pytest.mark.parametrize("periods", cases([4, 10, 32], [1, 4, 8, 10, 16, 32, 40]))
def test_halves_of_a_plate_beside_a_wave_weigh_half_and_show_its_crests(tmp_path, periods):
    panels = raw(tmp_path, plate(), [wave(periods)]).panels
    assert [weight(panel) for panel in panels] == pytest.approx(2 * [0.5 * LENGTH * WIDTH], rel=PLANE_ERROR)
    assert np.ptp(cut_points(panels)[:, 0]) == pytest.approx(2.0 * WAVE, rel=0.05)


def slanting(periods, swing=0.08):
    """A curve along the whole strip that slants and waves."""
    u = np.linspace(0.0, 3.0, 40 * max(periods, 1) + 1)
    return curve(STRIP(u, 0.5 + 0.1 * u / 3.0 + swing * np.sin(2.0 * np.pi * periods * u / 3.0)))


@pytest.mark.parametrize("faces", [lambda: [kernel_face(STRIP, poles=40)], strip_faces], ids=["one", "three"])
@pytest.mark.parametrize("periods", [0, 1, 4])
def test_parts_of_a_strip_weigh_what_the_kernel_integrates_patiently(tmp_path, faces, periods):
    strip = faces()
    panels = raw(tmp_path, compound_of(strip), [slanting(periods)]).panels
    assert len(panels) == 2
    whole = sum(area_of(face) for face in strip)
    assert sum(map(weight, panels)) == pytest.approx(whole, rel=SPLINE_ERROR)


@pytest.mark.parametrize("angle", [0.3, 1.57, 3.0, 2.0 * np.pi])
def test_sector_with_an_arc_for_its_border_weighs_as_it_should(angle):
    arc = BRepPrimAPI_MakeCylinder(500.0, 100.0, angle).Shape()
    flat = [face for face in shapes_of(arc, TopAbs_FACE) if area_of(face) == pytest.approx(0.5 * angle * 500.0**2)]
    assert len(flat) == 2
    for face in flat:
        (samples,) = sample_faces(face)
        assert samples.weights.sum() == pytest.approx(0.5 * angle * 500.0**2, rel=1e-12)


def ball(low, high, turn):
    return shapes_of(BRepPrimAPI_MakeSphere(1000.0, low, high, turn).Shape(), TopAbs_FACE)[0]


@given(low=st.floats(-1.5, 0.5), rise=st.floats(0.2, 1.0), turn=st.floats(0.3, 2.0 * np.pi))
@settings(max_examples=25, deadline=None)
def test_a_part_of_a_ball_weighs_what_it_covers(low, rise, turn):
    """Its parameters cover area unevenly, and it fills their range."""
    face = ball(low, low + rise, turn)
    exact = 1e6 * turn * (np.sin(low + rise) - np.sin(low))
    spline = shapes_of(BRepBuilderAPI_NurbsConvert(face, True).Shape(), TopAbs_FACE)[0]
    for shape in (face, spline):
        (samples,) = sample_faces(shape)
        assert samples.weights.sum() == pytest.approx(exact, rel=1e-7)


@pytest.mark.parametrize("minor", [200.0, 1900.0])
def test_a_torus_weighs_what_it_covers(minor):
    (face,) = shapes_of(BRepPrimAPI_MakeTorus(2000.0, minor).Shape(), TopAbs_FACE)
    (samples,) = sample_faces(face)
    assert samples.weights.sum() == pytest.approx(4.0 * np.pi**2 * 2000.0 * minor, rel=1e-9)


@pytest.mark.parametrize("periods", [5.0, 10.0])
@pytest.mark.parametrize("uneven", [0.0, 0.8])
def test_a_face_that_waves_weighs_what_the_kernel_integrates_patiently(periods, uneven):
    """Also where as many crests as lines lie on it, and all that was measured looks alike."""

    def surface(u, v):
        along = u + uneven * u * (1.0 - u)
        return np.stack([6000.0 * along, 4000.0 * v, 150.0 * np.sin(2.0 * np.pi * periods * along)], axis=-1)

    face = kernel_face(surface, (0.0, 1.0), poles=60)
    (samples,) = sample_faces(face)
    assert samples.weights.sum() == pytest.approx(area_of(face), rel=SPLINE_ERROR)
