"""A small strip that is fitted once for all tests of what comes out of it."""

from __future__ import annotations

from functools import cache

from cadpanel.fitting.result import FitResult
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from fixtures.arrays import reference
from fixtures.lips import Lip

LIP = Lip(
    panels=3,
    twist=(0.7, 1.1),
    plan=(6.0,),
    rise=(1.0,),
    fold=(100.0, 96.0),
    radius=(480.0, 430.0),
    lower=(500.0, 450.0),
    upper=(600.0, 550.0),
)
# Straight and all alike: every cone of it is a cylinder.
STRAIGHT = Lip(panels=2, twist=(0.0,), plan=(0.0,), rise=(0.0,), fold=(90.0,), radius=(300.0,), crown=0.0, fullness=1.0)


@cache
def strip() -> Reference:
    """Three panels, two seams."""
    return reference(LIP, "N")


@cache
def fitted() -> FitResult:
    """The strip under the default settings."""
    return fit(strip())


@cache
def fitted_alone() -> FitResult:
    """The strip with each panel fitted alone: it misses the default tolerance."""
    return fit(strip(), FitSettings(method="local"))
