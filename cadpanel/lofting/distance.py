"""What a pairing of two rails makes small: names alone, as the command line asks before NumPy is there."""

from __future__ import annotations

from typing import Literal, cast, get_args

from cadpanel.errors import SettingsError

Distance = Literal["warp", "tangent-planes"]
"""The angle between the tangent planes at both ends of a ruling, or the distance of these planes."""


def check_distance(named: object) -> Distance:
    """One of the distances.

    Raises:
        SettingsError: there is none of this name.
    """
    if named not in get_args(Distance):
        raise SettingsError(f"a pairing makes {' or '.join(get_args(Distance))} small, not {named!r:.40}")
    return cast(Distance, named)
