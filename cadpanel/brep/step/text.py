"""The exchange structure of ISO 10303-21 as text: numbered instances, reals with every digit, encoded strings."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import IO

ITEMS_A_LINE = 16


class NoReal(ValueError):
    """A number has no text in the exchange structure; says which."""


def real(number: float) -> str:
    """A real with all its digits, so that reading it gives the same double: 1e-07 becomes 1.E-07.

    Args:
        number: of any kind: text of whole numbers, or of NumPy's, would be no real.

    Raises:
        NoReal: it is not finite.
    """
    double = float(number)
    if not math.isfinite(double):
        raise NoReal(f"the number {double}, and STEP has finite ones alone")
    text = repr(double)
    if "e" in text:
        mantissa, exponent = text.split("e")
        return f"{mantissa if '.' in mantissa else mantissa + '.'}E{exponent}"
    return text


def string(text: str) -> str:
    """A quoted string: quotes and backslashes doubled, everything beyond printable ASCII as UTF-16 or UCS-4 hex."""
    pieces = []
    for character in text:
        code = ord(character)
        if character in "'\\":
            pieces.append(character * 2)
        elif 32 <= code < 127:
            pieces.append(character)
        elif code > 0xFFFF:
            pieces.append(f"\\X4\\{code:08X}\\X0\\")
        else:
            pieces.append(f"\\X2\\{code:04X}\\X0\\")
    return "'" + "".join(pieces) + "'"


def references(ids: Iterable[int]) -> str:
    """A list of references, broken into lines so that no line grows with the number of panels."""
    items = [f"#{number}" for number in ids]
    lines = [",".join(items[start : start + ITEMS_A_LINE]) for start in range(0, len(items), ITEMS_A_LINE)]
    return "(" + ",\n".join(lines) + ")"


class StepText:
    """A data section that goes into a file as it grows: instances are numbered from 1 in the order in which they come.

    Nothing of what is written is kept, so that memory does not grow with the number of panels.
    """

    def __init__(self, file: IO[str]) -> None:
        self._write = file.write
        self._last = 0
        self._shared: dict[tuple[str, tuple[float, ...]], int] = {}

    def add(self, entity: str) -> int:
        """Add an instance, for example "VECTOR('',#4,1.)", and return its number."""
        self._last += 1
        self._write(f"#{self._last}={entity};\n")
        return self._last

    def shared(self, kind: str, numbers: tuple[float, ...]) -> int:
        """CARTESIAN_POINT or DIRECTION of these coordinates, one instance for equal ones until `forget`."""
        key = (kind, numbers)
        known = self._shared.get(key)
        if known is None:
            known = self.add(f"{kind}('',({','.join(map(real, numbers))}))")
            self._shared[key] = known
        return known

    def forget(self) -> None:
        """Share nothing with the instances added so far: each panel keeps its own points."""
        self._shared.clear()
