"""A STEP file of many products as two files that hold some of them each, with the same instances and numbers.

The text is cut as it stands: what a product needs goes with it, what all need goes with both. Only the file's own
references are followed, so a file is cut where every instance is known to belong to products on one side, or to say
nothing that matters beside names and shapes; any other is left whole. So is one whose products share a shape, or a part
of one: the kernel then makes one of it, where two files would give two.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from cadpanel.arrays import IntArray

LARGEST = 2_000_000_000
"""Bytes of a text whose places are counted in 32 bits."""
MOST_DIGITS = 9
EITHER_SHARE = 0.8
"""Of the text, what the larger part may hold: one that is hardly less than the whole is not worth reading."""
PRODUCTS = (b"PRODUCT_DEFINITION(", b"PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS(")
"""Each is one product; the kernel goes through them in the file's order."""
UNHEARD = (
    *(b"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION(", b"PRESENTATION_LAYER_ASSIGNMENT("),
    *(b"PRODUCT_RELATED_PRODUCT_CATEGORY(", b"PRODUCT_CATEGORY(", b"PRODUCT_CATEGORY_RELATIONSHIP("),
    *(b"APPLICATION_PROTOCOL_DEFINITION(", b"APPLICATION_CONTEXT("),
)
"""Lists of what is drawn, and what is said of the file: neither names nor shapes hang on them."""
OF_SEVERAL_KINDS = (
    *(b"GEOMETRIC_REPRESENTATION_CONTEXT(", b"CONVERSION_BASED_UNIT(", b"NAMED_UNIT(", b"SI_UNIT(", b"LENGTH_UNIT("),
    *(b"PLANE_ANGLE_UNIT(", b"SOLID_ANGLE_UNIT(", b"AREA_UNIT(", b"VOLUME_UNIT(", b"MASS_UNIT("),
)
SHARED = (
    *(b"APPLICATION_CONTEXT(", b"PRODUCT_CONTEXT(", b"PRODUCT_DEFINITION_CONTEXT(", b"REPRESENTATION_CONTEXT("),
    *(b"MECHANICAL_CONTEXT(", b"DESIGN_CONTEXT(", b"GENERAL_PROPERTY("),
    *(b"CARTESIAN_POINT(", b"DIRECTION(", b"VECTOR(", b"AXIS1_PLACEMENT(", b"AXIS2_PLACEMENT_"),
    *(b"MEASURE_WITH_UNIT(", b"LENGTH_MEASURE_WITH_UNIT(", b"PLANE_ANGLE_MEASURE_WITH_UNIT("),
    *(b"UNCERTAINTY_MEASURE_WITH_UNIT(", b"DIMENSIONAL_EXPONENTS(", b"DERIVED_UNIT"),
    *(b"COLOUR_RGB(", b"DRAUGHTING_PRE_DEFINED_", b"PRESENTATION_STYLE_", b"FILL_AREA_STYLE"),
    *(b"SURFACE_STYLE_", b"SURFACE_SIDE_STYLE(", b"CURVE_STYLE", b"POINT_STYLE("),
    *(bracket + kind for bracket in (b"(", b"( ") for kind in OF_SEVERAL_KINDS),
)
"""How that begins which both parts may hold: contexts, units, styles, and points and directions, which are copied."""
ONE, OTHER, BOTH = 1, 2, 3
SPARSEST, FEW = 10, 1000
"""Numbers of instances reach no farther than so many times their count, and so many more."""
_HASH, _SEMICOLON, _QUOTE, _EQUALS, _BLANK, _ZERO, _NINE = b"#;'= 09"
Bits = npt.NDArray[np.uint8]


@dataclass(frozen=True, slots=True, kw_only=True)
class StepPart:
    """A file that holds some products of another one.

    Attributes:
        pieces: of its text, one after the other.
        products: how many they are.
    """

    pieces: tuple[bytes, ...]
    products: int


class Parts(NamedTuple):
    """The first products of a file, and all others."""

    one: StepPart
    other: StepPart


def cut_in_two(text: bytes, groups: int) -> Parts | None:
    """Cut a file between two products.

    Args:
        text: of a whole STEP file.
        groups: the first part holds a multiple of so many products, as near to half of them as that allows.

    Returns:
        None where the file is left whole.
    """
    bounds = _data_section(text)
    if bounds is None:
        return None
    found = _instances(text, *bounds)
    if found is None:
        return None
    products = found.of_kinds(text, PRODUCTS)
    first = round(len(products) / (2 * groups)) * groups
    if not 0 < first < len(products):
        return None
    sides = _sides(found, products[:first], products[first:])
    for side, harmless in ((0, UNHEARD), (BOTH, SHARED)):
        if not all(text.startswith(harmless, word) for word in found.words[sides == side].tolist()):
            return None
    counts = (first, len(products) - first)
    parts = [
        StepPart(pieces=_pieces(text, found, (sides & side) > 0), products=count)
        for side, count in zip((ONE, OTHER), counts, strict=True)
    ]
    if max(sum(map(len, part.pieces)) for part in parts) > EITHER_SHARE * len(text):
        return None
    return Parts(*parts)


def _data_section(text: bytes) -> tuple[int, int] | None:
    """Where the instances begin and end; None where that is not plain."""
    if len(text) > LARGEST or b"/*" in text:
        return None
    start, stop = text.find(b"DATA;") + len(b"DATA;"), text.rfind(b"ENDSEC;")
    return (start, stop) if len(b"DATA;") <= start < stop and text.find(b"DATA;", start) < 0 else None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Instances:
    """The n instances of a file in its order.

    Attributes:
        begins: (n + 1,) where each begins in the text, and where the last one ends.
        words: (n,) where its kind stands, or the bracket of one of several kinds.
        users: (m,) by rising place, the instance that makes each reference.
        used: (m,) the instance that it is made to.
    """

    begins: IntArray
    words: IntArray
    users: IntArray
    used: IntArray

    @property
    def count(self) -> int:
        """N."""
        return len(self.begins) - 1

    def of_kinds(self, text: bytes, kinds: tuple[bytes, ...]) -> IntArray:
        """The places of the instances of some kinds, in order; a kind ends with its bracket."""
        at = np.sort(np.fromiter((place for kind in kinds for place in _occurrences(text, kind)), np.intp))
        places = np.searchsorted(self.words, at)
        places = places[places < self.count]
        return np.asarray(np.unique(places[np.isin(self.words[places], at)]))


def _occurrences(text: bytes, word: bytes) -> Iterator[int]:
    at = text.find(word)
    while at >= 0:
        yield at
        at = text.find(word, at + 1)


def _instances(text: bytes, start: int, stop: int) -> _Instances | None:
    """The instances between two places of a text; None where it is not plain what they are."""
    data = np.frombuffer(text, np.uint8)[start:stop]
    quotes, ends, marks = (np.flatnonzero(data == letter) for letter in (_QUOTE, _SEMICOLON, _HASH))
    if len(quotes) % 2:
        return None
    ends, marks = (at[np.searchsorted(quotes, at) % 2 == 0] for at in (ends, marks))
    if not len(ends) or not len(marks):
        return None
    numbers, after = _numbers(data, marks)
    # An instance begins behind the end of the one before; its first mark is its own number, with "=" behind it.
    begins = np.concatenate([[0], ends[:-1] + 1])
    own = np.searchsorted(marks, begins)
    last = int(ends[-1]) + 1
    if own[-1] >= len(marks) or (marks[own] > ends).any() or (np.diff(own) < 1).any() or data[last:].tobytes().strip():
        return None
    equals = _past_blank(data, after[own])
    names = numbers[own]
    if (data[equals] != _EQUALS).any() or (numbers < 0).any() or names.max() >= SPARSEST * len(names) + FEW:
        return None
    if numbers.max() > names.max():
        return None
    places = np.full(int(names.max()) + 1, -1, dtype=np.int32)
    places[names] = np.arange(len(names))
    refers = np.ones(len(marks), dtype=bool)
    refers[own] = False
    used = places[numbers[refers]].astype(np.intp)
    if (used < 0).any() or (places[names] != np.arange(len(names))).any():
        return None
    users = np.repeat(np.arange(len(own)), np.diff(np.append(own, len(marks))))[refers]
    words = _past_blank(data, equals + 1)
    return _Instances(begins=np.append(begins, last) + start, words=words + start, users=users, used=used)


def _past_blank(data: Bits, at: IntArray) -> IntArray:
    """Places in a text, or those behind them where there is a blank."""
    return np.asarray(np.minimum(at + (data[np.minimum(at, len(data) - 1)] == _BLANK), len(data) - 1))


def _numbers(data: Bits, marks: IntArray) -> tuple[IntArray, IntArray]:
    """The number behind each mark, -1 where there is none or too long a one, and the place behind it."""
    numbers, at = np.zeros(len(marks), dtype=np.int32), marks + 1
    reads = np.arange(len(marks))
    for _ in range(MOST_DIGITS):
        digits = data[np.minimum(at[reads], len(data) - 1)]
        is_digit = (digits >= _ZERO) & (digits <= _NINE)
        reads = reads[is_digit]
        numbers[reads] = 10 * numbers[reads] + (digits[is_digit] - _ZERO)
        at[reads] += 1
    numbers[reads] = -1
    numbers[at == marks + 1] = -1
    return numbers.astype(np.intp), np.minimum(at, len(data) - 1)


def _sides(found: _Instances, one: IntArray, other: IntArray) -> Bits:
    """(n,) to which part each instance belongs, 0 where that does not show.

    A product belongs to a part, and so does all that one of the part's instances refers to. What refers to instances of
    one part, and to none of the other part alone, belongs to that part as well.
    """
    sides = np.zeros(found.count, dtype=np.uint8)
    starts = np.searchsorted(found.users, np.arange(found.count + 1))
    sides[one], sides[other] = ONE, OTHER
    new = np.concatenate([one, other])
    while len(new):
        _spread(found, starts, sides, new)
        open_ = sides[found.users] == 0
        users, towards = found.users[open_], sides[found.used[open_]]
        told = np.zeros(found.count, dtype=np.uint8)
        for side in (ONE, OTHER):
            told[users[towards == side]] |= side
        new = np.flatnonzero((told == ONE) | (told == OTHER))
        sides[new] = told[new]
    return sides


def _spread(found: _Instances, starts: IntArray, sides: Bits, new: IntArray) -> None:
    """Give the sides of instances to all that they refer to."""
    while len(new):
        counts = starts[new + 1] - starts[new]
        firsts = np.repeat(starts[new] - np.concatenate([[0], np.cumsum(counts)[:-1]]), counts)
        references = firsts + np.arange(counts.sum())
        used, given = found.used[references], np.repeat(sides[new], counts)
        told = sides.copy()
        for side in (ONE, OTHER):
            told[used[(given & side) > 0]] |= side
        new = np.flatnonzero(told != sides)
        sides[new] = told[new]


def _pieces(text: bytes, found: _Instances, chosen: npt.NDArray[np.bool_]) -> tuple[bytes, ...]:
    """The pieces of a file with some of the instances."""
    edges = np.flatnonzero(np.diff(chosen.astype(np.int8), prepend=0, append=0))
    runs = found.begins[edges].reshape(-1, 2).tolist()
    return text[: found.begins[0]], *(text[start:stop] for start, stop in runs), text[found.begins[-1] :]
