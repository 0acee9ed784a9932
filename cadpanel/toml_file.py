"""TOML files as people save them: read, or refused in one sentence."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from cadpanel.errors import SettingsError
from cadpanel.sizes import refuse_huge


def read_toml(path: Path, what: str) -> tuple[str, dict[str, Any]]:
    """The text of a file, without the mark that some editors put before it, and what it holds.

    Args:
        path: the file.
        what: it is, for messages ("the job").

    Raises:
        SettingsError: it cannot be read, or is no TOML.
    """
    if "\0" in str(path):  # TOML can say so, and no system has such a file
        raise SettingsError(f"{what} cannot be called {str(path)!r}, as no file is")
    refuse_huge(path, SettingsError)
    try:
        text = path.read_text(encoding="utf-8-sig")
        return text, tomllib.loads(text)
    except OSError as error:
        raise SettingsError(f"{what} '{path}' cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise SettingsError(f"{what} '{path}' is no text in UTF-8: save the file as such") from error
    except tomllib.TOMLDecodeError as error:
        raise SettingsError(f"{what} '{path}' is no TOML: {error}") from error
    except RecursionError as error:
        raise SettingsError(f"{what} '{path}' has brackets in brackets beyond what can be read: close some") from error
