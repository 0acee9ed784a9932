"""Profiles of a fit's seams: in the order of the seams, and as large as what is measured along each whole seam."""

import numpy as np
import pytest

from cadpanel.fitting.measures.profiles import seam_profiles
from tests.delivered import fitted


def test_profiles_show_what_is_measured_along_whole_seams():
    result = fitted()
    found = seam_profiles(result.shapes, result.reference.seams)
    assert len(found) == len(result.reference.seams)
    for what, measured in (
        ("gap", result.measures.seam_gap),
        ("step", result.measures.seam_step),
        ("kink", result.measures.kink),
    ):
        most = np.array([getattr(profile, what).max() for profile in found])
        assert most == pytest.approx(measured, rel=0.05)
        assert (most <= measured * (1.0 + 1e-9)).all()
    for profile, seam in zip(found, result.reference.seams, strict=True):
        first = result.shapes[min(seam.panels)].edge(f"end {seam.edges[int(np.argmin(seam.panels))]}").corners
        assert profile.points[[0, -1]] == pytest.approx(first[[0, -1]], abs=1e-6)
        assert profile.along[0] == 0.0
        assert (np.diff(profile.along) > 0.0).all()


def test_without_seams_there_are_no_profiles():
    assert seam_profiles(fitted().shapes, ()) == ()
