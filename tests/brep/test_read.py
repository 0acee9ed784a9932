import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeSphere
from OCP.Geom import Geom_CylindricalSurface
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax3, gp_Circ, gp_Dir, gp_Pln, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer

from cadpanel.brep.read import read_raw_panels, read_reference, unique_names
from cadpanel.brep.sampling import sample_faces
from cadpanel.errors import PanelError, ReferenceFileError
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


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("read")


@pytest.fixture(scope="module")
def lips():
    return [(f"lip {index}", kernel_lip(lip)) for index, lip in enumerate(strip(4))]


@pytest.fixture(scope="module")
def strip_file(folder, lips):
    return write_products(folder / "strip.step", lips)


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
    panels = read_raw_panels(strip_file)
    assert [panel.name for panel in panels] == [name for name, _ in lips]
    assert [len(panel.faces) for panel in panels] == [3, 3, 3, 3]


def test_reference_of_a_strip_follows_its_formulas(strip_file):
    reference = read_reference(strip_file)
    assert reference.source == "strip.step"
    assert [(seam.panels, seam.ends, seam.reversed) for seam in reference.seams] == [
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
    assert [panel.name for panel in read_raw_panels(path)] == names


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
    (panel,) = read_raw_panels(write_plain(folder / "faces.step", lips[0][1]))
    assert (panel.name, len(panel.faces)) == ("panel 1", 3)


def test_several_plain_shapes_are_as_many_panels(folder, lips):
    path = write_plain(folder / "several.step", *(shape for _, shape in lips))
    assert [len(panel.faces) for panel in read_raw_panels(path)] == [3, 3, 3, 3]


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
    still = read_reference(write_products(folder / "still.step", lips))
    for there, here in zip(reference.panels, still.panels, strict=True):
        assert there.length == pytest.approx(here.length, abs=1e-3)
        assert there.weights.sum() == pytest.approx(here.weights.sum(), rel=1e-6)


def test_equal_names_become_different():
    assert unique_names(["a", "a", "", "a (2)", "a", ""]) == ["a", "a (3)", "panel 3", "a (2)", "a (4)", "panel 6"]


def test_equal_names_with_other_geometry_are_both_kept(folder, lips):
    path = write_products(folder / "twins.step", [("lip", shape) for _, shape in lips[:2]])
    assert [panel.name for panel in read_reference(path).panels] == ["lip", "lip (2)"]


def test_same_geometry_twice_is_refused(folder, lips):
    copy = BRepBuilderAPI_Transform(lips[0][1], gp_Trsf(), True).Shape()
    path = write_products(folder / "double.step", [*lips, ("copy", copy)])
    with pytest.raises(PanelError, match=r"Panel 'copy': in 'double.step', it lies on panel 'lip 0' to within 1 mm"):
        read_reference(path)


def refusal(path):
    with pytest.raises(ReferenceFileError) as caught:
        read_reference(path)
    message = str(caught.value)
    assert path.name in message
    assert "\n" not in message
    return message


def test_missing_file_folder_and_empty_file_are_refused(tmp_path):
    assert "does not exist" in refusal(tmp_path / "nothing.step")
    assert "is a folder" in refusal(tmp_path)
    (tmp_path / "empty.step").write_bytes(b" \n")
    assert "is empty" in refusal(tmp_path / "empty.step")


@pytest.mark.parametrize(
    ("content", "name"),
    [
        (" " * 72 + "S      1\n", "an IGES file"),
        ("3D Geometry File Format        8", "a Rhino 3dm file"),
        ("DBRep_DrawableShape\n", "an OCCT brep file"),
        ("solid part\nfacet normal", "an STL file"),
        ("PK\x03\x04....", "a ZIP archive"),
        ("panels: 3\n", "not a STEP file"),
    ],
)
def test_other_formats_are_refused_and_the_readable_ones_named(tmp_path, content, name):
    path = tmp_path / "reference.step"
    path.write_text(content)
    message = refusal(path)
    assert name in message
    assert "STEP files (AP203, AP214 or AP242" in message


def test_content_counts_and_not_the_extension(tmp_path, strip_file):
    path = tmp_path / "strip.txt"
    path.write_bytes(strip_file.read_bytes())
    assert len(read_reference(path).panels) == 4


def test_path_beyond_ascii_is_read(tmp_path, strip_file):
    path = tmp_path / "Dächer 北" / "Süd 1.step"
    path.parent.mkdir()
    path.write_bytes(strip_file.read_bytes())
    assert read_reference(path).source == "Süd 1.step"


def test_truncated_file_is_refused(tmp_path, strip_file):
    path = tmp_path / "cut.step"
    text = strip_file.read_bytes()
    path.write_bytes(text[: len(text) * 9 // 10])
    assert "breaks off before its end" in refusal(path)


@pytest.mark.parametrize("number", ["nan", "NaN", "-inf", "1.#QNAN", "1.E400"])
def test_coordinate_that_is_no_number_is_refused_with_its_place(tmp_path, strip_file, number):
    path = tmp_path / "nan.step"
    text, points = strip_file.read_text(), r"(#\d+) = CARTESIAN_POINT\('',\(([^,()]+),([^,()]+),"
    found = list(re.finditer(points, text))[40]
    path.write_text(text[: found.start(2)] + number + text[found.end(2) :])
    assert f"({number} at {found.group(1)})" in refusal(path)


def test_name_that_looks_like_no_number_is_only_a_name(folder, lips):
    path = write_products(folder / "name.step", [("panel (nan)", lips[0][1])])
    assert read_reference(path).panels[0].name == "panel (nan)"


def test_reference_to_a_missing_instance_is_refused(tmp_path, strip_file):
    path = tmp_path / "hole.step"
    path.write_text(re.sub(r"(ADVANCED_FACE\('',\(#\d+\),)#\d+", r"\1#999999", strip_file.read_text(), count=1))
    assert "is damaged" in refusal(path)


def test_face_that_the_kernel_cannot_build_is_refused(tmp_path, strip_file):
    path = tmp_path / "face.step"
    path.write_text(re.sub(r"(B_SPLINE_SURFACE_WITH_KNOTS\('',)\d+", r"\g<1>300", strip_file.read_text(), count=1))
    assert "a shape that the CAD kernel cannot read" in refusal(path)


@pytest.mark.parametrize(
    ("whole", "damaged"),
    [
        (r"(LINE\('',#\d+),#\d+\)", r"\1,$)"),
        (r"(LINE\('',)#\d+,(#\d+)\)", r"\1\2,\2)"),
        (r"LINE\('',#\d+,", r"LINE('',"),
        (r"= LINE\(", r"= LANE("),
        (r"(CARTESIAN_POINT\('',\()[^,]*,", r"\1'a',"),
        (r"(ADVANCED_FACE\('',\(#\d+\),)#\d+", r"\1#1"),
        (r"(EDGE_LOOP\('',)\([^)]*\)", r"\1($)"),
        (r"(ORIENTED_EDGE\('',\*,\*,)#\d+", r"\1$"),
        (r"PCURVE\('',#\d+", r"PCURVE('',$"),
        (r"(DEFINITIONAL_REPRESENTATION\('',\()#\d+", r"\1#1"),
    ],
)
def test_geometry_with_a_parameter_of_a_wrong_kind_is_refused(tmp_path, strip_file, whole, damaged):
    """The kernel crashes over some of them, and makes up numbers for the others."""
    text, count = re.subn(whole, damaged, strip_file.read_text(), count=1)
    assert count == 1
    path = tmp_path / "bent.step"
    path.write_text(text)
    assert "'bent.step' is damaged" in refusal(path)


def test_missing_names_do_no_harm(tmp_path, strip_file):
    path = tmp_path / "nameless.step"
    path.write_text(
        strip_file.read_text().replace("LINE('',", "LINE($,").replace("ADVANCED_FACE('',", "ADVANCED_FACE($,")
    )
    assert len(read_reference(path).panels) == len(read_reference(strip_file).panels)


def test_file_of_curves_is_refused(folder):
    circle = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(), 100.0)).Edge()
    assert "holds no faces, only curves" in refusal(write_products(folder / "curves.step", [("circle", circle)]))


def test_product_without_faces_beside_panels_is_refused_by_name(folder, lips):
    circle = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(), 100.0)).Edge()
    path = write_products(folder / "beside.step", [*lips, ("axis", circle)])
    with pytest.raises(PanelError, match=r"Panel 'axis': in 'beside.step', it holds no face"):
        read_reference(path)


def test_solid_block_is_refused_by_name(folder):
    path = write_products(folder / "block.step", [("block", BRepPrimAPI_MakeBox(100.0, 200.0, 300.0).Shape())])
    with pytest.raises(PanelError, match=r"Panel 'block': in 'block.step', it is a solid: export only the faces"):
        read_reference(path)


def test_sphere_is_refused_as_closed(folder):
    explorer = TopExp_Explorer(BRepPrimAPI_MakeSphere(500.0).Shape(), TopAbs_FACE)
    path = write_products(folder / "sphere.step", [("ball", explorer.Current())])
    with pytest.raises(PanelError, match=r"Panel 'ball': in 'sphere.step', it is a closed surface without an outline"):
        read_reference(path)


def test_saddle_is_refused_and_a_cylinder_passes(folder):
    def saddle(u, v):
        x, y = u / 1.5 - 1.0, 2.0 * v - 1.0
        return 1000.0 * np.stack([x, y, 0.3 * (x**2 - y**2)], axis=-1)

    path = write_products(folder / "saddle.step", [("saddle", kernel_face(saddle))])
    with pytest.raises(PanelError, match="like a sphere or a saddle"):
        read_reference(path)
    path = write_products(folder / "cylinder.step", [("roll", cylinder(math.radians(10.0)))])
    assert read_reference(path).panels[0].length == pytest.approx(2000.0)


def test_nothing_is_printed(capfd, strip_file):
    read_reference(strip_file)
    assert capfd.readouterr() == ("", "")
