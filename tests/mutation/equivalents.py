"""The changes that change nothing that a test could see, each with its reason, in `equivalents.txt`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tests.mutation.mutants import mutants_of

LIST = Path("tests", "mutation", "equivalents.txt")


@dataclass(frozen=True, slots=True, kw_only=True)
class Equivalent:
    """A change by its file, the line as it is, the line as it becomes, and why nobody could tell."""

    path: str
    before: str
    after: str
    reason: str

    def applies(self, root: Path) -> bool:
        """Whether the change can still be made."""
        return (self.before, self.after) in _changes(root / self.path)


@cache
def _changes(file: Path) -> frozenset[tuple[str, str]]:
    """Every change that can be made to a file: its line before and after; none to a file that is not there."""
    if not file.is_file():
        return frozenset()
    text = file.read_text(encoding="utf-8")
    return frozenset(one.lines(text) for one in mutants_of(file.name, text))


def read_equivalents(root: Path) -> list[Equivalent]:
    """The list of a checkout: four lines each, with an empty one between them; none where there is no list.

    Raises:
        ValueError: an entry has not four lines.
    """
    if not (root / LIST).is_file():
        return []
    found = []
    for entry in (root / LIST).read_text(encoding="utf-8").strip().split("\n\n"):
        lines = [line.strip() for line in entry.splitlines() if not line.startswith("#")]
        if lines:
            path, before, after, reason = lines
            found.append(Equivalent(path=path, before=before, after=after, reason=reason))
    return found
