"""What is read from a STEP file: samples, products, names, units, places, and who meets whom."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeSphere
from OCP.Geom import Geom_BSplineSurface, Geom_CylindricalSurface
from OCP.gp import gp_Ax1, gp_Ax3, gp_Dir, gp_Pln, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer

from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files.names import unique_names
from cadpanel.brep.read import read_raw_panels, read_reference
from tests.reference_shapes import (
    Lip,
    compound,
    kernel_face,
    kernel_lip,
    ring,
    strip,
    write_plain,
    write_products,
)

MODELLED = 1e-3  # mm, to which the test's B-splines follow the formulas
CYLINDER_RADIUS = 500.0


def cylinder(fold=math.pi / 2, length=2000.0):
    axis = gp_Ax3(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0))
    return BRepBuilderAPI_MakeFace(Geom_CylindricalSurface(axis, CYLINDER_RADIUS), 0.0, fold, 0.0, length, 1e-6).Face()


def moved(shape, angle=0.7, shift=(100.0, -2000.0, 300.0)):
    turn, translation = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(1.0, 2.0, 3.0), gp_Dir(1.0, 2.0, -1.0)), angle)
    translation.SetTranslation(gp_Vec(*shift))
    return BRepBuilderAPI_Transform(shape, translation.Multiplied(turn), True).Shape()


def test_samples_lie_on_the_faces_with_exact_normals():
    (face,) = sample_faces(cylinder())
    np.testing.assert_allclose(np.linalg.norm(face.points[:, 1:], axis=1), CYLINDER_RADIUS, rtol=1e-13)
    np.testing.assert_allclose(
        np.abs(np.einsum("md,md->m", face.normals[:, 1:], face.points[:, 1:])), CYLINDER_RADIUS, rtol=1e-13
    )
    for edge, normals in zip(face.edges, face.edge_normals, strict=True):
        assert len(edge) >= 33
        assert len(edge) % 2 == 1
        np.testing.assert_allclose(np.linalg.norm(edge[:, 1:], axis=1), CYLINDER_RADIUS, rtol=1e-13)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, rtol=1e-13)


@given(fold=st.floats(0.2, 2.0), length=st.floats(200.0, 4000.0))
@settings(max_examples=15)
def test_weights_add_up_to_the_area_and_are_about_equal(fold, length):
    (face,) = sample_faces(cylinder(fold, length))
    assert face.weights.sum() == pytest.approx(CYLINDER_RADIUS * fold * length, rel=1e-9)
    assert 80 <= len(face.points) <= 180
    np.testing.assert_allclose(face.weights, face.weights.mean(), rtol=1e-6)


def test_samples_are_spread_by_area_whatever_the_parameters():
    blend = Lip(twist=0.0, taper=0.0)
    uneven = kernel_face(lambda u, v: blend(1.0 + (0.2 * u + 0.8 * u**2), v), (0.0, 1.0))
    (face,) = sample_faces(uneven)
    assert face.weights.max() < 2.0 * face.weights.min()
    samples = [len(part.points) for part in sample_faces(kernel_lip(Lip(flange=200.0, radius=400.0)))]
    assert samples[1] > 2 * samples[0]


def test_trimmed_face_is_sampled_inside_only():
    outline = BRepBuilderAPI_MakePolygon(gp_Pnt(), gp_Pnt(900.0, 0.0, 0.0), gp_Pnt(0.0, 300.0, 0.0), True).Wire()
    pane = BRepBuilderAPI_MakeFace(gp_Pln(), outline).Face()
    (face,) = sample_faces(pane)
    x, y = face.points[:, 0], face.points[:, 1]
    assert (x > 0.0).all()
    assert (y > 0.0).all()
    assert (x / 900.0 + y / 300.0 < 1.0).all()
    assert face.weights.sum() == pytest.approx(0.5 * 900.0 * 300.0, rel=1e-9)
    assert 60 <= len(face.points) <= 250
    assert len(face.edges) == 3


def test_pole_of_a_sphere_has_a_normal():
    octant = BRepPrimAPI_MakeSphere(300.0, 0.0, math.pi / 2, math.pi / 2).Shape()
    explorer = TopExp_Explorer(octant, TopAbs_FACE)
    (face,) = sample_faces(explorer.Current())
    assert len(face.edges) == 3
    for edge, normals in zip(face.edges, face.edge_normals, strict=True):
        assert np.abs(np.einsum("qd,qd->q", edge, normals)).min() == pytest.approx(300.0, rel=1e-6)


def test_products_keep_their_names_and_order(strip_file, lips):
    panels = read_raw_panels(strip_file).panels
    assert [panel.name for panel in panels] == [name for name, _ in lips]
    assert [len(panel.faces) for panel in panels] == [3, 3, 3, 3]


def test_reference_of_a_strip_follows_its_formulas(strip_file):
    reference = read_reference(strip_file)
    assert reference.source == "strip.step"
    assert [(seam.panels, seam.edges, seam.reversed) for seam in reference.seams] == [
        ((k, k + 1), (1, 0), False) for k in range(3)
    ]
    for panel, lip in zip(reference.panels, strip(4), strict=True):
        u, v = np.meshgrid([0.0, 3.0], [0.0, 1.0])
        np.testing.assert_allclose(
            panel.corners, lip(u, v)[:, ::-1] if panel.corners[0, 0, 1] > 0.0 else lip(u, v), atol=MODELLED
        )


def test_names_beyond_ascii_survive(folder, lips):
    names = ["Élément n° 1", "北 2", "Dach's {Süd}"]
    path = write_products(folder / "names.step", [(name, shape) for name, (_, shape) in zip(names, lips, strict=False)])
    assert [panel.name for panel in read_raw_panels(path).panels] == names


@pytest.mark.parametrize(("unit", "word"), [("INCH", "INCH"), ("M", "SI_UNIT($,.METRE.)")])
def test_units_of_the_file_become_millimetres(folder, lips, strip_file, unit, word):
    path = write_products(folder / f"{unit}.step", lips, unit)
    assert word in path.read_text()
    there, here = read_reference(path), read_reference(strip_file)
    for first, second in zip(there.panels, here.panels, strict=True):
        np.testing.assert_allclose(first.corners, second.corners, atol=1e-6)
        np.testing.assert_allclose(first.points, second.points, atol=1e-4)
    assert there.seams == here.seams


def test_plain_compound_of_compounds_is_split_into_unnamed_panels(folder, lips):
    path = write_plain(folder / "plain.step", compound(shape for _, shape in lips))
    reference = read_reference(path)
    assert [panel.name for panel in reference.panels] == ["panel 1", "panel 2", "panel 3", "panel 4"]
    assert len(reference.seams) == 3


def test_plain_compound_of_faces_is_one_panel(folder, lips):
    (panel,) = read_raw_panels(write_plain(folder / "faces.step", lips[0][1])).panels
    assert (panel.name, len(panel.faces)) == ("panel 1", 3)


def test_several_plain_shapes_are_as_many_panels(folder, lips):
    path = write_plain(folder / "several.step", *(shape for _, shape in lips))
    assert [len(panel.faces) for panel in read_raw_panels(path).panels] == [3, 3, 3, 3]


def test_single_faces_are_panels(folder):
    faces = [(f"face {index}a", kernel_face(lip, poles=40)) for index, lip in enumerate(strip(3))]
    assert len(read_reference(write_products(folder / "single.step", faces)).seams) == 2


@pytest.mark.parametrize("library", ["cadquery", "build123d"])
def test_assemblies_of_both_libraries_are_flattened_with_places_and_names(folder, library):
    lip = kernel_lip(Lip(twist=0.0, taper=0.0))
    path = folder / f"{library}.step"
    if library == "cadquery":
        import cadquery as cq

        assembly = cq.Assembly(name="roof")
        inner = cq.Assembly(name="north")
        inner.add(cq.Shape.cast(lip), name="first")
        inner.add(cq.Shape.cast(lip), name="second", loc=cq.Location((2000.0, 0.0, 0.0)))
        assembly.add(inner, loc=cq.Location((0.0, 0.0, 500.0)))
        assembly.export(str(path))
    else:
        import build123d as bd

        first = bd.Compound(lip, label="first")
        second = bd.Compound(moved(lip, 0.0, (2000.0, 0.0, 0.0)), label="second")
        roof = bd.Compound(children=[first, second], label="roof").moved(bd.Location((0.0, 0.0, 500.0)))
        bd.export_step(roof, path)
    reference = read_reference(path)
    assert [panel.name for panel in reference.panels] == ["first", "second"]
    assert len(reference.seams) == 1
    assert min(panel.corners[..., 2].max() for panel in reference.panels) == pytest.approx(500.0, abs=MODELLED)


def test_file_order_does_not_matter_on_a_ring(folder):
    panels = [(f"lip {index}", kernel_lip(surface)) for index, surface in enumerate(ring(6))]
    path = write_products(folder / "ring.step", [panels[k] for k in (3, 0, 5, 1, 4, 2)])
    reference = read_reference(path)
    assert len(reference.seams) == 6
    for seam in reference.seams:
        first, second = (int(reference.panels[panel].name[-1]) for panel in seam.panels)
        assert (first - second) % 6 in (1, 5)


def test_one_face_and_three_give_the_same_outline(folder):
    lip = Lip(radius=400.0)
    three, one = kernel_lip(lip), kernel_face(lip, poles=40)
    references = [
        read_reference(write_products(folder / f"cut {name}.step", [("lip", shape)]))
        for name, shape in (("three", three), ("one", one))
    ]
    np.testing.assert_allclose(references[0].panels[0].corners, references[1].panels[0].corners, atol=0.1)


@given(angle=st.floats(-3.0, 3.0), shift=st.sampled_from([0.0, 1e5, 1e8]))
@settings(max_examples=8)
def test_moving_the_file_moves_the_reference(folder, lips, angle, shift):
    path = write_products(folder / "moved.step", [(name, moved(shape, angle, (shift,) * 3)) for name, shape in lips])
    reference = read_reference(path)
    assert len(reference.seams) == 3
    assert any(reference.origin) == (shift > 1e6)
    assert np.abs(np.array(reference.origin) - shift).max() < 2e5
    still = read_reference(write_products(folder / "still.step", lips))
    for there, here in zip(reference.panels, still.panels, strict=True):
        assert there.length == pytest.approx(here.length, abs=1e-3)
        assert there.weights.sum() == pytest.approx(here.weights.sum(), rel=1e-6)


def test_equal_names_become_different():
    assert unique_names(["a", "a", "", "a (2)", "a", ""]) == ["a", "a (3)", "panel 3", "a (2)", "a (4)", "panel 6"]


def test_equal_names_with_other_geometry_are_both_kept(folder, lips):
    path = write_products(folder / "twins.step", [("lip", shape) for _, shape in lips[:2]])
    assert [panel.name for panel in read_reference(path).panels] == ["lip", "lip (2)"]


def test_nothing_is_printed(capfd, strip_file):
    read_reference(strip_file)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("grading", [1, 2, 3, 4])
def test_samples_lie_evenly_however_unevenly_the_parameters_run(grading):
    """A flat strip of 6 by 1 m whose knots crowd at one end."""
    count, degree = 24, 3
    poles = TColgp_Array2OfPnt(1, count, 1, 2)
    for i in range(count):
        for j in range(2):
            poles.SetValue(i + 1, j + 1, gp_Pnt(6000.0 * i / (count - 1), 1000.0 * j, 0.0))
    spans = count - degree
    surface = Geom_BSplineSurface(
        poles,
        reals(((np.arange(spans + 1) / spans) ** grading).tolist()),
        reals([0.0, 1.0]),
        integers([degree + 1, *([1] * (spans - 1)), degree + 1]),
        integers([2, 2]),
        degree,
        1,
    )
    (samples,) = sample_faces(BRepBuilderAPI_MakeFace(surface, 1e-6).Face())
    assert samples.weights.sum() == pytest.approx(6e6, rel=1e-4)
    assert samples.weights.max() < 3.0 * samples.weights.min()
    places = np.unique(np.round(samples.points[:, 0]))
    steps = np.diff([0.0, *places, 6000.0])
    assert steps.max() < 2.5 * steps.mean()


def reals(values):
    array = TColStd_Array1OfReal(1, len(values))
    for index, value in enumerate(values, start=1):
        array.SetValue(index, value)
    return array


def integers(values):
    array = TColStd_Array1OfInteger(1, len(values))
    for index, value in enumerate(values, start=1):
        array.SetValue(index, value)
    return array
