"""Rules that no search could hold together: told before it is begun."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from cadpanel.errors import SettingsError
from cadpanel.fitting.rules.rule import Place, Posed

# Two places may lie a little farther apart than rules allow before they contradict each other: what is measured of
# them differs by as much from processor to processor, mm.
_SLACK = 1e-6


def refuse_contradictions(posed: Sequence[Posed], names: Sequence[str]) -> None:
    """Refuse rules that want one point of a panel in two places.

    Args:
        posed: the rules.
        names: of the panels.

    Raises:
        SettingsError: naming both rules, the panel, and how far the places lie apart.
    """
    wanted: dict[tuple[int, int], list[Place]] = {}
    for rule in posed:
        for place in rule.places():
            wanted.setdefault((place.panel, place.point), []).append(place)
    for (panel, _), places in wanted.items():
        for one, other in combinations(places, 2):
            apart = np.abs(np.subtract(one.at, other.at))
            room = np.add(one.within, other.within)
            if (apart > room + _SLACK).any():
                axis = int((apart - room).argmax())
                raise SettingsError(
                    f"the rules '{one.rule}' and '{other.rule}' contradict each other: they want a point of panel "
                    f"'{names[panel]}' in places {apart[axis]:.4g} mm apart, and leave {room[axis]:.4g} mm; leave one "
                    "out or allow more within them"
                )
