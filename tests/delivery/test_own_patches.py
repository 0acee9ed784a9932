"""A strip of a user's own patches is delivered with its proof, and the record says what it is made of."""

from pathlib import Path

import pytest

import cadpanel as cp
from tests.delivered import strip
from tests.own_patches import ByRoot, CurvedBy


def test_a_delivery_of_own_patches_holds_and_names_them(tmp_path: Path) -> None:
    of = cp.Feature(ByRoot(), CurvedBy(curvature=1 / 450.0), cp.Plane(), name="press brake")
    result = cp.fit(strip(), feature=of, gap_tolerance=5.0)
    report = cp.deliver(result, tmp_path / "out")
    assert report.summary.tolerance_met
    assert cp.verify(tmp_path / "out").holds
    assert report.settings.composition == tuple(map(repr, of.patches))
    for panel in report.panels:
        assert [patch.kind for patch in panel.patches] == ["plane", "cylinder", "plane"]
        cylinder = panel.patches[1]
        assert cylinder.kind == "cylinder"
        assert cylinder.radius_min == pytest.approx(450.0)
