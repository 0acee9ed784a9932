"""From the tables of a job file to the values of its regions: defaults, variables, and matrices."""

from __future__ import annotations

import math
import unicodedata
from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

from cadpanel.jobs.job_file import JobFile, Keys, Table
from cadpanel.jobs.names import RESERVED, combinations, first_fault, variant_names
from cadpanel.jobs.schema import MATRIX, REFERENCE, SHA256, asked
from cadpanel.jobs.variables import names_in
from cadpanel.near import near_names

MOST_COMBINATIONS = 100_000
"""Of a matrix: each is a region, and a slip of the pen should not ask for millions."""
_REGION = "region"
_OF_A_REGION = {_REGION: f"'{_REGION}' is the name of a region, and there is none here"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """The values of a region before they are checked, and where in the file each stands.

    Attributes:
        name: of the region.
        values: with variables in their places.
        places: of the values, by their keys.
        header: the place of its table.
    """

    name: str
    values: Table
    places: Mapping[str, Keys]
    header: Keys

    def place(self, key: str) -> Keys:
        """Where a value stands; the table where it is not given."""
        return self.places.get(key, self.header)


def variables_of(file: JobFile) -> dict[str, Any]:
    """The variables of a job, in which those above them may stand.

    Raises:
        SettingsError: one is made of what it cannot know.
    """
    given, found = file.model.variables, dict[str, Any]()
    below = {name: f"a variable may be made of those above it alone, and '{name}' is none of them" for name in given}
    for name, value in given.items():
        found[name] = file.filled(("variables", name), value, found, _OF_A_REGION | below)
    return found


def out_of(file: JobFile, variables: Mapping[str, Any]) -> str:
    """The folder that a job names to write into, or nothing.

    Raises:
        SettingsError: it is none.
    """
    out = str(file.filled(("out",), file.model.out, variables, _OF_A_REGION))
    if "\0" in out:
        file.refuse(("out",), f"'out' must be the name of a folder, not {out!r}")
    return out


def expanded(file: JobFile, variables: Mapping[str, Any]) -> list[Given]:
    """Every region with what it takes over from the defaults, once for each combination of its matrix.

    Raises:
        SettingsError: a name or a matrix is refused, or there is no variable of a name.
    """
    tables = [_Table(file, written, own, variables) for written, own in file.model.regions.items()]
    names = [table.name for table in tables]
    fault = first_fault(names, [not table.matrix for table in tables])
    if fault is not None:
        file.refuse(tables[fault[0]].header, fault[1])
    rows = [(table, *one) for table in tables for one in combinations(table.matrix)]
    # What a matrix makes gives way to what was named by hand.
    by_hand = {table.name for table in tables if not table.matrix}
    wanted = [f"{table.name}{ending}" for table, ending, _ in rows if table.matrix]
    free = iter(variant_names(wanted, RESERVED | by_hand))
    return [table.given(next(free) if table.matrix else table.name, chosen) for table, _, chosen in rows]


class _Table:
    """A region's table with the defaults that hold for it."""

    def __init__(self, file: JobFile, written: str, own: Table, variables: Mapping[str, Any]) -> None:
        self._file, self._variables = file, variables
        self.name = unicodedata.normalize("NFC", written)  # as systems have it that take both ways to write an accent
        self.header: Keys = ("regions", written)
        defaults = file.model.defaults
        self._places = {key: ("defaults", key) for key in defaults} | {key: (*self.header, key) for key in own}
        self._given = {**defaults, **own}
        self.matrix = self._checked(self._given.pop(MATRIX, {}))

    def given(self, name: str, chosen: Mapping[str, Any]) -> Given:
        """The values for one combination of the matrix."""
        known = {**self._variables, _REGION: self.name, **chosen}
        values = {key: self._file.filled(self._places[key], value, known, {}) for key, value in self._given.items()}
        settings = {key: value for key, value in chosen.items() if _is_setting(key)}
        there = {key: (*self._places[MATRIX], key) for key in settings}
        return Given(name=name, values={**values, **settings}, places={**self._places, **there}, header=self.header)

    def _checked(self, given: Any) -> dict[str, list[Any]]:
        place = self._places.get(MATRIX, self.header)
        inside = given if isinstance(given, Mapping) else {}
        own = {key: f"'{key}' is of this matrix itself: use it in the values of the region" for key in inside}
        matrix = self._file.filled(place, given, {**self._variables, _REGION: self.name}, own)
        if not isinstance(matrix, dict):
            self._file.refuse(place, "a matrix is a table of lists, like gap_tolerance = [1, 3]")
        used = set(names_in(self._given))
        for key, values in matrix.items():
            fault = _fault_of_name(key, used) or _fault_of_values(key, values)
            if fault is not None:
                self._file.refuse((*place, key), f"region '{self.name}': {fault}")
        count = math.prod(map(len, matrix.values()))
        if count > MOST_COMBINATIONS:
            self._file.refuse(
                place,
                f"the matrix of region '{self.name}' has {count} combinations, and {MOST_COMBINATIONS} at most are "
                "made: leave values out",
            )
        return matrix


def _is_setting(key: str) -> bool:
    return key in asked() or key == REFERENCE


def _fault_of_name(key: str, used: Collection[str]) -> str | None:
    """Why a matrix cannot be over values of a name."""
    if _is_setting(key) or key in used:
        return None
    if key == SHA256:
        return f"a matrix has no '{SHA256}', which is of one file: leave it out"
    known = [REFERENCE, *asked(), *sorted(set(used) - {_REGION})]
    return f"a matrix has settings, and variables that the region uses; '{key}' is neither; {near_names(key, known)}"


def _fault_of_values(key: str, values: object) -> str | None:
    """Why these are no values to choose from."""
    if not isinstance(values, list) or not values:
        return f"'{key}' in a matrix is a list of values, not {values!r:.80}"
    told = Counter(map(repr, values))  # not by ==, for which 1 and true are the same
    ((most, count),) = told.most_common(1)
    return f"'{key}' in a matrix has {most:.80} twice: leave one of them out" if count > 1 else None
