"""Lines that go on across seams, and how even they run."""

from dataclasses import replace

import numpy as np
import pytest

from cadpanel.reference.across_seams import across_seams, unevenness
from cadpanel.reference.model import Seam
from fixtures.arrays import reference
from fixtures.lips import Lip

PANELS = 5
FLAT = Lip(panels=PANELS, twist=(0.0,), plan=(0.0,), rise=(0.0,))
ALONG = np.array([1.0, 0.0, 0.0])


def strip(backwards=(), swapped=()):
    """A straight strip; some panels are walked from their other end, and some seams name their second panel first."""
    of = reference(FLAT)
    seams = []
    for i, seam in enumerate(of.seams):
        a, b = seam.panels
        on_a, on_b = (edge ^ (p in backwards) for p, edge in zip(seam.panels, seam.edges, strict=True))
        turned = (a in backwards) != (b in backwards)
        if i in swapped:
            seams.append(Seam(panels=(b, a), edges=(on_b, on_a), reversed=turned))
        else:
            seams.append(Seam(panels=(a, b), edges=(on_a, on_b), reversed=turned))
    return tuple(flipped(p) if i in backwards else p for i, p in enumerate(of.panels)), tuple(seams)


def flipped(panel):
    """The same panel walked from its other end."""
    order = (1, 0, 3, 2)
    return replace(
        panel,
        edges=tuple(panel.edges[i][::-1] for i in order),
        edge_normals=tuple(panel.edge_normals[i][::-1] for i in order),
    )


def drift(stations, backwards=()):
    """(panels, 4, 3) both corners of every station drift alike along the strip."""
    found = np.zeros((PANELS, 2, 2, 3))
    for i in range(PANELS):
        found[i] = np.array(stations)[[i, i + 1], None, None] * ALONG
        if i in backwards:
            found[i] = found[i, ::-1, ::-1]
    return found.reshape(PANELS, 4, 3)


@pytest.mark.parametrize("stations", [np.full(6, 7.0), 3.0 * np.arange(6.0)])
def test_panels_that_drift_alike_or_more_and_more_are_even(stations):
    found = unevenness(drift(stations), across_seams(*strip()))
    assert found == pytest.approx(np.zeros((PANELS - 1, 2)), abs=1e-12)


def test_a_zigzag_is_twice_its_height_off_the_middle():
    zigzag = 4.0 * (-1.0) ** np.arange(6)
    found = unevenness(drift(zigzag), across_seams(*strip()))
    assert found == pytest.approx(np.full((PANELS - 1, 2), 8.0), rel=1e-3)


@pytest.mark.parametrize(("backwards", "swapped"), [((1,), ()), ((0, 3), (2,)), ((), (0, 1, 2, 3)), ((2, 4), (1, 3))])
def test_neither_the_way_a_panel_is_walked_nor_which_is_named_first_matters(backwards, swapped):
    stations = np.array([0.0, 5.0, -2.0, 1.0, 4.0, 4.0])
    usual = unevenness(drift(stations), across_seams(*strip()))
    panels, seams = strip(backwards, swapped)
    turned = across_seams(panels, seams)
    # The corners of a seam stand in the order in which its lower panel has them.
    assert np.sort(unevenness(drift(stations, backwards), turned)) == pytest.approx(np.sort(usual), rel=1e-9)
    assert (turned.panels[:, 0] < turned.panels[:, 1]).all()


def test_what_goes_out_of_the_skin_is_no_unevenness():
    normals = across_seams(*strip()).normals
    off = np.zeros((PANELS, 4, 3))
    off[1] = 9.0 * normals[0, 0]  # one corner's normal: both corners of a straight seam have their own
    found = unevenness(off, across_seams(*strip()))
    assert found[0, 0] == pytest.approx(0.0, abs=1e-9)


def test_without_seams_nothing_is_uneven():
    panels, _ = strip()
    none = across_seams(panels, ())
    assert unevenness(np.zeros((PANELS, 4, 3)), none).shape == (0, 2)
