"""The fewest equal panels of which none is larger than allowed."""

from __future__ import annotations

import math
from collections.abc import Callable

from cadpanel.errors import SettingsError
from cadpanel.reference.settings import MOST_PANELS

# A panel may be larger by this part: 9 m hold three panels of 3 m, however the last digit of 9 m came out.
SLACK = 1e-6
# Equal panels are not all of one size; numbers are tried up to this many times that for which all were.
UNEVEN = 2.0


def fewest(largest: Callable[[int], float], whole: float, most: float, what: str) -> int:
    """The least number of panels of which the largest is no larger than allowed.

    Args:
        largest: the size of the largest of so many panels, mm.
        whole: that of all of them together, mm.
        most: what is allowed, mm.
        what: the surface, for messages.

    Raises:
        SettingsError: there are too many such panels, or their sizes differ too much for any number of them.
    """
    if whole > most * MOST_PANELS:
        raise SettingsError(
            f"{what} is {whole:.6g} mm long, and panels of {most:g} mm would be more than {MOST_PANELS}: allow longer "
            "ones"
        )
    allowed = most * (1.0 + SLACK)
    count = max(1, math.ceil(whole / allowed))
    last = math.ceil(UNEVEN * count) + 1
    for number in range(count, last + 1):
        if largest(number) <= allowed:
            return number
    raise SettingsError(
        f"{last} panels along {what} are up to {largest(last):.6g} mm long, and {most:g} mm are allowed: "
        "their lengths differ too much, give their number instead"
    )
