"""Curves that hover over a surface cut as those on it do, over joints, notches and holes as well."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.gp import gp_Pln, gp_Pnt

from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_raw_panels
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.brep.curves.test_drawn_curve import LENGTH, WIDTH, circle, cut, line, plate, polyline, raw
from tests.brep.cutting.test_by_network import curve
from tests.model_files import write_shape
from tests.reference_shapes import kernel_face

MIDDLE = 0.5 * LENGTH
RISE = 100.0


def halves():
    return compound_of(
        BRepBuilderAPI_MakeFace(gp_Pln(), low, high, 0.0, WIDTH).Face()
        for low, high in ((0.0, MIDDLE), (MIDDLE, LENGTH))
    )


def panel_areas(found):
    """mm^2, by which panels are told apart whatever they are called."""
    return sorted(sum(float(face.weights.sum()) for face in panel.faces) for panel in found.panels)


@pytest.mark.parametrize("height", [0.5, 2.0, 20.0])
@pytest.mark.parametrize(
    ("corners", "count"),
    [
        ([(3000, -10), (3000, 2010)], 2),
        ([(3000, -10), (3000, 1000), (6010, 1000)], 2),
        ([(1500, -10), (1500, 2200), (3000, 2200), (3000, -200), (4500, -200), (4500, 2010)], 4),
        ([(3000.0005, -10), (3000.0005, 2010)], 2),
    ],
    ids=["along the joint", "off the joint", "serpentine", "a hair beside"],
)
def test_lift_over_a_joint_changes_no_panel(tmp_path, corners, count, height):
    flat, lifted = (
        panel_areas(raw(tmp_path, halves(), [polyline(*[(*corner, z) for corner in corners])])) for z in (0.0, height)
    )
    assert len(flat) == count
    assert lifted == pytest.approx(flat, rel=1e-6)


def test_curve_in_the_plane_that_touches_a_joint_is_not_said_to_lie_off_it(tmp_path):
    t = np.linspace(-1.0, 1.0, 33)
    touching = curve(np.stack([MIDDLE - 1010.0 * t**2, 0.5 * WIDTH + 1010.0 * t, 0.0 * t], axis=1))
    found = raw(tmp_path, halves(), [touching])
    assert len(found.panels) >= 2
    assert not [note for note in found.notes if "off the surface" in note]


def test_curve_beside_the_outline_by_more_than_the_tolerance_leaves_nothing_on_it(tmp_path):
    across = line((1500, -10, 0), (1500, 2010, 0))
    beside = polyline((-10, -2, 2), (4500, -2, 2), (4500, 2010, 2))
    found = raw(tmp_path, halves(), [across, beside])
    assert len(found.panels) == 3


def notched():
    """The plate without its upper right quarter, which another face fills, a spline, so that the surfaces differ."""
    corners = ((0, 0), (LENGTH, 0), (LENGTH, 0.5 * WIDTH), (MIDDLE, 0.5 * WIDTH), (MIDDLE, WIDTH), (0, WIDTH))
    outline = BRepBuilderAPI_MakePolygon()
    for x, y in corners:
        outline.Add(gp_Pnt(x, y, 0.0))
    outline.Close()
    quarter = kernel_face(
        lambda u, v: np.stack([MIDDLE * (1.0 + u), 0.5 * WIDTH * (1.0 + v), 0.0 * u], axis=-1), (0, 1)
    )
    return compound_of([BRepBuilderAPI_MakeFace(outline.Wire(), True).Face(), quarter])


@pytest.mark.parametrize("height", [0.0, 2.0])
@pytest.mark.parametrize(
    ("first", "last"),
    [
        ((4500, -10), (4500, 2010)),
        ((4500, 2010), (6010, 1200)),
        ((-10, 300), (6010, 1800)),
        ((-10, 999), (6010, 1003)),
        ((-10, -10 / 3), (6010, 6010 / 3)),
    ],
    ids=["through both", "corner of the notch", "aslant", "hardly across the joint", "through the notch's corner"],
)
def test_curve_over_a_notch_cuts_what_fills_it_as_a_plate_without_one(tmp_path, first, last, height):
    across = line((*first, height), (*last, height))
    whole = panel_areas(raw(tmp_path, plate(), [across]))
    assert len(whole) == 2
    assert panel_areas(raw(tmp_path, notched(), [across])) == pytest.approx(whole, rel=1e-6)


def test_curve_in_a_hole_lies_over_no_surface(tmp_path):
    disc = circle((3000.0, 1000.0, 0.0), 500.0)
    ring = max((face for panel in cut([plate()], [disc]) for face in panel.faces), key=area_of)
    across, inside = line((-10, 1000, 0), (6010, 1000, 0)), line((2700, 1000, 0), (3300, 1000, 0))
    assert len(raw(tmp_path, ring, [across]).panels) == 2
    other = compound_of([ring, BRepBuilderAPI_MakeFace(gp_Pln(), LENGTH, 2 * LENGTH, 0.0, WIDTH).Face()])
    with pytest.raises(ReferenceFileError, match=r"Curve 2 .* lies over no surface of 'skin.brep': draw it"):
        raw(tmp_path, other, [across, inside])


def dome(u, v):
    return np.stack([LENGTH * u, WIDTH * v, RISE * np.sin(np.pi * u) * np.sin(np.pi * v)], axis=-1)


def mesh_file(path, columns, rows, corner=dome):
    """An OBJ mesh whose corners lie at even parameters of a surface."""
    u, v = np.meshgrid(np.arange(columns + 1) / columns, np.arange(rows + 1) / rows, indexing="ij")
    text = [f"v {x!r} {y!r} {z!r}" for x, y, z in corner(u, v).reshape(-1, 3).tolist()]
    for column in range(columns):
        for row in range(rows):
            first = column * (rows + 1) + row + 1
            text.append(f"f {first} {first + rows + 1} {first + rows + 2} {first + 1}")
    path.write_text("\n".join(text) + "\n")
    return path


@pytest.mark.parametrize("columns", [3, 4])
def test_mesh_cuts_a_dome_of_two_faces_as_it_cuts_one_of_one(tmp_path, columns):
    mesh = mesh_file(tmp_path / "mesh.obj", columns, 2)
    found = []
    for name, ranges in (("one", [(0.0, 1.0)]), ("two", [(0.0, 0.5), (0.5, 1.0)])):
        skin = write_shape(tmp_path / f"{name}.brep", compound_of(kernel_face(dome, part) for part in ranges))
        found.append(panel_areas(read_raw_panels(skin, ReferenceSettings(unit="mm", mesh=mesh))))
    assert len(found[0]) == 2 * columns
    assert found[1] == pytest.approx(found[0], rel=1e-4)


def arch(rise):
    """The dome's shape with another rise."""
    return lambda u, v: dome(u, v) * np.array([1.0, 1.0, rise / RISE])


@pytest.mark.parametrize("rise", [100.0, 500.0, 1000.0])
@pytest.mark.parametrize(("columns", "rows"), [(3, 2), (4, 3)])
def test_coarse_mesh_cuts_a_roof_that_bends_well_between_its_corners(tmp_path, columns, rows, rise):
    surface = arch(rise)
    skin = write_shape(tmp_path / "skin.brep", kernel_face(surface, (0.0, 1.0)))
    mesh = mesh_file(tmp_path / "mesh.obj", columns, rows, surface)
    found = read_raw_panels(skin, ReferenceSettings(unit="mm", mesh=mesh))
    assert len(found.panels) == columns * rows


def test_mesh_that_lies_off_the_surface_is_refused_with_how_far(tmp_path):
    skin = write_shape(tmp_path / "skin.brep", kernel_face(dome, (0.0, 1.0)))
    mesh = mesh_file(tmp_path / "mesh.obj", 4, 2, lambda u, v: dome(u, v) + np.array([0.0, 0.0, 200.0]))
    with pytest.raises(ReferenceFileError, match=r"Corner \d+ of the mesh 'mesh.obj' lies 200 mm off 'skin.brep': lay"):
        read_raw_panels(skin, ReferenceSettings(unit="mm", mesh=mesh))
