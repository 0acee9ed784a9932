"""Faces of Rhino on surfaces that close, or shrink to a point, have the file's own trims; a bad one stands alone."""

import re

import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.TopAbs import TopAbs_EDGE

from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.opennurbs_faces import brep_faces
from cadpanel.brep.kernel.shape_maps import ShapeSet
from cadpanel.brep.kernel.shapes import shapes_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.brep.survey import survey
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.rhino_breps import Tube
from tests.rhino_files import bent_surface, file_in, off_border, rhino, written
from tests.thorough import thorough

pytestmark = pytest.mark.each_value_once

WAYS_ROUND = [(apex, round_v) for apex in (False, True) for round_v in (False, True)]
AREA = 2e-8  # what the kernel integrates over an arc to
ON_SURFACE = 1e-3  # the edges, splines through points of the surface, leave it by less, mm
ORIGIN = rhino.Point3d(0.0, 0.0, 0.0)
PLACES = {
    "turned": (np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), 1.0),
    "mirrored": (np.diag([1.0, -1.0, 1.0]), 1.0),
    "twice as large": (np.diag([2.0, 2.0, 2.0]), 4.0),
}


def saved(folder, *breps, names=(), unit="Millimeters"):
    file = file_in(unit)
    for place, brep in enumerate(breps):
        attributes = rhino.ObjectAttributes()
        attributes.Name = names[place] if names else ""
        file.Objects.AddBrep(brep, attributes)
    return written(folder / "tubes.3dm", file)


def exact(shape):
    return BRepCheck_Analyzer(shape, True, False, True).IsValid()


@pytest.mark.parametrize(("apex", "round_v"), WAYS_ROUND)
@pytest.mark.parametrize(("unit", "factor"), [("Millimeters", 1.0), ("Meters", 1000.0)])
def test_face_with_a_seam_has_its_trims_whichever_way_its_surface_closes(tmp_path, apex, round_v, unit, factor):
    tube = Tube(apex=apex, round_v=round_v, radius=500.0 / factor, height=2000.0 / factor)
    brep = tube.brep()
    assert brep.IsValid
    assert exact(brep_faces(brep, rhino, factor).shape)
    (face,) = load_model(saved(tmp_path, brep, unit=unit)).faces()
    assert BRepCheck_Analyzer(face.face).IsValid()
    assert area_of(face.face) == pytest.approx(tube.area * factor**2, rel=AREA)
    assert off_border(face.face) <= ON_SURFACE
    assert not patch_of(face.face).whole


@pytest.mark.parametrize(("apex", "round_v"), WAYS_ROUND)
@pytest.mark.parametrize("where", PLACES)
@thorough
def test_face_with_a_seam_keeps_its_trims_in_a_block(tmp_path, apex, round_v, where):
    tube, (linear, factor), place = Tube(apex=apex, round_v=round_v), PLACES[where], rhino.Transform(1.0)
    for row in range(3):
        for column in range(3):
            setattr(place, f"M{row}{column}", float(linear[row, column]))
    place.M03 = 4000.0
    file = file_in()
    file.InstanceDefinitions.Add("tube", "", "", "", ORIGIN, (tube.brep(),), (rhino.ObjectAttributes(),))
    file.Objects.AddInstanceObject(rhino.InstanceReference(file.InstanceDefinitions[0].Id, place))
    (face,) = load_model(written(tmp_path / "block.3dm", file)).faces()
    assert BRepCheck_Analyzer(face.face).IsValid()
    assert area_of(face.face) == pytest.approx(factor * tube.area, rel=AREA)
    assert off_border(face.face) <= ON_SURFACE


def outwards(face):
    """Whether a face's normals point away from the axis."""
    patch = patch_of(face)
    middle = patch.at(0, np.array(0.5), np.array(0.5))
    return bool((patch.points(middle)[:2] @ patch.normals(middle)[:2]) > 0.0)


@pytest.mark.parametrize("round_v", [False, True])
def test_reversed_face_is_reversed(tmp_path, round_v):
    tube = Tube(round_v=round_v)
    one, other = (load_model(saved(tmp_path, tube.brep(reverse=turned))).faces()[0].face for turned in (False, True))
    assert outwards(one) != outwards(other)
    assert area_of(other) == pytest.approx(tube.area, rel=AREA)


def test_faces_of_one_polysurface_share_their_edges_and_surfaces_of_revolution_their_pace():
    cylinder = rhino.Cylinder(rhino.Circle(ORIGIN, 500.0), 2000.0)
    shape = brep_faces(rhino.Brep.CreateFromCylinder(cylinder, True, True), rhino, 1.0).shape
    assert exact(shape)
    assert len(list(ShapeSet(shapes_of(shape, TopAbs_EDGE)))) == 3  # two circles and the seam
    ball = brep_faces(rhino.Brep.CreateFromSphere(rhino.Sphere(ORIGIN, 300.0)), rhino, 1.0).shape
    assert exact(ball)
    assert area_of(ball) == pytest.approx(4.0 * np.pi * 300.0**2, rel=1e-7)


def test_trimmed_tube_is_divided_round(tmp_path):
    path = saved(tmp_path, Tube(wave=0.0).brep())
    panels = read_raw_panels(path, ReferenceSettings(grid=(4, 1))).panels
    areas = [sum(face.weights.sum() for face in panel.faces) for panel in panels]
    assert areas == pytest.approx([0.25 * Tube(wave=0.0).area] * 4, rel=1e-5)


def test_bad_face_is_left_out_with_a_note_unless_it_is_chosen(tmp_path):
    bad, good = Tube(slip=0.02).brep(), rhino.Brep.CreateFromSurface(bent_surface())
    path = saved(tmp_path, bad, good, names=("silo", "roof"))
    found = survey(path)
    (note,) = [note for note in found.notes if "left out" in note]
    assert re.fullmatch(r"Face 1 of 'tubes.3dm' cannot be read and is left out: a trimming curve runs beside .*", note)
    assert [face.number for face in found.faces] == [2]  # as Rhino counts
    cut = read_raw_panels(path, ReferenceSettings(divide=3))
    assert len(cut.panels) == 3
    assert note in cut.notes
    assert [panel.name for panel in read_raw_panels(path).panels] == ["roof"]
    for choice in ("1", "silo", "1-2"):
        with pytest.raises(ReferenceFileError, match=r"Face 1 of 'tubes.3dm' is chosen, and cannot be read: a trimm"):
            read_raw_panels(path, ReferenceSettings(faces=(choice,), divide=3))
    assert len(read_raw_panels(path, ReferenceSettings(faces=("roof",), divide=3)).panels) == 3


def test_file_of_bad_faces_only_is_measured_and_not_cut(tmp_path):
    path = saved(tmp_path, Tube(slip=0.02).brep(), Tube(slip=0.03).brep())
    found = survey(path)
    assert found.faces == ()
    assert any("2 faces of 'tubes.3dm' cannot be read and are left out, numbers 1, 2;" in note for note in found.notes)
    for settings in (ReferenceSettings(), ReferenceSettings(divide=3)):
        with pytest.raises(ReferenceFileError, match=r"'tubes.3dm' holds no face that can be read, as a trim"):
            read_raw_panels(path, settings)
