"""The names for many fits of one reference, from `import cadpanel as cp`."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import pytest

import cadpanel as cp
from cadpanel.brep.kernel.shapes import compound_of
from tests.delivered import strip
from tests.model_files import strip_faces, write_shape
from tests.reference_shapes import Lip

LIP = Lip(length=6000.0, twist=1.0, taper=0.02, flange=500.0, radius=300.0)
MM = cp.ReferenceSettings(unit="mm")


@pytest.fixture(scope="module")
def lip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_shape(tmp_path_factory.mktemp("strip") / "strip.brep", compound_of(strip_faces(LIP)))


def test_a_study_of_a_reference_has_a_row_for_each_gap_and_feature() -> None:
    study = cp.study(strip(), gaps=[3.0, 1.0, 3.0], features=["plane-cone-plane"], drift_along=0.04)
    assert [(row.gap_tolerance, row.panels, row.divide) for row in study.rows] == [(1.0, 3, None), (3.0, 3, None)]
    assert study.settings.drift_along == 0.04
    assert len(study.plot().axes) == 2


def test_a_study_of_a_file_cuts_it_into_each_number_of_panels(lip: Path) -> None:
    study = cp.study(lip, gaps=[5.0], divides=[2, 3], reading=MM)
    assert [(row.divide, row.panels) for row in study.rows] == [(2, 2), (3, 3)]


def test_a_reference_that_is_cut_already_is_not_cut_again() -> None:
    with pytest.raises(cp.SettingsError, match="is cut already"):
        cp.study(strip(), gaps=[1.0], divides=[2])
    with pytest.raises(cp.SettingsError, match="at least one gap and one feature"):
        cp.study(strip(), gaps=[])


def test_the_fewest_panels_hold_what_is_asked_and_say_what_was_tried(lip: Path) -> None:
    found = cp.fewest_panels(lip, reading=MM, gap_tolerance=5.0, max_deviation=12.0)
    assert found.held
    assert found.result.measures.max_deviation.max() <= 12.0
    assert found.result.reference.settings.divide == len(found.result.shapes)
    assert found.tried[0].count == found.least


def test_settings_of_another_kind_are_refused(lip: Path) -> None:
    wrong = cast(Any, 3)
    with pytest.raises(cp.SettingsError, match="must be FitSettings or None, not 3"):
        cp.study(strip(), gaps=[1.0], settings=wrong)
    with pytest.raises(cp.SettingsError, match="must be ReferenceSettings or None, not 3"):
        cp.fewest_panels(lip, reading=wrong, max_deviation=5.0)
