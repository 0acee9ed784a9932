"""Further starts from shaken local fits, of which the best end counts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.fitting.methods.method import Fitted
from cadpanel.fitting.settings import FitSettings
from cadpanel.solver.stop import Stop

# Restarts shake the unknowns by this much (lengths in panel lengths, angles in radians); two ends agree within a share.
_SHAKE = 0.02
_AGREE = 0.01


def best_of_starts(
    solve: Callable[[Array], Fitted], score: Callable[[Array], float], local: Array, settings: FitSettings
) -> Fitted:
    """The end with the least score, and how many of all ends agree with it.

    Args:
        solve: from unknowns (panels, size) to an end.
        score: of an end's unknowns, above 0.
        local: the local fits: the first start; the others are these, shaken.
        settings: how many restarts, and the seed of the shaking.
    """
    random = np.random.default_rng(settings.seed)
    ends = [solve(local)]
    while len(ends) <= settings.restarts and ends[-1].stopped is not Stop.TOLD:
        ends.append(solve(local + _SHAKE * random.standard_normal(local.shape)))
    if len(ends) == 1:
        return ends[0]
    scores = np.array([score(end.unknowns) for end in ends])
    best = int(scores.argmin())
    agreed = int(np.sum(scores <= scores[best] * (1.0 + _AGREE)))
    return replace(ends[best], iterations=sum(end.iterations for end in ends), agreed=agreed, starts=len(ends))
