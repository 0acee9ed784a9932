"""The date of files: the present, or that of SOURCE_DATE_EPOCH, with which the same panels give the same bytes."""

from __future__ import annotations

import os
from datetime import UTC, datetime

from cadpanel.errors import SettingsError

VARIABLE = "SOURCE_DATE_EPOCH"
_FIRST_YEAR = 1980  # of dates in an archive


def source_date() -> datetime:
    """The date that the environment asks for, in seconds since 1970; where it asks for none the present, to the second.

    Raises:
        SettingsError: what it says is no number of seconds.
    """
    said = os.environ.get(VARIABLE)
    if said is None:
        return datetime.now(UTC).replace(microsecond=0)
    try:
        return datetime.fromtimestamp(int(said), UTC)
    except (ValueError, OverflowError, OSError) as error:
        raise SettingsError(f"{VARIABLE} must be a number of seconds since 1970, not '{said}'") from error


def archive_date() -> tuple[int, int, int, int, int, int]:
    """The same as archives keep it, which know no year before 1980.

    Raises:
        SettingsError: what the environment says is no number of seconds.
    """
    date = source_date()
    return max(date.year, _FIRST_YEAR), date.month, date.day, date.hour, date.minute, date.second
