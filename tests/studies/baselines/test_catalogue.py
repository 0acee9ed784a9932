"""Every baseline is measured alike: what is developable comes back, and each pays for a twisted lip in its own coin."""

from dataclasses import replace

import pytest

from cadpanel.errors import PanelError
from cadpanel.features.catalogue import feature
from cadpanel.studies.baselines.baseline import Outcome
from cadpanel.studies.baselines.catalogue import BASELINES
from tests.delivered import fitted, strip
from tests.instances import random_shapes
from tests.known_panels import alone

STRIPS = ("loft", "tangent planes", "cone strip")
ROLLED = alone(*random_shapes(feature("cone"), 5, 1))


@pytest.mark.parametrize("name", STRIPS)
def test_rolled_panels_come_back(name):
    found = BASELINES[name].run(ROLLED)
    assert found.panels == 1
    assert found.rms < 0.02
    assert found.largest < 0.3
    assert found.drift < 0.3
    assert found.warp < 0.2
    assert found.corner_gap == found.seam_gap == 0.0


def test_a_twisted_lip_costs_a_loft_warp_and_strips_gaps():
    two = replace(strip(), panels=strip().panels[:2], seams=strip().seams[:1])
    found = {name: BASELINES[name].run(two) for name in STRIPS}
    alone_, together = (Outcome.of(measures) for measures in (fitted().local, fitted().measures))
    assert found["loft"].warp > 0.5
    assert found["loft"].seam_gap < 0.1
    assert found["tangent planes"].warp == found["cone strip"].warp == 0.0
    assert found["tangent planes"].seam_gap > 1.5 * together.seam_gap
    # One linear system comes as near as fits of every panel alone; a loft, which sees only ends, does not.
    assert found["tangent planes"].rms == pytest.approx(alone_.rms, rel=0.15)
    assert found["tangent planes"].rms < found["cone strip"].rms < 2.0 * alone_.rms
    assert found["loft"].rms > 1.5 * alone_.rms


def test_the_methods_of_the_fit_stand_beside_them():
    found = BASELINES["local"].run(strip())
    assert found.rms == pytest.approx(fitted().local.overall_rms, rel=1e-3)
    assert found.corner_gap == pytest.approx(fitted().local.max_corner_gap, rel=1e-2)


def test_a_flat_panel_has_no_strip_and_is_named():
    with pytest.raises(PanelError, match="panel 1"):
        BASELINES["tangent planes"].run(alone(*random_shapes(feature("planar-rectangle"), 5, 1)))
