"""What a shop gets of panels that are cut back for their joints: flat parts and bevels are those of the solids."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_panel
from cadpanel.brep.proof.inspection import inspect
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import write_report
from cadpanel.delivery.records.to_shape import recorded_shape
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from tests.joined_fits import FITS, cones, fitted


@pytest.mark.each_value_once
@pytest.mark.parametrize("name", [*FITS, "cones"])
@pytest.mark.parametrize("thickness", [3.0, 20.0])
def test_a_flat_part_has_the_area_that_the_kernel_finds_in_the_middle_of_the_sheet_that_is_cut_back(
    tmp_path: Path, name: str, thickness: float
) -> None:
    result = cones() if name == "cones" else fitted(name)
    sheet = SheetSettings(thickness=thickness, joint=12.0)
    report = deliver(result, tmp_path / "out", sheet, ShopSettings(outputs=("flats",)))
    whole = deliver(result, tmp_path / "whole", SheetSettings(thickness=thickness), ShopSettings(outputs=("step",)))
    for panel, before in zip(report.panels, whole.panels, strict=True):
        assert panel.blank is not None
        assert before.blank is not None
        middle = recorded_shape(panel, -thickness).offset(-0.5 * thickness)
        skin = inspect(panel.name, build_panel(middle, thickness, "outer").skin)
        assert panel.blank.area == pytest.approx(float(skin.areas.sum()), rel=1e-9)
        assert panel.blank.area < before.blank.area
    assert report.certificate.flat_area_error <= 1e-9
    assert report.certificate.flat_length_error <= 1e-6


@pytest.mark.parametrize("name", ["quadrilaterals", "hexagons"])
def test_bevels_at_seams_are_the_angles_between_joint_and_sheet(tmp_path: Path, name: str) -> None:
    report = deliver(fitted(name), tmp_path / "out", SheetSettings(joint=10.0), ShopSettings(outputs=("flats",)))
    panels = {panel.name: panel for panel in report.panels}
    told = {name: (tmp_path / "out" / "flat" / f"{name}.dxf").read_text() for name in panels}
    leaning = 0
    for seam in report.seams:
        assert seam.plane is not None
        for panel, edge, way in zip(seam.panels, seam.edges, (1.0, -1.0), strict=True):
            (patch,) = panels[panel].patches
            assert patch.kind == "plane"
            bevel = math.degrees(math.asin(way * np.dot(patch.normal, seam.plane.normal)))
            assert panels[panel].bevels[edge] == pytest.approx((bevel, bevel), abs=1e-6)
            leaning += abs(bevel) > 0.1
            if abs(bevel) > 0.1:
                assert f"{edge}: bevel {bevel:.1f} " in told[panel]
    assert leaning > len(report.seams)


def test_where_some_panels_are_delivered_the_joints_between_them_are_proved_and_others_are_not_told(
    tmp_path: Path,
) -> None:
    out, result = tmp_path / "out", fitted("lip")
    names = [panel.name for panel in result.reference.panels]
    chosen = {names[0], names[1], names[3]}
    report = deliver(result, out, SheetSettings(joint=10.0), ShopSettings(only=tuple(chosen)))
    whole = deliver(result, tmp_path / "whole", SheetSettings(joint=10.0))
    assert report.certificate.solids == len(chosen)
    # The ones that are delivered are cut for their neighbours all the same.
    assert report.panels == whole.panels
    for seam, all_there in zip(report.seams, whole.seams, strict=True):
        assert seam.clear == (all_there.clear if set(seam.panels) <= chosen else None)
    assert {seam.clear is None for seam in report.seams} == {True, False}
    assert verify(out).failures == ()


def test_a_bevel_or_another_face_in_the_report_that_is_not_the_panels_is_named(tmp_path: Path) -> None:
    out = tmp_path / "out"
    report = deliver(fitted("hexagons"), out, SheetSettings(joint=10.0), ShopSettings(outputs=("step",)))
    first, *others = report.panels
    square = first.model_copy(update={"bevels": {**first.bevels, "edge 0": (9.0, 9.0)}})
    (x, y, z), *corners = first.other_face[0]
    shrunk = first.model_copy(update={"other_face": (((x + 1.0, y, z), *corners),)})
    for changed, said in ((square, "bevel is not that"), (shrunk, "its flat pattern has an area of")):
        (out / REPORT).unlink()
        write_report(report.model_copy(update={"panels": (changed, *others)}), out / REPORT)
        assert any(f"Panel '{first.name}'" in fault and said in fault for fault in verify(out).failures)
