"""What panels are called that a file holds ready-made."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence


def call_panels(said: Sequence[tuple[str, str]]) -> list[str]:
    """Call panels by their products; those that are one product in different places, by their instances.

    Args:
        said: of each panel its product's name and that of this use of it, empty where the file gives none.

    Returns:
        Names that are all different; see `unique_names`.
    """
    uses = Counter(product for product, _ in said)
    return unique_names(
        [(instance or product) if uses[product] > 1 else (product or instance) for product, instance in said]
    )


def unique_names(names: Sequence[str]) -> list[str]:
    """Name the nameless by their place, and number what has the same name."""
    given = [name or f"panel {place}" for place, name in enumerate(names, start=1)]
    taken = set(given)
    seen: set[str] = set()
    unique = []
    for name in given:
        candidate, number = name, 1
        while candidate in seen or (number > 1 and candidate in taken):
            number += 1
            candidate = f"{name} ({number})"
        seen.add(candidate)
        unique.append(candidate)
    return unique
