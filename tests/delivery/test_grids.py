"""Deliveries of panels that meet all round: the proof holds on sides and on polygon edges, and tampering shows."""

from __future__ import annotations

from collections import Counter
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from cadpanel.brep.read import read_reference
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.report import ReportModel, read_report, write_report
from cadpanel.delivery.records.to_shape import recorded_shapes
from cadpanel.delivery.verify import verify
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from tests.grids import dome, write_grid, write_honeycomb
from tests.thorough import cases

# How the panels of each reference are bounded: faces of all solids, and edges at seams.
FACES = {
    "planar-quadrilateral": {"plane": 9 * 6, "cone": 0, "cylinder": 0, "other": 0},
    "cylinder": {"plane": 9 * 4, "cone": 0, "cylinder": 9 * 2, "other": 0},
    "planar-polygon": {"plane": 7 * 8, "cone": 0, "cylinder": 0, "other": 0},
}
every_case = pytest.mark.parametrize("name", FACES)
some_cases = pytest.mark.parametrize("name", cases([*FACES][1:], [*FACES]))


@cache
def fitted(name: str) -> FitResult:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "reference.step"
        if name == "planar-polygon":
            write_honeycomb(path, dome(20_000.0, 30_000.0, 0.01))
        elif name == "cylinder":
            write_grid(path, dome(60_000.0, 6000.0, 0.003))
        else:
            write_grid(path, dome(20_000.0, 30_000.0, 0.008))
        return fit(read_reference(path), FitSettings(feature=name))


@some_cases
def test_a_delivery_of_panels_that_meet_all_round_holds_its_proof(tmp_path: Path, name: str) -> None:
    report = deliver(fitted(name), tmp_path / "out")
    assert report.certificate.failures == ()
    assert report.certificate.face_kinds == FACES[name]
    assert report.certificate.volume_error < 1e-11
    assert report.certificate.max_seam_gap == pytest.approx(report.summary.max_seam_gap, abs=1e-5)
    assert report.summary.tolerance_met
    assert report.features == {name: len(report.panels)}
    assert check_report(report, recorded_shapes(report), report.certificate) == ()
    assert read_report(tmp_path / "out" / REPORT) == report
    assert verify(tmp_path / "out").holds


@some_cases
def test_seams_are_reported_by_the_edges_that_meet(tmp_path: Path, name: str) -> None:
    report = deliver(fitted(name), tmp_path / "out")
    sorts = Counter(edge.partition(" ")[0] for seam in report.seams for edge in seam.edges)
    assert sorts == ({"edge": 24} if name == "planar-polygon" else {"end": 12, "side": 12})


def tampered(report: ReportModel, **changes: object) -> ReportModel:
    """The report with other numbers in its first seam."""
    first = report.seams[0].model_copy(update=changes)
    return report.model_copy(update={"seams": (first, *report.seams[1:])})


@every_case
@pytest.mark.each_value_once
@pytest.mark.parametrize("change", ["another edge", "the other way round", "a narrower gap"])
def test_a_seam_that_was_changed_in_the_report_is_named(tmp_path: Path, name: str, change: str) -> None:
    report = deliver(fitted(name), tmp_path / "out")
    seam = report.seams[0]
    other = {"end 0": "end 1", "end 1": "end 0", "side 0": "side 1", "side 1": "side 0"}.get(seam.edges[0], "edge 1")
    every_change: dict[str, dict[str, object]] = {
        "another edge": {"edges": (other if other != seam.edges[0] else "edge 2", seam.edges[1])},
        "the other way round": {"reversed": not seam.reversed},
        "a narrower gap": {"max_seam_gap": max(seam.max_seam_gap - 1e-3, 0.0)},
    }
    (tmp_path / "out" / REPORT).unlink()
    write_report(tampered(report, **every_change[change]), tmp_path / "out" / REPORT)
    found = verify(tmp_path / "out")
    assert not found.holds
    assert any(f"Seam '{seam.panels[0]}' to '{seam.panels[1]}'" in failure for failure in found.failures)
