"""A chain told in another frame is the same chain, and the start of a moved reference is the moved start."""

import numpy as np
import pytest

from cadpanel.features.catalogue import feature, polygon
from cadpanel.features.layout import Layout
from cadpanel.features.walk import walk
from cadpanel.fitting.samples import SampleArrays
from cadpanel.fitting.start.begin import start
from cadpanel.fitting.start.frames import reframe
from cadpanel.geometry.frames import cayley
from cadpanel.geometry.vectors import cross
from tests.instances import NAMES, random_polygon, random_shapes
from tests.known_panels import alone, moved

PANELS = 5
CHAINS = ["cylinder", "cone", "plane-cone-plane", "tri-cone", "plane-cone-cone-plane"]


def rulings(of, values, origins, axes):
    """Points (n, k + 1, 3) and directions of the rulings in the world."""
    edges = walk(of, values, derivatives=False).edges
    turn = np.swapaxes(axes, 1, 2)
    return edges.p @ turn + origins[:, None], edges.t @ turn


def apart(one, other):
    """The largest distance of the points of some rulings from the lines of others, and between their directions."""
    (p, t), (q, s) = one, other
    way = q - p
    aside = way - np.sum(way * t, axis=-1, keepdims=True) * t
    return float(np.linalg.norm(aside, axis=-1).max()), float(np.linalg.norm(t - s, axis=-1).max())


def told(of, seed, *, shift, turn, taper):
    """Chains in a frame, and what another one makes of their rulings."""
    random = np.random.default_rng(seed)
    values = np.zeros((PANELS, len(of.numbers)))
    for i, curved in enumerate(of.curved):
        at = of.patch_slice(i).start
        values[:, at] = random.uniform(0.1, 0.3, PANELS)
        values[:, at + 1] = taper * random.uniform(-1.0, 1.0, PANELS) if of.numbers[at + 1].fixed is None else 0.0
        if curved:
            values[:, at + 2] = random.uniform(0.2, 0.5, PANELS)
    axes = cayley(random.uniform(-1.0, 1.0, (PANELS, 3)))
    # The old frames are the anchor rulings themselves: nothing of them is in the numbers yet.
    old_axes = axes @ cayley(turn * random.uniform(-1.0, 1.0, (PANELS, 3)))
    offset = shift * random.uniform(-1.0, 1.0, (PANELS, 3))
    before = rulings(of, values, offset, old_axes)
    reframe(of, values, offset, old_axes, axes)
    return before, rulings(of, values, np.zeros((PANELS, 3)), axes)


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("taper", [0.0, 0.05])
def test_chains_are_told_exactly_in_another_frame(name, taper):
    before, after = told(feature(name), 3, shift=0.1, turn=0.2, taper=taper)
    assert max(apart(before, after)) <= 1e-12


def test_beyond_a_tapered_plane_they_are_told_up_to_the_square_of_the_taper():
    of = feature("plane-cone-plane-cone-plane")
    errors = [max(apart(*told(of, 3, shift=0.1, turn=0.1, taper=taper))) for taper in (0.0, 0.02, 0.04)]
    assert errors[0] <= 1e-12
    assert 1e-12 < errors[2] <= 0.1 * 0.04
    assert errors[1] <= 0.35 * errors[2]


@pytest.mark.parametrize("name", [*NAMES, "planar-polygon"])
def test_frames_stand_on_their_panels_and_look_outwards(name):
    features = PANELS * [polygon(5) if name == "planar-polygon" else feature(name)]
    known = [random_polygon(seed, 5) for seed in range(PANELS)] if name == "planar-polygon" else None
    reference = alone(*(known or random_shapes(feature(name), 7, PANELS)))
    length = float(np.mean([panel.length for panel in reference.panels]))
    begin = start(reference, Layout.of(features, length), SampleArrays.of(reference), length)
    b, t, n = (begin.axes[:, :, k] for k in range(3))
    assert cross(b, t) == pytest.approx(n, abs=1e-12)
    for i, panel in enumerate(reference.panels):
        assert np.linalg.norm(panel.points - begin.origins[i], axis=-1).min() <= 0.2 * length
        assert (panel.normals @ n[i]).mean() > 0.5
    for unknowns in begin.unknowns:
        assert np.isfinite(unknowns).all()


@pytest.mark.parametrize("name", NAMES)
def test_the_start_of_a_moved_reference_is_the_moved_start(name):
    reference = alone(*random_shapes(feature(name), 9, PANELS))
    turn, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    shift = np.array([2000.0, -3000.0, 1000.0])
    length = float(np.mean([panel.length for panel in reference.panels]))
    layout = Layout.of(PANELS * [feature(name)], length)
    one, other = (
        start(told_as, layout, SampleArrays.of(told_as), length)
        for told_as in (reference, moved(reference, turn, shift))
    )
    assert other.origins == pytest.approx(one.origins @ turn.T + shift, abs=1e-6)
    assert other.axes == pytest.approx(turn @ one.axes, abs=1e-9)
    for before, after in zip(one.unknowns, other.unknowns, strict=True):
        assert after == pytest.approx(before, abs=1e-6)
