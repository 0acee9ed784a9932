"""Square walls in whole deliveries: proved from the files, behind the planes of joints, and flat as they are built."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from OCP.BRepExtrema import BRepExtrema_DistShapeShape

from cadpanel.brep.step.file import read_step_shapes
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import read_report, write_report
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.delivery.verify import verify
from cadpanel.geometry.bevels import edge_bevels
from cadpanel.geometry.sheet_checks import SkinSide
from tests.joined_fits import FITS, fitted
from tests.thorough import cases, thorough

CASES: list[tuple[float, float, SkinSide]] = [(10.0, 3.0, "outer"), (0.0, 20.0, "inner")]


@pytest.mark.parametrize("name", cases(["lip"], [*FITS]))
@pytest.mark.parametrize(("joint", "thickness", "skin_side"), cases(CASES[:1], CASES))
def test_square_sheets_keep_the_joint_free_and_are_proved_so(
    tmp_path: Path, name: str, joint: float, thickness: float, skin_side: SkinSide
) -> None:
    sheet = SheetSettings(thickness=thickness, joint=joint, skin_side=skin_side, ends="square")
    report = deliver(fitted(name), tmp_path / "out", sheet)
    assert verify(tmp_path / "out").holds
    certificate = report.certificate
    assert certificate.overlap is not None
    assert certificate.overlap <= 1e-6
    assert all(bevel == (0.0, 0.0) for panel in report.panels for bevel in panel.bevels.values())
    usual = SheetSettings(thickness=thickness, joint=joint, skin_side=skin_side)
    bevelled = build_panels(fitted(name).shapes, usual, fitted(name).reference.seams).panels
    for one, other in zip(report.panels, bevelled, strict=True):
        assert one.volume <= other.volume * (1.0 + 1e-9)
    leans = {one.shape.name: np.abs(list(edge_bevels(one.shape, one.other).values())).max() for one in bevelled}
    solids = dict(read_step_shapes(tmp_path / "out" / PANELS))
    for seam in report.seams:
        assert seam.clear is not None
        assert joint - 1e-6 <= seam.clear.least <= seam.clear.largest
        # No place is farther back than both walls lean off square on both faces.
        lean = sum(thickness * np.tan(leans[panel]) for panel in seam.panels)
        assert seam.clear.largest <= joint + 2.0 * lean + 0.3
        apart = BRepExtrema_DistShapeShape(*(solids[panel] for panel in seam.panels)).Value()
        assert apart >= joint - 1e-4


@thorough
def test_a_report_that_calls_bevelled_sheets_square_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    report = deliver(fitted(next(iter(FITS))), folder)
    write_report(
        report.model_copy(update={"settings": report.settings.model_copy(update={"ends": "square"})}), folder / REPORT
    )
    assert not verify(folder).holds
    assert read_report(folder / REPORT).settings.ends == "square"
