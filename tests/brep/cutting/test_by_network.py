import re
from itertools import pairwise

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.Geom import Geom_BezierCurve
from OCP.GeomAbs import GeomAbs_C2
from OCP.GeomAPI import GeomAPI_PointsToBSpline
from OCP.gp import gp_Pln, gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt

from cadpanel.brep.cutting.panel_names import Link, place_names
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_raw_panels, read_reference
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import STRIP, strip_faces, write_shape
from tests.reference_shapes import kernel_face

LOST = 1e-3  # part of the area to which a panel's samples weigh it
POINTS = 41


def curve(points):
    array = TColgp_Array1OfPnt(1, len(points))
    for index, point in enumerate(points.tolist(), start=1):
        array.SetValue(index, gp_Pnt(*point))
    return BRepBuilderAPI_MakeEdge(GeomAPI_PointsToBSpline(array, 3, 8, GeomAbs_C2, 1e-4).Curve()).Edge()


def across(v, lift=0.0, start=0.0, stop=3.0):
    u = np.linspace(start, stop, POINTS)
    return curve(STRIP(u, np.full(POINTS, v)) + np.array([0.0, 0.0, lift]))


def along(u, start=0.0, stop=1.0):
    return curve(STRIP(np.full(POINTS, u), np.linspace(start, stop, POINTS)))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("network")


def raw(folder, faces, curves, **how):
    skin = write_shape(folder / "skin.brep", compound_of(faces))
    lines = write_shape(folder / "lines.brep", compound_of(curves))
    return read_raw_panels(skin, ReferenceSettings(unit="mm", network=lines, **how))


def weight(panel):
    return sum(face.weights.sum() for face in panel.faces)


def assert_covers(panels, faces):
    assert sum(map(weight, panels)) == pytest.approx(sum(map(area_of, faces)), rel=LOST)
    assert len({panel.name for panel in panels}) == len(panels)


@pytest.mark.parametrize("lift", [0.0, 0.003, 0.5])
def test_curves_near_a_strip_of_three_faces_cut_it_into_panels(folder, lift):
    faces = strip_faces()
    found = raw(folder, faces, [across(v, lift) for v in (0.2, 0.45, 0.8)])
    assert [panel.name for panel in found.panels] == ["S1-01", "S1-02", "S1-03", "S1-04"]
    assert [len(panel.faces) for panel in found.panels] == [3] * 4
    assert_covers(found.panels, faces)
    said = [re.search(r"lie up to ([\d.]+) mm off the surface", note) for note in found.notes]
    (offset,) = [float(match[1]) for match in said if match]
    # The curves themselves follow the formula to a tenth of a millimetre only.
    assert lift <= offset <= lift + 0.15


def test_curve_that_ends_farther_from_the_outline_than_the_tolerance_is_refused_until_that_is_raised(folder):
    faces = strip_faces()
    with pytest.raises(ReferenceFileError, match=r"separates no two panels near"):
        raw(folder, faces, [across(0.5, stop=2.997)])
    assert len(raw(folder, faces, [across(0.5, stop=2.997)], seam_tolerance=4.0).panels) == 2


def test_curve_that_sticks_out_beyond_another_one_by_less_than_the_tolerance_is_fine(folder):
    face = kernel_face(STRIP, poles=40)
    found = raw(folder, [face], [along(1.5), across(0.7, stop=1.5005)])
    assert len(found.panels) == 3
    assert_covers(found.panels, [face])
    assert all(len(edge) >= 33 for panel in found.panels for face in panel.faces for edge in face.edges)


def test_curve_along_the_border_between_two_faces_parts_them(folder):
    faces = strip_faces()
    found = raw(folder, faces, [along(1.0)])
    assert sorted(len(panel.faces) for panel in found.panels) == [1, 2]
    assert_covers(found.panels, faces)


def test_neighbours_share_their_ends(folder):
    faces = strip_faces()
    raw(folder, faces, [across(v) for v in (0.2, 0.45, 0.8)])
    reference = read_reference(folder / "skin.brep", ReferenceSettings(unit="mm", network=folder / "lines.brep"))
    assert [seam.panels for seam in reference.seams] == [(0, 1), (1, 2), (2, 3)]


def test_crossing_curves_cut_one_face_into_rows_and_columns(folder):
    face = kernel_face(STRIP, poles=40)
    found = raw(folder, [face], [*map(across, (0.2, 0.4, 0.6, 0.8)), along(1.0), along(2.0)])
    assert len(found.panels) == 15
    assert {panel.name for panel in found.panels} == {f"S1-R0{r}-C0{c}" for r in (1, 2, 3) for c in range(1, 6)}
    assert_covers(found.panels, [face])


def test_order_of_the_curves_changes_nothing(folder):
    face = kernel_face(STRIP, poles=40)
    curves = [across(0.3), across(0.7), along(1.5)]
    first, second = (raw(folder, [face], order).panels for order in (curves, curves[::-1]))
    assert [panel.name for panel in first] == [panel.name for panel in second]
    for one, other in zip(first, second, strict=True):
        assert weight(one) == pytest.approx(weight(other), rel=1e-9)


def test_curves_of_the_same_file_cut_its_surface(folder):
    faces = strip_faces()
    path = write_shape(folder / "both.brep", compound_of([compound_of(faces), across(0.5)]))
    found = read_raw_panels(path, ReferenceSettings(unit="mm", network=path))
    assert [panel.name for panel in found.panels] == ["S1-01", "S1-02"]


def test_curve_that_ends_inside_a_panel_is_refused_with_its_place(folder):
    face = kernel_face(STRIP, poles=40)
    with pytest.raises(
        ReferenceFileError, match=r"Curve 2 of 'lines.brep' separates no two panels near \(.*draw it on"
    ):
        raw(folder, [face], [across(0.3), across(0.7, stop=1.4)])


def test_curve_that_ends_at_another_one_is_fine(folder):
    face = kernel_face(STRIP, poles=40)
    found = raw(folder, [face], [along(1.5), across(0.7, stop=1.5)])
    assert len(found.panels) == 3
    assert_covers(found.panels, [face])


@pytest.mark.parametrize("meet", [0.999, 0.9997, 1.0, 1.0003, 1.001])
def test_curves_that_go_on_from_each_other_beside_a_border_leave_no_sliver(folder, meet):
    faces = strip_faces()
    parts = [np.linspace(0.0, meet, POINTS), np.linspace(meet, 3.0, POINTS)]
    found = raw(folder, faces, [curve(STRIP(u, 0.5 + 0.1 * np.sin(2.0 * u))) for u in parts])
    assert [panel.name for panel in found.panels] == ["S1-01", "S1-02"]
    assert_covers(found.panels, faces)


def test_curve_far_from_the_surface_and_file_without_curves_are_refused(folder):
    face = kernel_face(STRIP, poles=40)
    with pytest.raises(ReferenceFileError, match=r"Curve 1 of 'lines.brep' lies over no surface of 'skin.brep'"):
        raw(folder, [face], [across(0.3, lift=3000.0)])
    with pytest.raises(ReferenceFileError, match=r"'lines.brep' holds no loose curves, only faces"):
        raw(folder, [face], [face])


def quads(rows, columns, move=lambda u, v: (u, v)):
    """The corners of a grid over the strip's parameters, and its faces."""
    places = [(3.0 * r / rows, c / columns) for r in range(rows + 1) for c in range(columns + 1)]
    corners = np.array([STRIP(np.array(u), np.array(v)) for u, v in (move(*place) for place in places)])
    width = columns + 1
    faces = [
        (r * width + c, r * width + c + 1, (r + 1) * width + c + 1, (r + 1) * width + c)
        for r in range(rows)
        for c in range(columns)
    ]
    return corners, faces


def write_mesh(path, corners, faces):
    if path.suffix == ".off":
        rows = [" ".join(map(repr, corner)) for corner in corners.tolist()]
        rows += [" ".join(map(str, (len(face), *face))) for face in faces]
        path.write_text(f"OFF\n{len(corners)} {len(faces)} 0\n" + "\n".join(rows) + "\n")
    else:
        rows = ["v " + " ".join(map(repr, corner)) for corner in corners.tolist()]
        rows += ["f " + " ".join(f"{corner + 1}//1" for corner in face) for face in faces]
        path.write_text("# panels\n" + "\n".join(rows) + "\n")
    return path


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


@pytest.mark.parametrize("ends", [(0.0, 0.0), (0.02, 0.02), (0.3, 0.3), (0.9, 0.9), (0.0, 0.6), (0.0, -0.02)])
def test_panels_go_on_across_gaps_within_the_tolerance(folder, ends):
    """Two plates of 3 by 4 m side by side with a gap, of even width or a wedge, below zero where they overlap."""
    first = [(0, 0, 0), (3000, 0, 0), (3000, 4000, 0), (0, 4000, 0)]
    second = [(3000 + ends[0], 0, 0), (6000, 0, 0), (6000, 4000, 0), (3000 + ends[1], 4000, 0)]
    plates = [flat(first), flat(second)]
    found = raw(folder, plates, [straight((0, y, 0), (6000, y, 0)) for y in (1000, 2000, 3000)])
    assert [len(panel.faces) for panel in found.panels] == 4 * [2]
    assert sum(map(weight, found.panels)) == pytest.approx(24e6, rel=3e-4)
    how = ReferenceSettings(unit="mm", network=folder / "lines.brep")
    assert len(read_reference(folder / "skin.brep", how).seams) == 3


def test_panels_do_not_go_on_across_a_gap_beyond_the_tolerance(folder):
    plates = [flat([(x, 0, 0), (x + 3000, 0, 0), (x + 3000, 4000, 0), (x, 4000, 0)]) for x in (0.0, 3001.5)]
    found = raw(folder, plates, [straight((0, 2000, 0), (6100, 2000, 0))])
    assert [len(panel.faces) for panel in found.panels] == 4 * [1]


def flat(corners):
    polygon = BRepBuilderAPI_MakePolygon()
    for corner in corners:
        polygon.Add(gp_Pnt(*map(float, corner)))
    polygon.Close()
    return BRepBuilderAPI_MakeFace(polygon.Wire(), True).Face()


def straight(first, last):
    return BRepBuilderAPI_MakeEdge(gp_Pnt(*map(float, first)), gp_Pnt(*map(float, last))).Edge()


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


def test_curves_without_length_alone_are_refused(folder):
    point = TColgp_Array1OfPnt(1, 2)
    for place in (1, 2):
        point.SetValue(place, gp_Pnt(3000.0, 0.0, 0.0))
    dot = BRepBuilderAPI_MakeEdge(Geom_BezierCurve(point)).Edge()
    with pytest.raises(ReferenceFileError, match=r"'lines.brep' holds only curves without length: draw them again"):
        raw(folder, [kernel_face(STRIP)], [dot])


def test_surface_that_no_curve_passes_over_stays_whole(folder):
    beside = BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 9000.0, 20_000.0, 24_000.0).Face()
    found = raw(folder, [kernel_face(STRIP, poles=40), beside], [across(0.5)])
    assert len(found.panels) == 3


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


def grid_links(rows, columns):
    places = np.array([(100.0 * c, 60.0 * r, 0.0) for r in range(rows) for c in range(columns)])
    pairs = [(r * columns + c, r * columns + c + 1) for r in range(rows) for c in range(columns - 1)]
    pairs += [(r * columns + c, (r + 1) * columns + c) for r in range(rows - 1) for c in range(columns)]
    return places, [Link(panels=pair, middle=places[list(pair)].mean(axis=0), length=1.0) for pair in pairs]


def test_names_of_a_grid_bent_round_a_corner_are_rows_and_columns():
    places, links = grid_links(3, 8)
    turn = places[:, 0] / 300.0
    bent = np.stack([300.0 * np.sin(turn), places[:, 1], 300.0 * np.cos(turn)], axis=1)
    names = place_names(
        "S1", bent, [Link(panels=k.panels, middle=bent[list(k.panels)].mean(axis=0), length=1.0) for k in links]
    )
    assert len(set(names)) == 24
    assert {name.split("-")[1] for name in names} == {"R01", "R02", "R03"}


def test_names_where_panels_make_no_rows_are_numbers():
    places, links = grid_links(3, 3)
    odd = [*links, Link(panels=(0, 8), middle=places.mean(axis=0), length=1.0)]
    names = place_names("S1", places, odd)
    assert sorted(names) == [f"S1-0{k}" for k in range(1, 10)]


def test_names_of_a_ring_go_round():
    turn = np.linspace(0.0, 2.0 * np.pi, 6, endpoint=False)
    places = np.stack([100.0 * np.cos(turn), 100.0 * np.sin(turn), 0.0 * turn], axis=1)
    links = [Link(panels=(k, (k + 1) % 6), middle=places[k], length=1.0) for k in range(6)]
    names = place_names("S1", places, links)
    numbers = [int(name[-2:]) for name in names]
    steps = {(numbers[(k + 1) % 6] - numbers[k]) % 6 for k in range(6)}
    assert steps in ({1}, {5})
