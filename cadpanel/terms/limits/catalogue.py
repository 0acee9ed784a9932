"""The limits that panels keep to, in the order of the report's rows. A new one is a file of its own and a line here.

One that the user sets has a field in `FitSettings` besides, `name: float = limit_setting(LIMIT)`.
"""

from __future__ import annotations

from cadpanel.terms.limits.corner_drift import DriftAcross, DriftAlong
from cadpanel.terms.limits.evenness import Evenness
from cadpanel.terms.limits.flange_width import FlangeWidth
from cadpanel.terms.limits.kink import Kink
from cadpanel.terms.limits.limit import Limit
from cadpanel.terms.limits.min_radius import MinRadius
from cadpanel.terms.limits.obliqueness import Obliqueness
from cadpanel.terms.limits.outline_drift import DriftOutline
from cadpanel.terms.limits.seam_level import SeamLevel
from cadpanel.terms.limits.seam_turn import SeamTurn

LIMITS: tuple[Limit, ...] = (
    SeamTurn(),
    Evenness(),
    SeamLevel(),
    Kink(),
    DriftAlong(),
    DriftAcross(),
    DriftOutline(),
    MinRadius(),
    FlangeWidth(),
    Obliqueness(),
)
