"""From where panels are looked at."""

from __future__ import annotations

from typing import Literal, get_args

View = Literal["outside", "north", "east", "south", "west", "top"]
"""Where most panels face to, or a direction; north is along y, up along z."""
VIEWS: tuple[View, ...] = get_args(View)
