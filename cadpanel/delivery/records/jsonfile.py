"""JSON files that other programs rely on: checked when read, the same bytes for the same content when written."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Annotated, Any, NoReturn, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, create_model

from cadpanel.errors import DeliveryError
from cadpanel.garbage import garbage_left
from cadpanel.sizes import refuse_huge

Positive = Annotated[float, Field(gt=0.0)]
NonNegative = Annotated[float, Field(ge=0.0)]
NonNegativeCount = Annotated[int, Field(ge=0)]
FARTHEST = 1e12
"""Of any coordinate, mm: a flat cone's apex may lie far away, and beyond this squares lose all digits."""
Coordinate = Annotated[float, Field(ge=-FARTHEST, le=FARTHEST)]
Vector = tuple[Coordinate, Coordinate, Coordinate]


def _is_unit(vector: Vector) -> Vector:
    """Refuse what has not the length 1.

    Raises:
        ValueError: saying so.
    """
    if not abs(math.hypot(*vector) - 1.0) <= UNIT:
        raise ValueError(f"the direction {list(vector)} is not of length 1")
    return vector


UNIT = 1e-9
"""By how much the length of a direction may differ from 1."""
Direction = Annotated[Vector, AfterValidator(_is_unit)]


class Record(BaseModel):
    """Base of all records: finite numbers only, keys may be added, a record does not change once it is made."""

    model_config = ConfigDict(
        frozen=True,
        extra="allow",
        allow_inf_nan=False,
        ser_json_inf_nan="constants",  # else NaN in an added key would quietly become null
        validate_by_name=True,
        validate_by_alias=True,
    )

    def __repr__(self) -> str:
        # Of a whole file the names and counts: nobody reads hundreds of panels at a prompt.
        if "schema_name" not in type(self).model_fields:
            return super().__repr__()
        lists = [(name, value) for name, value in self if isinstance(value, tuple | list) and value]
        return f"<{type(self).__name__}: {', '.join(f'{len(value)} {name}' for name, value in lists)}>"

    __str__ = __repr__


RecordType = TypeVar("RecordType", bound=Record)


def with_keys(keys: Iterable[str]) -> Callable[[type[RecordType]], type[RecordType]]:
    """Add to a class of records the keys that it does not declare itself: numbers, None where they are not known."""

    def grown(record: type[RecordType]) -> type[RecordType]:
        added: dict[str, Any] = {key: (float | None, None) for key in keys if key not in record.model_fields}
        return create_model(record.__name__, __base__=record, __doc__=record.__doc__, **added) if added else record

    return grown


def read_json(path: Path, model: type[RecordType], *, schema: str, what: str) -> RecordType:
    """The record in a file.

    Args:
        path: the file.
        model: what it must hold.
        schema: what its key "schema" must say.
        what: the file's kind for the reader of an error, for example "a cadpanel report".

    Raises:
        DeliveryError: the file cannot be read, is not JSON, or is not such a record; one sentence says where.
    """
    refuse_huge(path, DeliveryError)
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise DeliveryError(f"'{path}' is not {what}: it is not UTF-8 text (byte {error.start}).") from error
    try:
        with garbage_left():
            content = json.loads(text, parse_constant=_refuse_constant, object_pairs_hook=_without_doubles)
            _check_schema(content, schema)
            return model.model_validate_json(text, strict=True)
    except ValidationError as error:
        raise DeliveryError(f"'{path}' is not {what}: {_first_fault(error)}.") from error
    except json.JSONDecodeError as error:
        raise DeliveryError(f"'{path}' is not {what}: {error.msg} (line {error.lineno}).") from error
    except (ValueError, RecursionError) as error:
        raise DeliveryError(f"'{path}' is not {what}: {error}.") from error


def write_json(record: Record, path: Path) -> None:
    """Write a record as indented UTF-8 JSON, keys in the order in which the record lists them.

    Raises:
        DeliveryError: the file cannot be written, or holds what `json_bytes` refuses.
    """
    data = json_bytes(record, path)
    try:
        path.write_bytes(data)
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be written: {error.strerror}.") from error


def json_bytes(record: Record, path: Path) -> bytes:
    """What `write_json` writes to a file.

    Raises:
        DeliveryError: an added key holds a number that is not finite, or a name is no text, as that of a file may be
            that comes from a system of another encoding.
    """
    try:
        with garbage_left():
            content = record.model_dump(mode="json", by_alias=True)
            text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
        return f"{text}\n".encode()
    except UnicodeEncodeError as error:
        name = _quoted_at(error.object, error.start).encode("ascii", "backslashreplace").decode()
        raise DeliveryError(f"'{path}' is not written: '{name}' is no text in UTF-8: rename it.") from error
    except ValueError as error:
        raise DeliveryError(f"'{path}' is not written: {error}.") from error


def _quoted_at(text: str, place: int) -> str:
    """What stands between the quotes around a place of a JSON text."""
    return text[text.rindex('"', 0, place) + 1 : text.index('"', place)]


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"it holds {name}, and only finite numbers are allowed")


def _without_doubles(pairs: list[tuple[str, object]]) -> dict[str, object]:
    """Refuse a key that stands twice: readers differ in which of the two they take."""
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        double = next(name for name in names if names.count(name) > 1)
        raise ValueError(f'the key "{double}" stands in it twice')
    return found


def _check_schema(content: object, schema: str) -> None:
    """The key alone tells a report from any other JSON, so it is asked for before the rest is judged."""
    found = content.get("schema") if isinstance(content, dict) else None
    if found != schema:
        raise ValueError(f'its "schema" is {json.dumps(found)}, and "{schema}" is expected')


def _first_fault(error: ValidationError) -> str:
    """The first thing that is wrong, with its place; how many more there are."""
    faults = error.errors(include_url=False, include_context=False, include_input=False)
    place = ".".join(str(step) for step in faults[0]["loc"])
    message = faults[0]["msg"].removeprefix("Value error, ")
    more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
    return f"{place}: {message}{more}" if place else f"{message}{more}"
