"""Every baseline by its name; one more is a file beside these and a line here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from cadpanel.fitting.settings import LIKE_THE_PAPER, Method, Weights
from cadpanel.studies.baselines.baseline import Baseline
from cadpanel.studies.baselines.cone_strip import ConeStrip
from cadpanel.studies.baselines.fitted import Fitted
from cadpanel.studies.baselines.lofted import Lofted
from cadpanel.studies.baselines.tangent_planes import TangentPlanes

# Steepest descent creeps on for minutes below this, mm, and gains little.
_TAU = 0.3
_DRIFT = 1e-3


def _fitted(method: Method, *, weights: bool = False) -> Fitted:
    return Fitted(replace(LIKE_THE_PAPER, method=method, tau=_TAU, weights=Weights(drift=_DRIFT) if weights else None))


BASELINES: Mapping[str, Baseline] = {
    "local": _fitted("local"),
    "two-stage": _fitted("two_stage"),
    "annealing": _fitted("annealing", weights=True),
    "weighted": _fitted("concurrent", weights=True),
    "concurrent": _fitted("concurrent"),
    "loft": Lofted(),
    "tangent planes": TangentPlanes(),
    "cone strip": ConeStrip(),
}
