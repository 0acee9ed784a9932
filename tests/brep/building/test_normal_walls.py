"""Square sheets are exact solids of their formula's volume, as they are built and as they are read back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_panel, volume_of
from cadpanel.brep.proof.inspection import inspect
from cadpanel.brep.step.file import read_step_shapes, write_step
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape
from cadpanel.geometry.volume import sheet_volume
from tests.built import exactly_valid
from tests.chains import FEATURES
from tests.flat_panels import panels
from tests.thorough import cases

pytestmark = pytest.mark.each_value_once

NEAR = 1e-9  # mm


@pytest.mark.parametrize("name", cases(sorted(FEATURES)[::4], sorted(FEATURES)))
def test_a_square_sheet_is_exact_here_and_in_the_file(name: str, tmp_path: Path) -> None:
    for thickness, side, depth in ((3.0, "outer", -3.0), (12.0, "inner", 12.0)):
        shape = panels(name, 5)[0].squared(depth).straightened().shape
        built = build_panel(shape, thickness, side)  # type: ignore[arg-type]
        volume = sheet_volume(shape, thickness, side)  # type: ignore[arg-type]
        write_step(tmp_path / "a.step", [(shape.name, built.solid, None)], title="t")
        [(_, read)] = read_step_shapes(tmp_path / "a.step")
        for solid in (built.solid, read):
            assert exactly_valid(solid)
            assert volume_of(solid) == pytest.approx(volume, rel=1e-11)
            facts = inspect("p", solid)
            bent = sum(isinstance(patch, ConePatch) for patch in shape.patches)
            assert facts.closed
            assert facts.face_kinds["other"] == (2 * bent if isinstance(shape, PanelShape) else 0)
            corners = np.concatenate([face.corners().reshape(-1, 3) for face in (shape, shape.offset(depth))])
            assert np.linalg.norm(facts.vertices[:, None] - corners, axis=-1).min(axis=1).max() < NEAR
