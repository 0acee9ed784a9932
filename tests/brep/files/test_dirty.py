"""Dirty files: mended with a note, or refused with the face and a remedy, and never a wrong panel without a word."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeSphere
from OCP.gp import gp_Pnt, gp_Trsf
from OCP.TopAbs import TopAbs_FACE

from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.model import Label
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.read import read_raw_panels, read_reference
from cadpanel.brep.skin.face_cleanup import find_doubles
from cadpanel.errors import CadpanelError
from cadpanel.reference.settings import ReferenceSettings
from tests.known_faces import creased_face
from tests.model_files import STRIP, Labelled, strip_faces, write_labelled, write_shape
from tests.reference_shapes import Lip, kernel_face
from tests.strip_cuts import across, quads, write_mesh

LIP = Lip(length=6000.0, twist=1.0, taper=0.02)
FAR = (8.3e8, -2.1e8, 4.0e5)


def moved(shape, by):
    shift = gp_Trsf()
    shift.SetTranslation(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(*by))
    return BRepBuilderAPI_Transform(shape, shift, True).Shape()


def how(unit="mm", **settings):
    return ReferenceSettings(unit=unit, **settings)


def test_map_grid_coordinates_give_the_same_panels_and_a_note(tmp_path):
    faces = compound_of(strip_faces(LIP))
    near = read_reference(write_shape(tmp_path / "near.brep", faces), how(divide=3))
    far = read_reference(write_shape(tmp_path / "far.brep", moved(faces, FAR)), how(divide=3))
    assert near.notes == ()
    (note,) = far.notes
    assert "km from its origin; all coordinates here are less by (8" in note
    for here, there in zip(near.panels, far.panels, strict=True):
        assert here.name == there.name
        assert there.length == pytest.approx(here.length, abs=1e-4)
        there_in_the_model = there.corners + np.array(far.origin)
        assert np.abs(there_in_the_model - FAR - here.corners).max() < 1e-3
    assert near.origin == (0.0, 0.0, 0.0)
    assert far.seams == near.seams


def test_mesh_beside_a_model_far_away_is_moved_with_it(tmp_path):
    corners, faces = quads(6, 2)
    mesh = write_mesh(tmp_path / "mesh.obj", corners + FAR, faces)
    path = write_shape(tmp_path / "far.brep", moved(kernel_face(STRIP, poles=40), FAR))
    assert len(read_raw_panels(path, how(mesh=mesh)).panels) == 12


@pytest.mark.parametrize("way", ["network", "spine"])
def test_curves_in_a_file_beside_a_model_far_away_are_moved_with_it(tmp_path, way):
    path = write_shape(tmp_path / "far.brep", moved(compound_of(strip_faces()), FAR))
    line = BRepBuilderAPI_MakeEdge(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(STRIP.length, 0.0, 0.0)).Edge()
    curves = write_shape(tmp_path / "curves.brep", moved(across(0.4) if way == "network" else line, FAR))
    stations = {"stations": (2000.0,)} if way == "spine" else {}
    assert len(read_raw_panels(path, how(**{way: curves}, **stations)).panels) == 2


def in_metres(shape):
    scaling = gp_Trsf()
    scaling.SetScale(gp_Pnt(0.0, 0.0, 0.0), 1e-3)
    return BRepBuilderAPI_Transform(shape, scaling, True).Shape()


def write(path, shape):
    """Write a shape drawn in mm: STEP says so, .brep is in metres and says nothing."""
    if path.suffix == ".step":
        return write_labelled(path, [(Label(name="skin"), shape, [])])
    return write_shape(path, in_metres(shape))


@pytest.mark.parametrize("names", [("skin.brep", "curves.step"), ("skin.step", "curves.brep"), ("a.brep", "b.brep")])
@pytest.mark.parametrize("way", ["network", "spine"])
def test_unit_counts_for_each_file_that_has_none(tmp_path, names, way):
    skin = write(tmp_path / names[0], compound_of(strip_faces()))
    line = BRepBuilderAPI_MakeEdge(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(STRIP.length, 0.0, 0.0)).Edge()
    curves = write(tmp_path / names[1], across(0.4) if way == "network" else line)
    stations = {"stations": (2000.0,)} if way == "spine" else {}
    found = read_raw_panels(skin, how(unit="m", **{way: curves}, **stations))
    assert len(found.panels) == 2
    assert not any("has no unit" in note for note in found.notes)


def test_unit_counts_for_a_mesh_beside_a_file_that_has_its_own(tmp_path):
    skin = write(tmp_path / "skin.step", kernel_face(STRIP, poles=40))
    corners, faces = quads(6, 2)
    mesh = write_mesh(tmp_path / "mesh.obj", 1e-3 * corners, faces)
    assert len(read_raw_panels(skin, ReferenceSettings(unit="m", mesh=mesh)).panels) == 12


@pytest.mark.parametrize("name", ["skin.step", "curves.step"])
def test_unit_where_every_file_has_its_own_is_refused(tmp_path, name):
    skin = write(tmp_path / "skin.step", compound_of([*strip_faces(), across(0.5)]))
    write(tmp_path / "curves.step", across(0.4))
    with pytest.raises(CadpanelError, match=rf"'{name}' says itself that its unit is the millimetre: leave the unit"):
        read_raw_panels(skin, ReferenceSettings(unit="m", network=tmp_path / name))


def test_second_file_without_a_unit_is_noted(tmp_path):
    skin = write(tmp_path / "skin.step", kernel_face(STRIP, poles=40))
    curves = write_shape(tmp_path / "curves.brep", across(0.4))
    mesh = write_mesh(tmp_path / "mesh.obj", *quads(6, 2))
    spine = BRepBuilderAPI_MakeEdge(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(STRIP.length, 0.0, 0.0)).Edge()
    line = write_shape(tmp_path / "line.brep", spine)
    for settings, said in (
        (ReferenceSettings(network=curves), "'curves.brep' has no unit, as no .brep has"),
        (ReferenceSettings(spine=line, stations=(2000.0,)), "'line.brep' has no unit, as no .brep has"),
        (ReferenceSettings(mesh=mesh), "'mesh.obj' has no unit, as no mesh has"),
    ):
        notes = read_reference(skin, settings).notes
        assert [note for note in notes if "has no unit" in note] == [f"{said}; it is read as millimetres."]


def test_inch_file_is_read_in_millimetres_whatever_the_format(tmp_path):
    parts: list[Labelled] = [(Label(name=f"f{k}"), face, []) for k, face in enumerate(strip_faces(LIP))]
    lengths = [
        [
            panel.length
            for panel in read_reference(
                write_labelled(tmp_path / name, parts, "INCH"), ReferenceSettings(divide=3)
            ).panels
        ]
        for name in ("inch.step", "inch.iges")
    ]
    np.testing.assert_allclose(lengths, 2000.0, rtol=0.02)


def test_three_hundred_control_points_each_way_are_cut(tmp_path):
    wavy = kernel_face(LIP, (0.0, 1.0), poles=300)
    panels = read_raw_panels(write_shape(tmp_path / "fine.brep", wavy), how(divide=4)).panels
    assert len(panels) == 4


def test_sphere_with_poles_and_seam_is_cut_by_a_grid_into_panels_that_cover_it(tmp_path):
    ball = BRepPrimAPI_MakeSphere(700.0).Shape()
    (face,) = shapes_of(ball, TopAbs_FACE)
    panels = read_raw_panels(write_shape(tmp_path / "ball.brep", face), how(grid=(6, 4))).panels
    assert len(panels) == 24
    area = sum(samples.weights.sum() for panel in panels for samples in panel.faces)
    assert area == pytest.approx(4.0 * np.pi * 700.0**2, rel=1e-3)


def test_flipped_and_doubled_faces_change_nothing_but_the_notes(tmp_path):
    faces = strip_faces(LIP)
    clean = read_reference(write_shape(tmp_path / "clean.brep", compound_of(faces)), how(divide=3))
    dirty = [faces[2].Reversed(), faces[0], faces[1], faces[1].Reversed()]
    read = read_reference(write_shape(tmp_path / "dirty.brep", compound_of(dirty)), how(divide=3))
    assert [panel.name for panel in read.panels] == [panel.name for panel in clean.panels]
    for here, there in zip(clean.panels, read.panels, strict=True):
        np.testing.assert_allclose(here.corners, there.corners, atol=1e-6)
    assert any("lies on face" in note for note in read.notes)


def test_solid_needs_its_outer_faces_chosen(tmp_path):
    ball = BRepPrimAPI_MakeSphere(700.0).Shape()
    path = write_shape(tmp_path / "ball.brep", ball)
    with pytest.raises(CadpanelError, match=r"holds a solid, of which face 1 is one: say which of its faces"):
        read_raw_panels(path, how(grid=(4, 4)))
    assert len(read_raw_panels(path, how(grid=(4, 4), faces=("1",))).panels) == 16


def test_curves_beside_faces_are_told(tmp_path):
    line = BRepBuilderAPI_MakeEdge(gp_Pnt(0.0, 0.0, 0.0), gp_Pnt(100.0, 0.0, 0.0)).Edge()
    path = write_shape(tmp_path / "both.brep", compound_of([compound_of(strip_faces(LIP)), compound_of([line])]))
    assert any("1 loose curve, which is no panel." in note for note in read_raw_panels(path, how()).notes)


def test_strip_that_is_none_is_refused_with_what_to_do(tmp_path):
    def blade(angle):
        way = np.array([np.cos(angle), np.sin(angle), 0.0])
        return lambda u, v: 1000.0 * v[..., None] * way + np.stack([0.0 * u, 0.0 * u, 500.0 * u], axis=-1)

    star = [kernel_face(blade(angle), (0.0, 1.0)) for angle in (0.0, 2.0, 4.0)]
    path = write_shape(tmp_path / "star.brep", compound_of(star))
    with pytest.raises(
        CadpanelError, match=r"The surface of faces 1, 2 and 3 of 'star.brep' is no strip that could be divided"
    ):
        read_raw_panels(path, how(divide=2))
    assert len(load_model(path, 1.0).faces()) == 3


@pytest.mark.parametrize(("angle", "told"), [(0.0, False), (0.2, False), (5.0, True), (60.0, True)])
def test_a_crease_inside_a_face_is_told(tmp_path, angle, told):
    notes = read_raw_panels(write_shape(tmp_path / "creased.brep", creased_face(angle)), how(grid=(1, 2))).notes
    assert any(f"has a crease of {angle:.3g} degrees inside" in note for note in notes) == told


def wavy(height, waves=1, poles=40):
    """A face of 6 x 6 m with a flat square for its border, and waves inside."""

    def surface(u, v):
        return np.stack(
            [6000.0 * u, 6000.0 * v, height * np.sin(waves * np.pi * u) * np.sin(waves * np.pi * v)], axis=-1
        )

    return kernel_face(surface, (0.0, 1.0), poles=poles)


@pytest.mark.parametrize("waves", [2, 4])
@pytest.mark.parametrize(("height", "double"), [(0.0, True), (0.5, True), (2.0, False), (40.0, False)])
def test_face_of_the_same_border_is_a_double_only_where_it_lies_on_the_other_inside(height, double, waves):
    faces = [wavy(0.0), wavy(height, waves)]
    for order in (faces, faces[::-1]):
        samples = [sample_faces(face)[0] for face in order]
        assert (find_doubles(samples, order, 1.0) == {1: 0}) is double


def test_curved_face_drawn_anew_in_other_parameters_is_a_double():
    def uneven(u, v):
        return LIP(3.0 * (0.3 * (u / 3.0) + 0.7 * (u / 3.0) ** 2), v)

    faces = [kernel_face(LIP, (0.0, 3.0), poles=60), kernel_face(uneven, (0.0, 3.0), poles=60)]
    for order in (faces, faces[::-1]):
        samples = [sample_faces(face)[0] for face in order]
        assert find_doubles(samples, order, 1.0) == {1: 0}
