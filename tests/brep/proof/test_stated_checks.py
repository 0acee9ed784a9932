"""What a file says of a part must be what the report says, and what the kernel finds in the file."""

from dataclasses import replace

import pytest

from cadpanel.brep.building.mass_properties import area_and_centroid, volume_and_centroid
from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.proof.inspection import inspect
from cadpanel.brep.proof.stated_checks import check_stated
from cadpanel.brep.step.properties import PartData, Stated, Validation
from tests.shapes import random_panel

SOLID = build_solid(random_panel(1), 3.0)
VOLUME, MIDDLE = volume_and_centroid(SOLID)
AREA, _ = area_and_centroid(SOLID)
TRUE = Stated(
    area=AREA,
    volume=VOLUME,
    centroid=tuple(MIDDLE.tolist()),
    attributes={"mass": 2.5, "feature": "cone"},
)


def said(stated):
    numbers = Validation(area=stated.area, volume=stated.volume, centroid=stated.centroid)
    return PartData(number="n", validation=numbers, attributes=stated.attributes)


def failures(stated, wanted=TRUE):
    found: list[str] = []
    check_stated("solid", inspect("P", SOLID, stated), said(wanted), found)
    return found


def test_what_is_true_holds():
    found: list[str] = []
    assert check_stated("solid", inspect("P", SOLID, TRUE), said(TRUE), found) < 1e-12
    assert found == []


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"volume": VOLUME * (1 + 2e-9)}, "'volume' is"),
        ({"area": AREA * (1 - 2e-9)}, "'area' is"),
        ({"centroid": tuple((MIDDLE + 2e-6).tolist())}, "'centroid' is not the report's"),
        ({"volume": None}, "'volume' is missing"),
        ({"centroid": None}, "'centroid' is missing"),
        ({"attributes": {"mass": 2.6, "feature": "cone"}}, "attribute 'mass' is not the report's"),
        ({"attributes": {"mass": 2.5}}, "attribute 'feature' is not the report's"),
        ({"attributes": {**TRUE.attributes, "material": "x"}}, "attribute 'material' is not the report's"),
    ],
)
def test_what_is_not_the_reports_is_told(change, word):
    assert any("Panel 'P': its solid's" in one and word in one for one in failures(replace(TRUE, **change)))


@pytest.mark.parametrize("change", [{"volume": VOLUME + 1.0}, {"area": 1.0}, {"centroid": (0.0, 0.0, 0.0)}])
def test_what_file_and_report_agree_upon_must_be_the_kernels_too(change):
    (failure,) = failures(replace(TRUE, **change), replace(TRUE, **change))
    assert "is not the one that is stated as its validation property" in failure
