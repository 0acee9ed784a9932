"""Names of files from names of panels: good on every file system, and different even where case does not count."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Sequence

_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f\x7f]')
_DEVICES = re.compile(r"(con|prn|aux|nul|conin\$|conout\$|(com|lpt)[0-9\u00b9\u00b2\u00b3])(\..*)?", re.IGNORECASE)
# Bytes of the longest name that every file system takes, with an ending and a number behind.
_MOST_BYTES = 200


def file_names(names: Sequence[str], longest: int, taken: Collection[str] = ()) -> list[str]:
    """A name without an ending for each panel; a name that is good as it is stays.

    Signs that Windows or macOS refuse become "_", and so do dots and blanks at either end; names of devices get one
    behind. Of names that would be one file where case does not count, the later ones get a number.

    Args:
        names: of the panels.
        longest: how many signs a name may have.
        taken: names of other files in the same folder.
    """
    wanted = [_safe(name, longest) for name in names]
    used = {_key(name) for name in taken}
    # Names that are good as they are come first, so that no number is given to one of them.
    order = sorted(range(len(names)), key=lambda place: (wanted[place] != names[place], place))
    found = dict.fromkeys(range(len(names)), "")
    reserved = {_key(name) for name in wanted}
    for place in order:
        name, number = wanted[place], 1
        while _key(name) in used or (number > 1 and _key(name) in reserved):
            number += 1
            ending = f"-{number}"
            name = f"{wanted[place][: longest - len(ending)]}{ending}"
        used.add(_key(name))
        found[place] = name
    return list(found.values())


def _safe(name: str, longest: int) -> str:
    signs = _FORBIDDEN.sub("_", unicodedata.normalize("NFC", name))
    signs = "".join(sign if sign.isprintable() else "_" for sign in signs)
    while len(signs.encode()) > _MOST_BYTES:
        signs = signs[:-1]
    signs = _trimmed(signs[:longest])
    return f"{signs[: longest - 1]}_" if _DEVICES.fullmatch(signs) else signs


def _trimmed(name: str) -> str:
    """Without dots and blanks at either end, which some systems hide and others drop."""
    inside = name.strip(". ")
    if not inside:
        return "_"
    before, _, after = name.partition(inside)
    return "_" * len(before) + inside + "_" * len(after)


def _key(name: str) -> str:
    """What is the same file where neither case nor the way that accents are written counts."""
    return unicodedata.normalize("NFC", unicodedata.normalize("NFD", name).casefold())
