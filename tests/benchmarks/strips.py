"""Long strips for the benchmarks: lips like the fixtures', of any number of panels, that neither end nor run away."""

from __future__ import annotations

import numpy as np

from fixtures.lips import Lip

# Knots of what varies along the strip, one for so many panels.
_PANELS_A_KNOT = 10


def long_lip(panels: int, seed: int = 0, *, plan: float = 6.0, rise: float = 1.0) -> Lip:
    """A lip whose twist swings to both sides; one-sided twist would add up over thousands of panels."""
    random = np.random.default_rng(seed)
    knots = max(3, panels // _PANELS_A_KNOT)

    def along(low: float, high: float) -> tuple[float, ...]:
        return tuple(float(value) for value in random.uniform(low, high, knots))

    return Lip(
        panels=panels,
        twist=along(-0.8, 0.8),
        plan=(plan,),
        rise=(rise,),
        fold=along(92.0, 100.0),
        radius=along(280.0, 420.0),
        lower=along(420.0, 520.0),
        upper=along(520.0, 640.0),
    )


def uneven_lip(panels: int, number: int, seed: int) -> Lip:
    """One of many lips of which no two are alike, not once round, to meet itself; some have spots hard to hold."""
    return long_lip(panels, seed * 1000 + number, plan=300.0 / max(panels, 50), rise=50.0 / max(panels, 50))
