"""A delivered panels.step in FreeCAD: solids, names, face kinds, validity, volumes and places."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.outputs.step_files import PANELS, SKINS, write_solids
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import ReportModel, read_report
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.features.catalogue import feature
from cadpanel.geometry.panel import Panel
from tests.delivered import fitted
from tests.freecad.importer import import_with_freecad
from tests.instances import NAMES, random_polygon, random_shapes

pytestmark = pytest.mark.freecad


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("freecad") / "delivery"
    deliver(fitted(), out)
    return out


@pytest.fixture(scope="module")
def report(folder: Path) -> ReportModel:
    return read_report(folder / REPORT)


@pytest.fixture(scope="module")
def solids(folder: Path) -> list[dict[str, Any]]:
    return import_with_freecad(folder / PANELS)


def test_every_panel_is_one_valid_closed_solid_under_its_name(
    solids: list[dict[str, Any]], report: ReportModel
) -> None:
    assert [thing["label"] for thing in solids] == [panel.name for panel in report.panels]
    assert all(thing["solids"] == 1 and thing["valid"] and thing["closed"] for thing in solids)


def test_every_panel_has_eight_planes_and_two_cones(solids: list[dict[str, Any]]) -> None:
    for thing in solids:
        assert Counter(thing["face_types"]) == {"Plane": 8, "Cone": 2}


def test_volumes_are_those_of_the_report(solids: list[dict[str, Any]], report: ReportModel) -> None:
    for thing, panel in zip(solids, report.panels, strict=True):
        assert thing["volume"] == pytest.approx(panel.volume, rel=1e-9)


def test_panels_stand_where_the_report_has_their_corners(solids: list[dict[str, Any]], report: ReportModel) -> None:
    for thing, panel in zip(solids, report.panels, strict=True):
        low, high = np.array(thing["bounding_box"])
        corners = np.array(panel.corners).reshape(-1, 3)
        assert (corners >= low - 1e-3).all()
        assert (corners <= high + 1e-3).all()


def test_skins_have_two_planes_and_one_cone_and_the_areas_of_the_report(folder: Path, report: ReportModel) -> None:
    skins = import_with_freecad(folder / SKINS)
    assert [thing["label"] for thing in skins] == [panel.name for panel in report.panels]
    for thing, panel in zip(skins, report.panels, strict=True):
        assert thing["solids"] == 0
        assert Counter(thing["face_types"]) == {"Plane": 2, "Cone": 1}
        assert thing["area"] == pytest.approx(panel.area, rel=1e-9)


def test_polygons_and_every_feature_arrive_as_valid_solids_of_their_volume(tmp_path: Path) -> None:
    shapes: list[Panel] = [random_polygon(1, corners) for corners in (3, 5, 6)]
    shapes += [replace(random_shapes(feature(name), 2, 1)[0], name=name) for name in NAMES]
    built = build_panels(shapes, SheetSettings()).panels
    write_solids(tmp_path / PANELS, built, "all")
    solids = import_with_freecad(tmp_path / PANELS)
    assert [thing["label"] for thing in solids] == [shape.name for shape in shapes]
    for thing, panel in zip(solids, built, strict=True):
        assert (thing["solids"], thing["valid"], thing["closed"]) == (1, True, True)
        assert thing["volume"] == pytest.approx(panel.volume, rel=1e-9)
    assert [Counter(thing["face_types"]) for thing in solids[:3]] == [{"Plane": 5}, {"Plane": 7}, {"Plane": 8}]
