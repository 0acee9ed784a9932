"""Whether so many panels can be told apart on a surface: plain arithmetic, done before anything is cut."""

from __future__ import annotations

import math
from collections.abc import Sequence

from cadpanel.errors import SettingsError
from cadpanel.reference.assemble import LARGEST_TOLERANCE
from cadpanel.reference.outline_walk import least_edge

# The longest edge's panels may come out longer than their mean length by this part before it counts as too short: edges
# are measured as polylines.
SLACK = 0.01
# A remedy keeps so far below what there is just room for, as panels are not all equally long.
ADVISED = 0.9


def require_room(lengths: Sequence[float], size: float, count: int, what: str, tolerance: float) -> None:
    """Refuse so many panels along edges that some of them must be too short, whichever way they are cut.

    Only what is certain is refused: the mean panel on the longest edge.

    Args:
        lengths: of the edges along which panels follow each other, mm; those without length are left out.
        size: no panel is smaller than this the other way, mm; 0 where that is not known.
        count: of panels along them.
        what: the surface, for messages.
        tolerance: how far panels that meet may lie apart, mm.

    Raises:
        SettingsError: with the number for which there is room.
    """
    edges = [length for length in lengths if length > tolerance]
    if not edges or count == 1:
        return
    least = max(tolerance / LARGEST_TOLERANCE, least_edge(size))
    if max(edges) * (1.0 + SLACK) >= least * count:
        return
    most = math.floor(ADVISED * min(edges) / least)
    advice = f"ask for {most} or fewer" if most > 1 else "do not cut it that way"
    raise SettingsError(
        f"{count} panels along {what} would be {max(edges) / count:.2g} mm long, and corners closer than {least:.3g} "
        f"mm cannot be told apart: {advice}"
        + (", or give a smaller seam tolerance" if least > least_edge(size) else "")
    )
