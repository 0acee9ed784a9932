"""Sheets with holes are exact solids of their formula's volume, on every feature, here and in the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.brep.building.sheet import build_panel, volume_of
from cadpanel.brep.proof.inspection import inspect
from cadpanel.brep.step.file import read_step_shapes, write_step
from cadpanel.delivery.settings import SheetSettings
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.geometry.volume import sheet_volume
from tests.built import area_of, exactly_valid
from tests.drilled import fixed
from tests.flat_panels import panels
from tests.thorough import cases

pytestmark = pytest.mark.each_value_once

NAMES = ("plane-cone-plane", "cylinder", *cases((), ("plane-cylinder-plane-cone-plane", "tri-cone")), "polygon of 5")
BOTH: list[tuple[float, SkinSide]] = [(3.0, "outer"), (12.0, "inner")]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("thickness", "side"), BOTH)
def test_a_sheet_with_holes_is_exact_here_and_in_the_file(
    name: str, thickness: float, side: SkinSide, tmp_path: Path
) -> None:
    shape = panels(name, 3)[0].straightened().shape
    fixings, holes = fixed(shape, SheetSettings(thickness=thickness, skin_side=side))
    built = build_panel(shape, thickness, side, holes)
    volume = sheet_volume(shape, thickness, side) - fixings.volume
    write_step(tmp_path / "a.step", [(shape.name, built.solid, None)], title="t")
    [(_, read)] = read_step_shapes(tmp_path / "a.step")
    rolled = sum(hole.place.frame is not None for hole in holes)
    for solid in (built.solid, read):
        assert exactly_valid(solid)
        assert volume_of(solid) == pytest.approx(volume, rel=2e-11)
        facts = inspect("p", solid)
        assert facts.closed
        assert len(facts.rims) == 2 * len(holes)
        assert facts.face_kinds["other"] == 2 * rolled
    assert area_of(built.skin) == pytest.approx(shape.area(), rel=1e-12)
    assert not len(inspect("p", built.skin).rims)
