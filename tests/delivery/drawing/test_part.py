"""What is drawn of a flat part: one contour, tangent and centre lines, rulings at a pitch, marks that lie on it."""

import numpy as np
import pytest

from cadpanel.delivery.drawing.entities import Contour, Line, Text
from cadpanel.delivery.drawing.part import bend_lines, contours, neighbours_of, part_drawings, roll_lines
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.geometry.biarcs import arc_contour_area
from tests.flat_panels import panels
from tests.flat_parts import SHEET, parts_of, strip_records
from tests.shapes import folded_panel, random_panel


def inside(points, polygon):
    """Whether points lie inside of a polygon, by the turning number."""
    found = []
    for point in points:
        ways = polygon - point
        angles = np.unwrap(np.arctan2(*np.vstack([ways, ways[:1]]).T[::-1]))
        found.append(abs(angles[-1] - angles[0]) > 1.0)
    return np.array(found)


@pytest.mark.parametrize("name", ["plane-cone-plane", "tri-cone", "cylinder", "planar-rectangle", "polygon of 6"])
def test_the_contour_has_the_parts_area_within_the_chord_tolerance(name):
    parts = parts_of(panels(name, 2))
    for part, vertices in zip(parts, contours(parts, 0.01), strict=True):
        assert abs(arc_contour_area(vertices) - part.size.area) <= 0.01 * sum(part.size.pieces)


def test_a_fold_has_two_tangents_and_a_centre_line():
    (part,) = parts_of([folded_panel(radius=200.0, sweep=1.0, widths=(150.0, 250.0))])
    lines = bend_lines(part)
    assert lines[:, :, 0] == pytest.approx(np.array([[150.0] * 2, [348.5] * 2, [249.25] * 2]))
    assert lines[:, 1, 1] - lines[:, 0, 1] == pytest.approx(np.full(3, 1000.0))


def test_rulings_lie_at_most_a_pitch_apart_and_not_on_the_centre_line():
    (part,) = parts_of([folded_panel(radius=200.0, sweep=1.0, widths=(150.0, 250.0))])
    for pitch, count in ((50.0, 3), (198.5, 0), (99.25, 0), (20.0, 8)):
        lines = roll_lines(part, pitch)
        assert len(lines) == count - (count == 3)
        places = np.sort(np.concatenate([lines[:, 0, 0], [150.0, 249.25, 348.5]]))
        assert np.diff(places).max() <= max(pitch, 99.25) + 1e-9


def test_marks_lie_on_the_part_and_name_its_neighbours():
    records, seams, parts = strip_records()
    shop = ShopSettings()
    for part, record, drawing in zip(parts, records, part_drawings(parts, records, seams, SHEET, shop), strict=True):
        texts = {entity.words: entity for entity in drawing if isinstance(entity, Text) and entity.layer == "MARK"}
        met = set(neighbours_of(seams)[record.name].values())
        assert set(texts) == {record.name, "this face out", "side 0"} | met
        outline = part.pattern.curves.points(np.tile(np.linspace(0, 1, 50, endpoint=False), (8, 1))).reshape(-1, 2)
        assert inside([text.place for text in texts.values()], outline).all()
        side = texts["side 0"].place
        assert side[0] < texts[record.name].place[0]
        for name, text in texts.items():
            if name in met:
                edge = {other: edge for edge, other in neighbours_of(seams)[record.name].items()}[name]
                assert (text.place[1] < texts[record.name].place[1]) == (edge == "end 0")


def test_the_arrow_points_to_end_0():
    records, seams, parts = strip_records()
    drawing = part_drawings(parts, records, seams, SHEET, ShopSettings())[0]
    shaft, left, right = [e for e in drawing if isinstance(e, Line) and e.layer == "MARK"]
    assert shaft.stop[1] < shaft.start[1]
    assert left.stop == pytest.approx(shaft.stop)
    assert right.stop == pytest.approx(shaft.stop)
    assert min(left.start[1], right.start[1]) > shaft.stop[1]


def test_contour_only_leaves_everything_else_out_and_layers_can_be_renamed():
    records, seams, parts = strip_records()
    (only,) = {len(d) for d in part_drawings(parts, records, seams, SHEET, ShopSettings(dxf_contour_only=True))}
    assert only == 1
    drawing = part_drawings(parts, records, seams, SHEET, ShopSettings(dxf_layers=(("CUT", "0"), ("ROLL", "MARK"))))[0]
    assert {entity.layer for entity in drawing} == {"0", "BEND", "MARK", "INFO"}
    assert [entity.layer for entity in drawing if isinstance(entity, Contour)] == ["0"]


def test_what_is_no_mark_tells_the_bends_and_stands_beside_the_part():
    records, seams, parts = strip_records()
    drawing = part_drawings(parts, records, seams, SHEET, ShopSettings())[0]
    said = [entity for entity in drawing if isinstance(entity, Text) and entity.layer == "INFO"]
    words = " ".join(text.words for text in said)
    bend = parts[0].bends[0]
    for told in (
        records[0].name,
        "thickness 3 mm",
        f"inner radius {bend.radius[0]:.1f}",
        f"sweep {bend.sweep:.2f} deg",
    ):
        assert told in words
    lowest = parts[0].pattern.curves.start[:, 1].min()
    assert all(text.place[1] < lowest for text in said)


def test_texts_of_a_narrow_part_are_small_enough_for_it():
    shape = random_panel(1, chain="plane", name="a panel with quite a long name")
    (part,) = parts_of([shape])
    records, _, _ = strip_records()
    record = records[0].model_copy(update={"name": shape.name})
    (drawing,) = part_drawings([part], [record], [], SHEET, ShopSettings())
    name = next(e for e in drawing if isinstance(e, Text) and e.layer == "MARK" and e.words == shape.name)
    assert len(name.words) * name.height <= part.blank.height
