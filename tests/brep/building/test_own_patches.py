"""Panels of a user's own patches as exact solids and skins, in the kernel and read back from STEP."""

import numpy as np
import pytest

from cadpanel.features.feature import Feature
from cadpanel.features.patches import Patch, Plane
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from tests.built import assert_written_as_it_is, check_exact
from tests.instances import random_shapes
from tests.known_panels import alone
from tests.own_patches import AngleFirst, ByGirth, ByRoot, CurvedBy

CHAINS: list[tuple[Patch, ...]] = [
    (CurvedBy(),),
    (Plane(), CurvedBy(), Plane()),
    (AngleFirst(),),
    (ByRoot(), ByGirth(), ByRoot()),
    (ByRoot(turn=0.0),),
]


@pytest.mark.parametrize("patches", CHAINS, ids=lambda patches: "-".join(type(patch).__name__ for patch in patches))
def test_fitted_panels_of_own_patches_become_exact_solids_and_are_read_back(tmp_path, patches):
    of = Feature(*patches)
    known = random_shapes(of, 17, 2)
    found = fit(alone(*known), FitSettings(feature=of, method="local")).shapes
    for shape, expected in zip(found, known, strict=True):
        assert np.abs(shape.corners() - expected.corners()).max() <= 1e-9
        check_exact(shape, 3.0, "outer")
        assert_written_as_it_is(tmp_path / "a.step", shape)
