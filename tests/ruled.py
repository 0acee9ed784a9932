"""A strip that is nearly its own mirror image, for tests of rules, and fits of it under rules."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.rules.bends import bends_of
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from fixtures.arrays import reference
from fixtures.lips import Lip

NEARLY_SYMMETRIC = Lip(
    panels=4,
    twist=(1.0, -1.0),
    plan=(3.0,),
    rise=(1.0,),
    fold=(98.0,),
    radius=(480.0, 420.0),
    lower=(500.0,),
    upper=(600.0,),
)


@cache
def strip() -> Reference:
    """Four panels "N 1" to "N 4"; the last mirrors the first but for a tighter radius."""
    return reference(NEARLY_SYMMETRIC, "N")


def ruled(rules: dict[str, Any] | None, **how: Any) -> FitResult:
    """The strip under rules."""
    return fit(strip(), FitSettings(rules=rules, **how))  # type: ignore[arg-type] # as users may write them


@cache
def free() -> FitResult:
    """The strip without rules."""
    return ruled(None)


def radii(result: FitResult) -> Array:
    """(panels,) of the one bend of each panel, mm."""
    return np.asarray(bends_of(result.shapes)[:, 0, 0])
