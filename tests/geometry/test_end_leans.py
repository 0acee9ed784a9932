"""How far walls at ends lean is extreme where it is said to be."""

import numpy as np
import pytest

from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.end_leans import leans
from cadpanel.geometry.patches import ConePatch
from tests.shapes import CHAINS, random_panel


@pytest.mark.parametrize("chain", sorted(CHAINS))
def test_no_place_of_an_end_leans_more_or_less_than_what_is_found(chain):
    for seed in range(4):
        shape = random_panel(seed, chain=chain)
        found = leans(shape.rulings(), shape.patches, shape.cut_normals[1])
        everywhere = list(shape.normals @ shape.cut_normals[1])
        for index, patch in enumerate(shape.patches):
            if isinstance(patch, ConePatch):
                frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
                everywhere += list(frame.normals(np.linspace(0.0, patch.sweep, 2001)) @ shape.cut_normals[1])
        assert max(found) == pytest.approx(max(everywhere), abs=1e-6)
        assert min(found) == pytest.approx(min(everywhere), abs=1e-6)
