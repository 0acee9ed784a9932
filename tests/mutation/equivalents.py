"""The changes that change nothing that a test could see, each with its reason, in `equivalents.txt`."""

from __future__ import annotations

from dataclasses import dataclass
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
        file = root / self.path
        if not file.is_file():
            return False
        text = file.read_text(encoding="utf-8")
        return any(one.lines(text) == (self.before, self.after) for one in mutants_of(self.path, text))


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
