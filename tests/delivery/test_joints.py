"""Joints in whole deliveries: the solids of the file are held against each other by the kernel, beside the proof."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from OCP.Bnd import Bnd_Box
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.building.sheet import build_panel, volume_of
from cadpanel.brep.read import read_reference
from cadpanel.brep.step.file import read_step_shapes
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.manifest import write_manifest
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.certified import ClearModel
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.report import ReportModel, read_report, write_report
from cadpanel.delivery.records.to_shape import recorded_shapes
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from cadpanel.errors import PanelError, SettingsError
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.sheet_checks import SkinSide
from tests.grids import dome, write_grid
from tests.joined_fits import FITS, bricks, cones, fitted
from tests.known_panels import ring as known_ring
from tests.known_panels import sampled
from tests.shapes import folded_panel, moved
from tests.thorough import cases, thorough

SHARED = 1e-6  # mm3 that the kernel may find in common of two solids that touch
MEASURED = 1e-4  # mm by which the kernel's distance may be off
WITHIN = 0.3  # mm that a joint may be wider than asked where panels fit exactly


def solids_of(folder: Path) -> dict[str, TopoDS_Shape]:
    return dict(read_step_shapes(folder / PANELS))


def box(shape: TopoDS_Shape) -> Bnd_Box:
    found = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, found, False, False)
    return found


def shared(solids: dict[str, TopoDS_Shape]) -> float:
    """The largest volume that the kernel finds in two of the solids."""
    boxes = {name: box(solid) for name, solid in solids.items()}
    volumes = [
        abs(volume_of(BRepAlgoAPI_Common(solids[one], solids[other]).Shape()))
        for one, other in combinations(solids, 2)
        if not boxes[one].IsOut(boxes[other])
    ]
    return max(volumes, default=0.0)


CASES: list[tuple[float, float, SkinSide]] = [(0.0, 3.0, "outer"), (0.0, 20.0, "inner"), (10.0, 20.0, "outer")]
CASES = cases(CASES[2:3], [*CASES, (20.0, 3.0, "inner")])


@pytest.mark.parametrize("name", cases(FITS[:2], FITS))
@pytest.mark.parametrize(("joint", "thickness", "skin_side"), CASES)
def test_joints_are_as_wide_as_asked_and_no_two_solids_share_volume(
    tmp_path: Path, name: str, joint: float, thickness: float, skin_side: SkinSide
) -> None:
    sheet = SheetSettings(thickness=thickness, joint=joint, skin_side=skin_side)
    report = deliver(fitted(name), tmp_path / "out", sheet)
    assert verify(tmp_path / "out").holds
    assert report.certificate.overlap == 0.0
    assert report.certificate.max_seam_gap == pytest.approx(report.summary.max_seam_gap, abs=1e-5)
    assert report.certificate.clear is not None
    assert report.certificate.clear.least == pytest.approx(joint, abs=1e-6)
    assert report.certificate.clear.largest <= joint + WITHIN
    solids = solids_of(tmp_path / "out")
    for seam in report.seams:
        assert seam.clear is not None
        assert joint - 1e-6 <= seam.clear.least <= seam.clear.largest <= joint + WITHIN
        apart = BRepExtrema_DistShapeShape(*(solids[panel] for panel in seam.panels)).Value()
        assert joint - MEASURED <= apart <= joint + WITHIN
    assert shared(solids) <= SHARED


@pytest.mark.parametrize(("joint", "thickness", "skin_side"), CASES)
@thorough
def test_bricks_have_a_joint_at_every_part_of_a_side(
    tmp_path: Path, joint: float, thickness: float, skin_side: SkinSide
) -> None:
    sheet = SheetSettings(thickness=thickness, joint=joint, skin_side=skin_side)
    report = deliver(bricks(junctions=True), tmp_path / "out", sheet)
    assert len(report.seams) == 11
    assert report.certificate.clear is not None
    assert report.certificate.clear.least == pytest.approx(joint, abs=1e-6)
    assert shared(solids_of(tmp_path / "out")) <= SHARED


@pytest.mark.parametrize(("joint", "thickness"), [(0.0, 60.0), (20.0, 40.0)])
def test_rows_of_bricks_that_have_no_seam_between_them_share_no_volume_either(
    tmp_path: Path, joint: float, thickness: float
) -> None:
    result, sheet = bricks(junctions=False), SheetSettings(thickness=thickness, joint=joint)
    square = [build_panel(panel.fitted, thickness).solid for panel in build_panels(result.shapes, sheet).panels]
    assert shared({str(i): solid for i, solid in enumerate(square)}) > 1000.0
    report = deliver(result, tmp_path / "out", sheet)
    assert len(report.seams) == 5
    assert shared(solids_of(tmp_path / "out")) <= SHARED


@pytest.mark.parametrize(("ends", "wider"), [("bevel", 0.0), ("square", 0.7)])
def test_between_cones_a_joint_is_as_wide_as_asked_along_the_whole_seam(
    tmp_path: Path, ends: Literal["bevel", "square"], wider: float
) -> None:
    report = deliver(cones(), tmp_path / "out", SheetSettings(joint=10.0, ends=ends))
    assert any(panel.side_cuts for panel in report.panels)
    for seam in report.seams:
        assert seam.clear is not None
        assert seam.clear.least == pytest.approx(10.0, abs=1e-6)
        # A square wall stands back by what it leans in at most: more at ends, along which that changes.
        assert seam.clear.largest <= 10.0 + (wider if seam.edges[0].startswith("side") else 2.0 * wider) + 1e-6


@thorough
def test_the_skins_are_cut_back_as_the_solids_are_and_gaps_stay_those_of_the_fit(tmp_path: Path) -> None:
    plain = deliver(fitted("lip"), tmp_path / "plain")
    wide = deliver(fitted("lip"), tmp_path / "wide", SheetSettings(joint=20.0))
    for one, other in zip(plain.panels, wide.panels, strict=True):
        assert one.fitted == other.fitted
        assert other.area < one.area
    for before, after in zip(plain.seams, wide.seams, strict=True):
        assert (before.max_seam_gap, before.recut, before.plane) == (after.max_seam_gap, after.recut, after.plane)
        assert before.recut is not None
        assert before.recut <= before.max_seam_gap
    assert wide.certificate.max_seam_gap == pytest.approx(plain.certificate.max_seam_gap, abs=1e-9)
    assert wide.settings.joint == 20.0


def test_the_ends_of_a_strip_stay_where_they_were(tmp_path: Path) -> None:
    report = deliver(fitted("lip"), tmp_path / "out", SheetSettings(joint=20.0))
    joined = {place for seam in report.seams for place in zip(seam.panels, seam.edges, strict=True)}
    free = [(panel, end) for panel in report.panels for end in (0, 1) if (panel.name, f"end {end}") not in joined]
    assert len(free) == 2
    for panel, end in free:
        assert panel.fitted is not None
        assert np.array(panel.corners[end]) == pytest.approx(np.array(panel.fitted.corners[end]), abs=1e-9)


def tampered(folder: Path, report: ReportModel) -> tuple[str, ...]:
    """What verify says once the report is replaced."""
    (folder / REPORT).unlink()
    write_report(report, folder / REPORT)
    write_manifest(folder)
    return verify(folder).failures


@thorough
def test_a_joint_in_the_report_that_is_not_the_files_is_named(tmp_path: Path) -> None:
    out = tmp_path / "out"
    report = deliver(fitted("lip"), out, SheetSettings(joint=10.0))
    first, *others = report.seams
    names = f"Seam '{first.panels[0]}' to '{first.panels[1]}'"
    wider = report.model_copy(update={"settings": report.settings.model_copy(update={"joint": 12.0})})
    assert f"{names}: the joint is only 10 mm wide, 12 mm were asked for." in tampered(out, wider)
    other = first.model_copy(update={"clear": ClearModel(least=10.0, largest=10.5)})
    changed = report.model_copy(update={"seams": (other, *others)})
    assert any(said.startswith(f"{names}: the joint is 10 to 10 mm wide") for said in tampered(out, changed))
    claimed = report.certificate.model_copy(update={"clear": ClearModel(least=10.0, largest=11.0)})
    found = check_report(
        report.model_copy(update={"certificate": claimed}), recorded_shapes(report), report.certificate
    )
    assert found == ("The certificate in the report says clear.largest = 11.0, the files show 10.0.",)
    assert tampered(out, report) == ()


def test_a_report_from_before_there_were_joints_says_nothing_of_them(tmp_path: Path) -> None:
    out = tmp_path / "out"
    report = deliver(fitted("lip"), out, shop=ShopSettings(outputs=("step",)))
    old = report.model_copy(
        update={
            "settings": report.settings.model_copy(update={"joint": None}),
            "seams": tuple(seam.model_copy(update={"clear": None, "plane": None}) for seam in report.seams),
            "certificate": report.certificate.model_copy(update={"clear": None, "overlap": None}),
        }
    )
    assert tampered(out, old) == ()
    assert read_report(out / REPORT).certificate.overlap is None


@pytest.mark.parametrize("joint", [-1.0, 1001.0, float("nan"), "wide"])
def test_a_joint_out_of_its_range_is_refused(joint: float) -> None:
    with pytest.raises(SettingsError, match="the joint must be"):
        SheetSettings(joint=joint)


def test_panels_too_small_for_their_joint_are_refused_with_a_width_that_can_be_delivered(tmp_path: Path) -> None:
    file = write_grid(tmp_path / "reference.step", dome(20_000.0, 30_000.0), count=5)
    result = fit(read_reference(file), FitSettings(feature="planar-quadrilateral", gap_tolerance=0.01))
    with pytest.raises(PanelError, match="is too small for a joint of 1000 mm all round: ask for one of at") as said:
        deliver(result, tmp_path / "out", SheetSettings(joint=1000.0))
    assert not (tmp_path / "out").exists()
    width = float(str(said.value).partition("at most ")[2].partition(" mm")[0])
    assert 800.0 < width < 900.0
    report = deliver(result, tmp_path / "out", SheetSettings(joint=width))
    assert report.certificate.failures == ()


def test_a_strip_that_closes_to_a_ring_has_a_joint_at_every_seam(tmp_path: Path) -> None:
    count, reach = 12, 6000.0
    half = np.pi / count
    lean = np.sin(half)
    panel = folded_panel(
        length=2.0 * reach * np.tan(half), cut_normals=((np.cos(half), -lean, 0.0), (np.cos(half), lean, 0.0))
    )
    cosine, sine = np.cos(2.0 * half), np.sin(2.0 * half)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    result = fit(known_ring(sampled(moved(panel, (0.0, -reach, 0.0)), "P"), count, turn))
    report = deliver(result, tmp_path / "out", SheetSettings(joint=10.0))
    assert len(report.seams) == count
    assert [seam.clear for seam in report.seams] == count * [ClearModel(least=10.0, largest=10.0)]
    assert shared(solids_of(tmp_path / "out")) == 0.0
