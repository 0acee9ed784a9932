"""What a setting is: a default, the range that it is checked against, and how the command line asks for it.

A setting is a field of a frozen dataclass, declared once with `setting(...)`; checks, options and records read its
range and its option from there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import Field, dataclass, field, fields
from numbers import Integral, Real
from typing import Any, TypeVar

from cadpanel.errors import SettingsError

Value = TypeVar("Value")

_RANGE, _OPTION = "range", "option"


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """What a number may be.

    Attributes:
        what: the setting as messages call it, "gap tolerance".
        least, most: bounds; both may be reached.
        unit: as it follows a number in messages, " mm".
        whole: whether only whole numbers will do.
        empty: whether None will do as well.
    """

    what: str
    least: float
    most: float = math.inf
    unit: str = ""
    whole: bool = False
    empty: bool = False

    def check(self, value: object) -> None:
        """Refuse a value outside the range.

        Raises:
            SettingsError: with one sentence that names the setting and its range.
        """
        if value is None and self.empty:
            return
        if self.whole and not isinstance(value, Integral):
            raise SettingsError(f"the {self.what} must be a whole number, not {' '.join(repr(value).split()):.80}")
        require(self.what, value, least=self.least, most=self.most, unit=self.unit)


@dataclass(frozen=True, slots=True, kw_only=True)
class Option:
    """How the command line asks for a setting.

    Attributes:
        help: one line.
        metavar: what stands for the value in the help; found from the type if None.
        takes: the type that the command line reads where it is not the field's own, for example text.
        read: from what was read to the setting's value, told the option's name for its messages.
        show: from the default to what the help shows for it.
        told: whether the help shows the default; where it does not, the help says so, or there is none.
    """

    help: str
    metavar: str | None = None
    takes: Any = None
    read: Callable[[str, Any], object] | None = None
    show: Callable[[Any], object] | None = None
    told: bool = True


def setting(default: Value, *, option: Option, within: Range | None = None) -> Value:
    """A field of a dataclass of settings; like `dataclasses.field`, it stands where the default would."""
    return field(default=default, metadata={_OPTION: option, _RANGE: within})


def check_ranges(settings: Any) -> None:
    """Refuse settings of which a number is out of its range, in the order of the fields, and make all of one kind.

    A whole number of millimetres, or one of NumPy's, is kept as the float that it is: what is written of it is the
    same then.

    Raises:
        SettingsError: with one sentence that names the setting and its range.
    """
    for one in fields(settings):
        allowed = one.metadata.get(_RANGE)
        value = getattr(settings, one.name)
        if allowed is not None:
            allowed.check(value)
        if allowed is not None and value is not None:
            object.__setattr__(settings, one.name, int(value) if allowed.whole else float(value))


def options_of(settings: type[Any]) -> Iterator[tuple[Field[Any], Option]]:
    """The fields of a dataclass of settings, each with its option."""
    for one in fields(settings):
        yield one, one.metadata[_OPTION]


def require(what: str, value: object, *, least: float, most: float = math.inf, unit: str = "") -> None:
    """Refuse a number outside [least, most], or none at all.

    Raises:
        SettingsError: with one sentence that names the setting and its range.
    """
    if not isinstance(value, Real):
        raise SettingsError(f"the {what} must be a number, not {' '.join(repr(value).split()):.80}")
    number = float(value)
    if not math.isfinite(number) or not least <= number <= most:
        span = f"at least {least:g}{unit}" if math.isinf(most) else f"between {least:g}{unit} and {most:g}{unit}"
        raise SettingsError(f"the {what} must be {span}, not {number:g}{unit}")
