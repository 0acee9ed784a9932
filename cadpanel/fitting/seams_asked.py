"""What the word for seams (--seams) means to a fit, beside how it cuts.

Square, level and conjugate seams are held to the planes in which they were cut, within the limits on seams; free ones
may run as panels meet best.
"""

from __future__ import annotations

from dataclasses import replace

from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.settings import Seams
from cadpanel.terms.limits.evenness import Evenness
from cadpanel.terms.limits.seam_level import SeamLevel
from cadpanel.terms.limits.seam_turn import SeamTurn


def for_seams(settings: FitSettings, seams: Seams) -> FitSettings:
    """The settings of a fit whose seams were asked for: of free ones no limit counts that stands at its default."""
    if seams != "free":
        return settings
    turn, even, level = (
        limit.most if limit.allowed(settings) == limit.default else limit.allowed(settings)
        for limit in (SeamTurn(), Evenness(), SeamLevel())
    )
    return replace(settings, seam_turn=turn, evenness=even, seam_level=level)
