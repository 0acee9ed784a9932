"""Records as files: what is no text is refused in one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.delivery.records.jsonfile import Record, write_json
from cadpanel.errors import DeliveryError


class Named(Record):
    """Any record of a file."""

    schema_name: str
    file: str


def test_a_name_that_is_no_text_is_named_with_what_to_do(tmp_path: Path) -> None:
    """Linux gives names of bytes; those of a system with another encoding come as halves of UTF-16."""
    name = b"caf\xe9.step".decode("utf-8", "surrogateescape")
    with pytest.raises(DeliveryError, match=r"r\.json' is not written: 'caf\\udce9\.step' is no text in UTF-8: rename"):
        write_json(Named(schema_name="x", file=name), tmp_path / "r.json")
    assert list(tmp_path.iterdir()) == []
    write_json(Named(schema_name="x", file="café.step"), tmp_path / "r.json")
