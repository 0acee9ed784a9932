"""What only the reference can tell is measured again on the panels of a report."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.records.measured_again import measured_faults, reading_again
from cadpanel.delivery.settings import SheetSettings
from cadpanel.errors import DeliveryError
from cadpanel.reference.settings import ReferenceSettings
from tests.delivered import fitted

OF_PANELS = (
    "rms_deviation",
    "max_deviation",
    "hausdorff",
    "max_corner_drift",
    "max_drift_along",
    "max_free_edge_drift",
    "outline_drift",
)
OF_SEAMS = ("width", "step", "shift", "turn", "unevenness", "max_kink")


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """With wide joints: panels are measured as they were fitted, and not as they were cut back."""
    return deliver(fitted(), tmp_path_factory.mktemp("again") / "out", SheetSettings(joint=40.0))


def test_what_was_measured_is_measured_again(report):
    assert list(measured_faults(report, fitted().reference)) == []


@pytest.mark.parametrize("key", OF_PANELS)
def test_a_number_of_a_panel_that_was_changed_is_named(report, key):
    panel = report.panels[1].model_copy(update={key: getattr(report.panels[1], key) + 1e-4})
    told = report.model_copy(update={"panels": (report.panels[0], panel, report.panels[2])})
    (said,) = measured_faults(told, fitted().reference)
    assert said.startswith(f"Panel 'N 2': the report's {key} is ")


@pytest.mark.parametrize("key", OF_SEAMS)
def test_a_number_of_a_seam_that_was_changed_is_named(report, key):
    seam = report.seams[0].model_copy(update={key: getattr(report.seams[0], key) + 1e-4})
    (said,) = measured_faults(report.model_copy(update={"seams": (seam, report.seams[1])}), fitted().reference)
    assert said.startswith(f"Seam 'N 1' to 'N 2': the report's {key} is ")


@pytest.mark.parametrize("key", ["rms_deviation", "drift_along_percent", "max_seam_turn", "least_radius"])
def test_a_number_of_the_summary_that_was_changed_is_named(report, key):
    worst = report.summary.model_copy(update={key: getattr(report.summary, key) + 1e-3})
    (said,) = measured_faults(report.model_copy(update={"summary": worst}), fitted().reference)
    assert said.startswith(f"The summary: the report's {key} is ")


def test_another_reference_is_told(report):
    of = fitted().reference
    named = replace(of, panels=tuple(replace(panel, name=f"{panel.name}b") for panel in of.panels))
    assert "gives other panels" in "".join(measured_faults(report, named))
    assert "has 1 seams, the report lists 2" in "".join(measured_faults(report, replace(of, seams=of.seams[:1])))


def test_a_reference_is_read_again_as_it_was_read(report):
    how: dict[str, Any] = {"divide": 4, "unit": "m", "faces": ("1", "3"), "lip": 300.0}
    stated = report.reference.model_copy(update={"reading": how})
    assert reading_again(stated, Path("roof.step")) == ReferenceSettings(**how)
    beside = report.reference.model_copy(update={"reading": {"network": "lines.step", "unit": "mm"}})
    assert reading_again(beside, Path("there/roof.step")).network == Path("there/lines.step")


def test_settings_of_reading_that_are_none_are_refused(report):
    for reading in ({"divided": 4}, {"divide": -4}):
        with pytest.raises(DeliveryError, match="does not say how its reference was read"):
            reading_again(report.reference.model_copy(update={"reading": reading}), Path("roof.step"))
