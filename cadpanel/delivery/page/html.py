"""The page as one file that needs no other: program, style and numbers in it, all names as text. And back again."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from cadpanel.errors import DeliveryError

_ASSETS = files("cadpanel.delivery.page.assets")
_LIBRARY = "three.min.js"
_PARTS = ("format", "colours", "model", "drawings", "stage", "picking", "tables", "details", "main")
"""Of the program, in the order in which they build on each other."""
_NUMBERS, _SHAPES = "cadpanel-numbers", "cadpanel-shapes"


def page_bytes(title: str, numbers: Mapping[str, Any], shapes: Mapping[str, Any]) -> bytes:
    """The whole page.

    Args:
        title: what stands in the browser's title.
        numbers: as `page_numbers` gives them.
        shapes: the packed scene and flat patterns.
    """
    parts = {
        "title": html.escape(title),
        "style": _asset("page.css"),
        "library": _asset(_LIBRARY),
        "program": _program(),
        "numbers": json_text(numbers),
        "shapes": json_text(shapes),
    }
    # In one go, so that no part is looked through for the places of others.
    return re.sub(r"\{\{(\w+)\}\}", lambda place: parts[place[1]], _asset("page.html")).encode("utf-8")


def is_written_so(path: Path, title: str, numbers: Mapping[str, Any], shapes: Mapping[str, Any]) -> bool:
    """Whether a page is, to the last byte, what this program writes of some numbers and shapes."""
    return path.read_bytes() == page_bytes(title, numbers, shapes)


def read_page(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Numbers and shapes that a page holds.

    Raises:
        DeliveryError: there is no such file, or it is no page of ours.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except UnicodeDecodeError as error:
        raise DeliveryError(f"'{path}' is no page of cadpanel: it is not UTF-8 text (byte {error.start}).") from error
    return _held(text, _NUMBERS, path), _held(text, _SHAPES, path)


def json_text(content: Mapping[str, Any]) -> str:
    """JSON that no parser of HTML takes for anything else: it holds neither "<" nor a line end of JavaScript."""
    text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    for sign in ("<", ">", "&", "\u2028", "\u2029"):
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return text


def _held(text: str, name: str, path: Path) -> dict[str, Any]:
    found = re.search(rf'<script type="application/json" id="{name}">([^<]*)</script>', text)
    try:
        content = json.loads(found[1]) if found else None
    except json.JSONDecodeError as error:
        raise DeliveryError(f"'{path}' is no page of cadpanel: {error.msg}.") from error
    if not isinstance(content, dict):
        raise DeliveryError(f"'{path}' is no page of cadpanel, as it holds no {name}: write the delivery again.")
    return content


def _program() -> str:
    return "\n".join(_asset(f"{name}.js") for name in _PARTS)


@cache
def _asset(name: str) -> str:
    return (_ASSETS / name).read_text(encoding="utf-8")
