"""Two deliveries are the same, or every panel that differs is named, with how much, and whether it is cut again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.diff import diff
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import ReportModel, read_report, write_report
from cadpanel.delivery.schedule.difference_rows import HEADINGS, difference_rows
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError, SettingsError
from tests.delivered import fitted, fitted_alone
from tests.thorough import thorough


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The same strip without and with joints, and fitted in another way."""
    place, shop = tmp_path_factory.mktemp("diff"), ShopSettings(outputs="step")
    deliver(fitted(), place / "whole", shop=shop)
    deliver(fitted(), place / "jointed", SheetSettings(joint=10.0), shop)
    deliver(fitted_alone(), place / "alone", shop=shop)
    drilled = ShopSettings(outputs="step", fixings=(6.5, 450.0, 40.0))
    deliver(fitted(), place / "drilled", SheetSettings(joint=10.0, ends="square"), drilled)
    return {name: place / name for name in ("whole", "jointed", "alone", "drilled")}


@pytest.fixture
def report(folders: dict[str, Path]) -> ReportModel:
    return read_report(folders["whole"] / REPORT)


def written(report: ReportModel, place: Path) -> Path:
    """A folder with a report alone: deliveries are compared by their reports."""
    place.mkdir()
    write_report(report, place / REPORT)
    return place


def renamed(report: ReportModel, name: str, to: str) -> ReportModel:
    def called(one: str) -> str:
        return to if one == name else one

    panels = [panel.model_copy(update={"name": called(panel.name)}) for panel in report.panels]
    seams = [
        seam.model_copy(update={"panels": (called(seam.panels[0]), called(seam.panels[1]))}) for seam in report.seams
    ]
    return report.model_copy(update={"panels": tuple(panels), "seams": tuple(seams)})


def elsewhere(report: ReportModel, offset: tuple[float, float, float]) -> ReportModel:
    return report.model_copy(update={"origin": report.origin.model_copy(update={"offset": offset})})


@thorough
def test_a_delivery_is_the_same_as_itself(folders: dict[str, Path]) -> None:
    found = diff(folders["whole"], folders["whole"])
    assert found.same
    assert {panel.status for panel in found.panels} == {"same"}
    assert {panel.contour for panel in found.panels} == {0.0}


def test_a_joint_takes_half_of_its_width_off_every_edge_on_a_seam(folders: dict[str, Path]) -> None:
    found = diff(folders["whole"], folders["jointed"])
    first, middle, last = found.panels
    for panel in found.panels:
        assert (panel.status, panel.cut_again, panel.features) == ("changed", True, None)
        assert panel.moved == pytest.approx(5.0, abs=0.5)
        assert panel.area is not None
        assert panel.mass is not None
        assert panel.mass < 0.0
    # Laid in the middle of the old contour an end alone misses by half of what a pair does.
    assert middle.contour == pytest.approx(5.0, abs=0.5)
    assert first.contour == pytest.approx(2.5, abs=1.0)
    assert last.area is not None
    assert middle.area == pytest.approx(first.area + last.area, rel=0.05) if first.area else False
    back = diff(folders["jointed"], folders["whole"]).panels[1]
    assert back.area == pytest.approx(-middle.area if middle.area else None)


def test_a_panel_that_hangs_elsewhere_is_not_cut_again(
    folders: dict[str, Path], report: ReportModel, tmp_path: Path
) -> None:
    found = diff(folders["whole"], written(elsewhere(report, (0.0, 300.0, 400.0)), tmp_path / "far"))
    for panel in found.panels:
        assert (panel.status, panel.cut_again, panel.bend_again) == ("moved", False, False)
        assert panel.moved == pytest.approx(500.0)


def test_a_panel_with_another_name_at_the_same_place_is_the_same_panel(
    folders: dict[str, Path], report: ReportModel, tmp_path: Path
) -> None:
    other = renamed(report, "N 2", "X")
    found = diff(folders["whole"], written(other, tmp_path / "other"))
    assert [(panel.before, panel.name, panel.status) for panel in found.panels] == [
        ("N 1", "N 1", "same"),
        ("N 2", "X", "renamed"),
        ("N 3", "N 3", "same"),
    ]
    far = diff(folders["whole"], written(elsewhere(other, (0.0, 0.0, 1.0)), tmp_path / "far"))
    assert [(panel.before, panel.name, panel.status) for panel in far.panels] == [
        ("N 1", "N 1", "moved"),
        (None, "X", "new"),
        ("N 3", "N 3", "moved"),
        ("N 2", "N 2", "gone"),
    ]
    assert [panel.cut_again for panel in far.panels] == [False, True, False, False]


@pytest.mark.parametrize("change", [{"thickness": 4.0}, {"material": "EN AW-5754"}])
def test_another_sheet_is_cut_and_bent_again(
    folders: dict[str, Path], report: ReportModel, tmp_path: Path, change: dict[str, object]
) -> None:
    panels = report.panels
    if "thickness" in change:  # the other face lies deeper
        panels = tuple(
            panel.model_copy(update={"other_face": deeper(panel.corners, panel.other_face, 4.0 / 3.0)})
            for panel in panels
        )
    settings = report.settings.model_copy(update=change)
    other = report.model_copy(update={"settings": settings, "panels": panels})
    found = diff(folders["whole"], written(other, tmp_path / "other"))
    assert found.sheet.keys() == change.keys()
    assert all(panel.cut_again and panel.bend_again for panel in found.panels)


def deeper(corners: object, other: object, factor: float) -> tuple[tuple[tuple[float, ...], ...], ...]:
    here, there = np.array(corners), np.array(other)
    return tuple(tuple(map(tuple, row)) for row in (here + factor * (there - here)).tolist())


def test_what_differs_less_than_the_tolerance_is_the_same_and_rows_tell_all(folders: dict[str, Path]) -> None:
    found = diff(folders["whole"], folders["alone"])
    largest = max(
        value
        for panel in found.panels
        for value in (panel.moved, panel.contour, panel.bend_lines, panel.radius)
        if value
    )
    assert largest > 1.0
    assert {panel.status for panel in found.panels} == {"changed"}
    wide = diff(folders["whole"], folders["alone"], tolerance=1.01 * largest)
    assert not any(panel.cut_again for panel in wide.panels)
    rows = difference_rows(found)
    assert rows[0] == HEADINGS
    assert {len(row) for row in rows} == {len(HEADINGS)}
    assert [row[0] for row in rows[1:]] == ["N 1", "N 2", "N 3"]


def test_what_cannot_be_compared_is_refused(folders: dict[str, Path], report: ReportModel, tmp_path: Path) -> None:
    with pytest.raises(DeliveryError, match="is not a folder: name one that 'cadpanel fit' wrote"):
        diff(folders["whole"], tmp_path / "none")
    with pytest.raises(SettingsError, match="tolerance must be a length above 0"):
        diff(folders["whole"], folders["whole"], tolerance=0.0)
    old = report.model_copy(update={"panels": tuple(p.model_copy(update={"blank": None}) for p in report.panels)})
    with pytest.raises(DeliveryError, match="without its rulings, cuts, blank"):
        diff(written(old, tmp_path / "old"), folders["whole"])


@pytest.mark.parametrize(
    ("fixings", "apart"),
    [((6.5, 450.0, 41.0), 1.0), ((7.0, 450.0, 40.0), None), ((6.5, 300.0, 40.0), None), (None, None)],
)
def test_a_blank_whose_holes_alone_changed_is_cut_again(
    folders: dict[str, Path], tmp_path: Path, fixings: tuple[float, float, float] | None, apart: float | None
) -> None:
    drilled = read_report(folders["drilled"] / REPORT)
    assert diff(folders["drilled"], folders["drilled"]).same
    settings = drilled.settings.model_copy(update={"fixings": fixings})
    found = diff(folders["drilled"], written(drilled.model_copy(update={"settings": settings}), tmp_path / "other"))
    for panel in found.panels:
        assert (panel.status, panel.cut_again, panel.bend_again, panel.contour) == ("changed", True, False, 0.0)
        if apart is None:
            assert panel.holes is None
        else:
            assert panel.holes is not None
            assert apart - 1e-6 <= panel.holes < 2.3 * apart  # holes begin twice as far from corners


def test_blanks_with_square_walls_are_compared_as_they_are_cut(folders: dict[str, Path]) -> None:
    reports = [read_report(folders[name] / REPORT) for name in ("jointed", "drilled")]
    for panel, *pair in zip(
        diff(folders["jointed"], folders["drilled"]).panels, *(r.panels for r in reports), strict=True
    ):
        areas = [one.blank.area for one in pair if one.blank is not None]
        assert panel.area == pytest.approx(areas[1] - areas[0], abs=1e-3)
