"""Fixing holes in a delivery: solid, flat pattern, drawing, tables and report tell of the same holes."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from ezdxf.filemanagement import readfile

from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.outputs.report_html import PAGE, ReportHtml
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.page.html import page_bytes, read_page
from cadpanel.delivery.page.packing import packed
from cadpanel.delivery.page.scene import scene_of
from cadpanel.delivery.pictures.files import scene_of_page
from cadpanel.delivery.records.report import ReportModel, write_report
from cadpanel.delivery.records.to_shape import recorded_shapes
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import contents_of, verify
from cadpanel.geometry.drilled_mesh import hole_count
from tests.delivered import fitted
from tests.thorough import cases, thorough

ASKED = ShopSettings(fixings=(9.0, cases(600.0, 300.0), 20.0), k_factor=0.42)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("fixings") / "out"
    deliver(fitted(), out, SheetSettings(ends="square", joint=8.0), ASKED)
    return out


@pytest.fixture(scope="module")
def report(folder: Path) -> ReportModel:
    found = verify(folder)
    assert found.holds, found.failures
    return found.report


def rows(path: Path) -> list[list[str]]:
    return list(csv.reader(path.read_text(encoding="utf-8-sig").splitlines()))


def test_the_holes_of_solids_drawings_and_tables_are_those_of_the_report(folder: Path, report: ReportModel) -> None:
    certificate, total = report.certificate, sum(len(panel.fixings) for panel in report.panels)
    assert certificate.holes == total > 30
    assert certificate.hole_error < 1e-9
    assert certificate.volume_error < 1e-9
    assert certificate.overlap == 0.0
    places = [row for row in rows(folder / "setting_out.csv") if row[1].startswith("fixing")]
    assert len(places) == total
    schedule = rows(folder / "schedule.csv")
    column = schedule[0].index("fixing holes")
    counts = [int(row[column]) for row in schedule if row and row[0] == "panel"]
    assert counts == [len(panel.fixings) for panel in report.panels]
    assert [row[5] for row in schedule if row and row[0] == "all panels"] == [str(total)]
    for panel in report.panels:
        assert panel.blank is not None
        drawing = readfile(folder / "flat" / f"{panel.blank.file}.dxf")
        circles = drawing.modelspace().query("CIRCLE[layer=='CUT']")
        drawn = np.array([[*circle.dxf.center.vec2, circle.dxf.radius] for circle in circles])
        assert drawn == pytest.approx(np.array([[*hole.flat, 4.5] for hole in panel.fixings]), abs=1e-6)
        own = [[float(number) for number in row[2:]] for row in places if row[0] == panel.name]
        points = np.array([hole.point for hole in panel.fixings]) + report.origin.offset
        assert np.array(own) == pytest.approx(points, abs=1e-4)


@thorough
def test_a_hole_that_the_report_has_elsewhere_or_not_at_all_is_seen(folder: Path, report: ReportModel) -> None:
    panel = report.panels[0]
    hole = panel.fixings[0]
    x, y, z = hole.point
    for fixings in (panel.fixings[1:], (hole.model_copy(update={"point": (x, y, z + 1e-5)}), *panel.fixings[1:])):
        changed = panel.model_copy(update={"fixings": fixings})
        write_report(report.model_copy(update={"panels": (changed, *report.panels[1:])}), folder / REPORT)
        assert "the report's fixing hole is not that of the panel" in " ".join(verify(folder).failures)
    write_report(report, folder / REPORT)


def test_the_page_shows_the_holes_and_one_without_them_is_seen(folder: Path, report: ReportModel) -> None:
    page = folder / PAGE
    panels = scene_of_page(page).panels
    assert [hole_count(panel.triangles) for panel in panels] == [len(panel.fixings) for panel in report.panels]
    was, shapes = page.read_bytes(), fitted().shapes
    numbers, shown = read_page(page)
    whole = packed(scene_of(fitted(), shapes, [shape.offset(-3.0) for shape in shapes]))
    contents = contents_of(report, recorded_shapes(report))
    page.write_bytes(page_bytes(contents.title, numbers, shown | whole))
    failures = ReportHtml().prove(folder, contents).failures
    page.write_bytes(was)
    assert sum("'report.html' does not show the" in said for said in failures) == len(report.panels)


@thorough
def test_a_circle_that_is_drawn_elsewhere_or_not_at_all_is_seen(folder: Path, report: ReportModel) -> None:
    blank = report.panels[0].blank
    assert blank is not None
    path = folder / "flat" / f"{blank.file}.dxf"
    was = path.read_bytes()
    begin = was.index(b"  0\r\nCIRCLE")
    for now, said in (
        (was.replace(b" 40\r\n4.5\r\n", b" 40\r\n4.50001\r\n", 1), "a circle on the layer that is cut is 1e-05 mm off"),
        (was[:begin] + was[was.index(b"  0\r\n", begin + 5) :], "circles on the layer that is cut instead of"),
    ):
        path.write_bytes(now)
        assert said in " ".join(verify(folder).failures)
    path.write_bytes(was)
