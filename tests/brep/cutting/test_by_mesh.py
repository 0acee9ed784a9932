"""Cuts by a mesh: one panel a face, however the mesh is written, and damaged ones refused."""

import re
from itertools import pairwise

import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.gp import gp_Pln

from cadpanel.brep.read import read_raw_panels
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.covering import assert_covers
from tests.model_files import STRIP, write_shape
from tests.reference_shapes import kernel_face
from tests.strip_cuts import quads, write_mesh


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("mesh")


@pytest.mark.parametrize("ending", [".obj", ".off"])
def test_mesh_makes_one_panel_a_face(folder, ending):
    face = kernel_face(STRIP, poles=40)
    skin = write_shape(folder / "skin.brep", face)
    mesh = write_mesh(folder / f"mesh{ending}", *quads(6, 4))
    found = read_raw_panels(skin, ReferenceSettings(unit="mm", mesh=mesh))
    assert {panel.name for panel in found.panels} == {f"S1-R0{r}-C0{c}" for r in range(1, 7) for c in range(1, 5)}
    assert_covers(found.panels, [face])


SQUARE = ((0, 0), (3000, 0), (3000, 2000), (0, 2000))


def off_text(header, after_corner="", after_faces=""):
    """The mesh of 3 by 2 faces over a plane of 9 by 4 m, 12 corners."""
    corners = [f"{3000 * i} {2000 * j} 0{after_corner}" for i in range(4) for j in range(3)]
    faces = [f"4 {k} {k + 3} {k + 4} {k + 1}" for i in range(3) for k in (3 * i, 3 * i + 1)]
    return "\n".join([header, *corners, *faces, after_faces])


def obj_text():
    corners = [f"v {3000 * i} {2000 * j} 0" for i in range(4) for j in range(3)]
    faces = [f"f {k} {k + 3} {k + 4} {k + 1}" for i in range(3) for k in (3 * i + 1, 3 * i + 2)]
    return "\n".join([*corners, *faces, ""])


def panels_of_plane(folder, text, **how):
    """A plane of 9 by 4 m cut by a mesh."""
    skin = write_shape(folder / "plane.brep", BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 9000.0, 0.0, 4000.0).Face())
    (folder / "mesh.obj").write_bytes(text.encode() if isinstance(text, str) else text)
    return read_raw_panels(skin, ReferenceSettings(unit="mm", mesh=folder / "mesh.obj", **how))


@pytest.mark.parametrize(
    "text",
    [
        off_text("OFF 12 6 0"),
        off_text("off\n12 6 0"),
        off_text("# a comment\nOFF # another\n# and one\n12 6 0"),
        off_text("OFF\n12 6 0", after_corner=" 255 0 0 255"),
        off_text("COFF\n12 6 0", after_corner=" 255 0 0 255"),
        off_text("STCNOFF\n12 6 0", after_corner=" 0 0 1 255 0 0 255 0.5 0.5"),
        off_text("OFF\n12 6 0", after_faces="2 0 1\n2 1 2\n"),
        "\ufeff" + off_text("OFF\n12 6 0"),
        "\ufeff" + obj_text(),
        "# C:\\panels\\\n" + obj_text(),
        obj_text().replace("f 1 4", "f 1 \\\n4").replace("\n", "\r\n"),
    ],
    ids=str.split("header lower comments colours COFF STCNOFF edges BOM-off BOM-obj comment-backslash CRLF"),
)
def test_mesh_is_read_as_other_programs_write_it(folder, text):
    assert len(panels_of_plane(folder, text).panels) == 6


def test_mesh_whose_faces_have_corners_of_their_own_is_welded_with_a_note(folder):
    corners = [(3000 * i + a, 2000 * j + b) for i in range(3) for j in range(2) for a, b in SQUARE]
    rows = [f"v {x} {y} {0.4 * (k % 2)}" for k, (x, y) in enumerate(corners)]
    rows += [f"f {k} {k + 1} {k + 2} {k + 3}" for k in range(1, len(corners), 4)]
    found = panels_of_plane(folder, "\n".join(rows))
    assert len(found.panels) == 6
    assert "12 corners of 'mesh.obj' lie within 1 mm of another one and count as one." in found.notes
    with pytest.raises(ReferenceFileError, match=r"has 6 faces, but the edges between them cut 'plane.brep' into"):
        panels_of_plane(folder, "\n".join(rows), seam_tolerance=0.1)


def bricks(shift=0.0):
    """Two rows of bricks over the plane of 9 by 4 m as an OBJ mesh, each with corners of its own.

    The corners of the upper row lie off the lower row's edges by `shift`, as a part of a brick's length.
    """
    rows: list[str] = []
    faces: list[str] = []
    for low, joints in ((0, (0, 3000, 6000, 9000)), (2000, (0, 1500, 4500, 7500, 9000))):
        for first, last in pairwise(joints):
            off = 3000.0 * shift if low else 0.0
            square = [(first, low + off), (last, low + off), (last, low + 2000), (first, low + 2000)]
            faces.append("f " + " ".join(str(len(rows) + k) for k in range(1, 5)))
            rows += [f"v {x} {y} 0" for x, y in square]
    return "\n".join([*rows, *faces])


def test_edges_of_a_mesh_are_parted_at_the_corners_of_other_faces_on_them(folder):
    found = panels_of_plane(folder, bricks())
    assert len(found.panels) == 7
    areas = sorted(sum(face.weights.sum() for face in panel.faces) for panel in found.panels)
    assert areas == pytest.approx(2 * [3e6] + 5 * [6e6])
    assert any(re.match(r"\d edges of 'mesh.obj' are parted where corners", note) for note in found.notes)


def test_corners_beside_an_edge_part_nothing(folder):
    with pytest.raises(ReferenceFileError, match="over the surface"):
        panels_of_plane(folder, bricks(shift=0.1))


def test_face_of_a_mesh_with_two_corners_in_one_place_loses_one(folder):
    text = obj_text().replace("v 3000 2000 0", "v 3000 2000 0\nv 3000 2000 0")
    moved_on = re.sub(r"\d+", lambda number: str(int(number[0]) + (int(number[0]) > 5)), text[text.index("f") :])
    text = text[: text.index("f")] + moved_on.replace("f 1 4 5 2", "f 1 4 5 6 2")
    assert len(panels_of_plane(folder, text).panels) == 6


def test_mesh_of_one_face_makes_one_panel(folder):
    corners = [f"v {3 * a} {2 * b} 0" for a, b in SQUARE]
    assert [panel.name for panel in panels_of_plane(folder, "\n".join([*corners, "f 1 2 3 4"])).panels] == ["S1-01"]


def test_mesh_of_two_faces_apart_is_refused(folder):
    corners = [f"v {a + shift} {2 * b} 0" for shift in (0, 6000) for a, b in SQUARE]
    with pytest.raises(ReferenceFileError, match=r"has 2 faces, but the edges .* into 1 panels: lay the mesh over"):
        panels_of_plane(folder, "\n".join([*corners, "f 1 2 3 4", "f 5 6 7 8"]))


@pytest.mark.parametrize(
    ("factor", "sentence"),
    [
        (0.001, r"The edge from corner \d+ to \d+ of 'mesh.obj' .*lay the mesh over .* unit with --unit"),
        (0.0001, r"Face 1 of 'mesh.obj' has fewer than three corners, .* within 1 mm .* unit with --unit"),
        (0.9, r"The edge from corner \d+ to \d+ of 'mesh.obj' separates no two panels near .*: lay the mesh over"),
    ],
)
def test_mesh_that_is_too_small_or_in_another_unit_is_refused_with_its_edge_and_the_unit(folder, factor, sentence):
    text = re.sub(r"\d{4}", lambda number: str(factor * int(number[0])), obj_text())
    with pytest.raises(ReferenceFileError, match=sentence):
        panels_of_plane(folder, text)


def test_mesh_that_leaves_a_part_of_the_surface_out_is_refused(folder):
    skin = write_shape(folder / "skin.brep", kernel_face(STRIP, poles=40))
    corners, faces = quads(6, 4)
    mesh = write_mesh(folder / "part.obj", corners, faces[:-4])
    with pytest.raises(ReferenceFileError, match=r"separates no two panels|must reach the outline of the surface"):
        read_raw_panels(skin, ReferenceSettings(unit="mm", mesh=mesh))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("v 0 0 0\n", "is no OBJ or OFF mesh with faces"),
        ("v 0 0\nf 1 1 1\n", "damaged OBJ or OFF mesh"),
        ("v 0 0 x\n", "damaged OBJ or OFF mesh"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n", "Face 1 of 'bad.obj' has fewer than three different corners"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n", "corners that are not numbers"),
        ("OFF\n9 1 0\n0 0 0\n", "breaks off before its last corner"),
        ("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "breaks off before its last corner or face"),
        ("OFF\n3\n", "does not say how many corners and faces it has"),
        ("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "a corner has fewer than three coordinates"),
        ("v 0 0 0\nv 1 0 0\nf 0 1 2\nv 0 1 0\n", "Face 1 of 'bad.obj' has fewer than three different corners, or one"),
        ("v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\nf 1 2 3\nf 1 2 3\n", "3 faces of 'bad.obj' share the edge"),
    ],
)
def test_damaged_mesh_is_refused(folder, text, sentence):
    skin = write_shape(folder / "plane.brep", BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 9.0, 0.0, 9.0).Face())
    (folder / "bad.obj").write_text(text)
    with pytest.raises(ReferenceFileError, match=sentence):
        read_raw_panels(skin, ReferenceSettings(unit="mm", mesh=folder / "bad.obj"))
