"""Deliveries that were made before, by the key of all that they depend on.

They are kept by diskcache, whose index is a database that two runs may use at once; what is longest unused goes when
they take more than so much of the disk. Beside each stands the sum of its bytes, so that a damaged one is found, thrown
away and made again.
"""

from __future__ import annotations

import hashlib
import sqlite3
from pathlib import Path
from types import TracebackType
from typing import Self

from diskcache import Cache, Disk, Timeout
from diskcache.core import MODE_PICKLE
from platformdirs import user_cache_path

from cadpanel.errors import SettingsError

MOST_BYTES = 20_000_000_000
"""That all results together may take."""
PATIENCE = 60.0
"""s to wait for another run that writes into the index; a disk that answers no more is waited for no longer either."""
_DIGEST = hashlib.sha256().digest_size
_FAULTS = (sqlite3.Error, OSError, Timeout)


def usual_folder() -> Path:
    """Where results are kept if nothing else is said: the folder of this system for what can be made again."""
    return user_cache_path("cadpanel") / "results"


class _Plain(Disk):  # type: ignore[misc] # it comes without types
    """How diskcache stores values, without pickles: whoever can write into the folder could run a program by one."""

    def fetch(self, mode: int, filename: str | None, value: object, read: bool) -> object:
        """A value from what the index has of it; none where that is a pickle."""
        return None if mode == MODE_PICKLE else super().fetch(mode, filename, value, read)


class Results:
    """A folder of results."""

    def __init__(self, folder: Path) -> None:
        """Open the folder, or make it.

        Raises:
            SettingsError: it cannot be used.
        """
        self._folder = folder
        try:
            self._cache = Cache(
                str(folder),
                timeout=PATIENCE,
                disk=_Plain,
                size_limit=MOST_BYTES,
                eviction_policy="least-recently-used",
            )
        except _FAULTS as error:
            raise self._refusal(error) from error

    def get(self, key: str) -> bytes | None:
        """What was made of a key; None where nothing was, or what was is damaged.

        Raises:
            SettingsError: the folder cannot be used.
        """
        try:
            found = self._cache.get(key)
            if found is None:
                return None
            if isinstance(found, bytes) and hashlib.sha256(found[_DIGEST:]).digest() == found[:_DIGEST]:
                return found[_DIGEST:]
            self._cache.delete(key)
        except _FAULTS as error:
            raise self._refusal(error) from error
        return None

    def put(self, key: str, made: bytes) -> None:
        """Keep what was made of a key.

        Raises:
            SettingsError: it cannot be kept.
        """
        try:
            self._cache.set(key, hashlib.sha256(made).digest() + made)
        except _FAULTS as error:
            raise self._refusal(error) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, _kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        """Close the index."""
        self._cache.close()

    def _refusal(self, error: Exception) -> SettingsError:
        why = f"it does not answer within {PATIENCE:g} s" if isinstance(error, Timeout) else error
        damaged = isinstance(error, sqlite3.DatabaseError) and not isinstance(error, sqlite3.OperationalError)
        remedy = "delete that folder, or name another one by --cache" if damaged else "name another folder by --cache"
        return SettingsError(f"results cannot be kept in '{self._folder}' ({why}): {remedy}")
