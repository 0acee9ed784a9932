"""All rules of a fit, from a TOML file or from the same as a Python mapping."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import SettingsError
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.rules.catalogue import RULES
from cadpanel.fitting.rules.contradictions import refuse_contradictions
from cadpanel.fitting.rules.lock import LockRule
from cadpanel.fitting.rules.rule import Posed, Rule
from cadpanel.reference.model import Reference
from cadpanel.reference.named import near_names
from cadpanel.toml_file import read_toml

# A gap is no longer than so many times the root of the sum of its parts' squares.
_MORE = 2.0


@dataclass(frozen=True, slots=True)
class Rules:
    """Rules in the order of the catalogue, and those of one kind as they were written."""

    rules: tuple[Rule, ...] = ()

    @property
    def of_fit(self) -> bool:
        """Whether some of them need a fit of all panels at once that holds tolerances."""
        return any(rule.of_fit for rule in self.rules)

    def of_panels_alone(self) -> Rules:
        """Those that count where panels are not fitted at once, too: their features."""
        return Rules(tuple(rule for rule in self.rules if not rule.of_fit))

    def features(self, names: Sequence[str]) -> dict[int, str]:
        """The features of single panels by their places; what comes later counts.

        Raises:
            SettingsError: a rule names a panel that is not there.
        """
        return {place: name for rule in self.rules for place, name in rule.features(names).items()}

    def gaps(self, general: Mapping[str, float], names: Sequence[str], seam_panels: IntArray) -> dict[str, Array]:
        """(seams,) what is allowed of gaps and their parts where `general` holds for all other seams, mm."""
        found = {part: np.full(len(seam_panels), most) for part, most in general.items()}
        for rule in self.rules:
            for part, asked in rule.gaps(names, seam_panels).items():
                # A part that is held nowhere else is no longer than the whole gap.
                usual = found.get(part, np.full(len(seam_panels), general.get("gap", np.inf)))
                found[part] = np.where(np.isnan(asked), usual, asked)
        if "gap" in found:
            # Where nothing is said of the whole it may be what its parts allow of it, and is no further limit.
            parts = np.linalg.norm([most for part, most in found.items() if part != "gap"], axis=0)
            found["gap"] = np.where(np.isinf(found["gap"]), _MORE * parts, found["gap"])
        return found

    def joints(self, names: Sequence[str], seam_panels: IntArray) -> dict[int, float]:
        """Clear widths of the joints of single seams by their places, mm; what comes later counts."""
        return {seam: width for rule in self.rules for seam, width in rule.joints(names, seam_panels).items()}

    def pose(self, reference: Reference, features: Sequence[PanelFeature]) -> tuple[Posed, ...]:
        """The rules for these panels with these features.

        Raises:
            SettingsError: a rule names what is not there, or asks what has no meaning for a panel, or two of them
                contradict each other.
        """
        posed = tuple(posed for rule in self.rules for posed in rule.pose(reference, features))
        refuse_contradictions(posed, [panel.name for panel in reference.panels])
        return posed

    def with_made(self, made: Callable[[LockRule], LockRule]) -> Rules:
        """The same where locks to earlier deliveries know what these hold."""
        return Rules(tuple(made(rule) if isinstance(rule, LockRule) and rule.unread else rule for rule in self.rules))

    @property
    def unread(self) -> bool:
        """Whether some of them are about deliveries that were not read yet."""
        return any(isinstance(rule, LockRule) and rule.unread for rule in self.rules)

    def plain(self) -> dict[str, Any]:
        """The rules as a file has them."""
        found: dict[str, Any] = {}
        for rule in self.rules:
            if rule.several:
                found.setdefault(rule.table, []).append(rule.plain())
            else:
                found[rule.table] = rule.plain()
        return found


def rules_of(value: object) -> Rules | None:
    """Rules from what a user may give: nothing, the name of a file, what it would hold, or rules made already.

    Raises:
        SettingsError: the file cannot be read, or a rule is none; one sentence says where.
    """
    if value is None or isinstance(value, Rules):
        return value
    if isinstance(value, str | Path):
        return _parsed(read_toml(Path(value), "the file of rules")[1], f"'{value}': ")
    if isinstance(value, Mapping):
        return _parsed(value, "")
    raise SettingsError(f"rules are the name of a TOML file, or what it would hold, not {value!r:.80}")


def _parsed(given: Mapping[str, Any], where: str) -> Rules:
    kinds = {kind.table: kind for kind in RULES}
    for table in given:
        if table not in kinds:
            near = near_names(str(table), list(kinds), 1)[0]
            raise SettingsError(f"{where}there is no rule [{table}]; there is [{near}], for example")
    found: list[Rule] = []
    for table, kind in kinds.items():
        if table not in given:
            continue
        tables = given[table] if kind.several else [given[table]]
        if not isinstance(tables, list | tuple) or not all(isinstance(one, Mapping) for one in tables):
            head = f"[[{table}]]" if kind.several else f"[{table}]"
            raise SettingsError(f"{where}a rule of this kind begins with {head} on a line of its own")
        try:
            found += [kind.parse(one) for one in tables]
        except SettingsError as error:
            raise SettingsError(f"{where}{error}") from error
    return Rules(tuple(found))
