"""What files say of their parts besides shapes, against the shapes in them and against what was to be said."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from cadpanel.brep.proof.shape_facts import ShapeFacts
from cadpanel.brep.step.properties import PartData, Validation

STATED_LIMIT = 1e-9
"""Relative difference of a stated volume or area from the kernel's, and of a stated number from the report's."""
CENTROID_LIMIT = 1e-6
"""Distance of a stated centroid from the kernel's, mm."""


def check_stated(label: str, facts: ShapeFacts, said: PartData, failures: list[str]) -> float:
    """The greatest relative error of a volume or area that is stated of a shape; sentences for what does not hold.

    Args:
        label: what the shape is called in sentences, "solid" or "skin".
        facts: what was found in the file.
        said: what it must say.
        failures: sentences are added here.
    """
    problems = [] if said.validation is None else list(_wrong_numbers(facts, said.validation))
    problems += [
        f"attribute '{name}' is not the report's"
        for name in sorted({*facts.stated.attributes, *said.attributes})
        if not _same(facts.stated.attributes, said.attributes, name)
    ]
    failures += [f"Panel '{facts.name}': its {label}'s {problem}." for problem in problems]
    return 0.0 if said.validation is None else max(_errors(facts), default=0.0)


def _wrong_numbers(facts: ShapeFacts, said: Validation) -> Iterator[str]:
    stated = facts.stated
    pairs = {"area": (stated.area, said.area), "volume": (stated.volume, said.volume)}
    for what, (number, wanted) in pairs.items():
        if number is None or wanted is None:
            if number is not wanted:
                yield f"validation property '{what}' is missing or was not to be there"
        elif not abs(number / wanted - 1.0) <= STATED_LIMIT:
            yield f"validation property '{what}' is {number:.12g}, the report's {wanted:.12g}"
    if stated.centroid is None:
        yield "validation property 'centroid' is missing"
        return
    if not np.linalg.norm(np.subtract(stated.centroid, said.centroid)) <= CENTROID_LIMIT:
        yield "validation property 'centroid' is not the report's"
    if not np.linalg.norm(facts.centroid - stated.centroid) <= CENTROID_LIMIT:
        yield "centroid is not the one that is stated as its validation property"
    if not max(_errors(facts), default=0.0) <= STATED_LIMIT:
        yield "area or volume is not the one that is stated as its validation property"


def _errors(facts: ShapeFacts) -> list[float]:
    pairs = ((facts.stated.area, float(facts.areas.sum())), (facts.stated.volume, facts.volume))
    # By the larger of the two: a file that holds no shape is wrong by all of it.
    largest = [(stated, found, max(abs(stated), abs(found))) for stated, found in pairs if stated is not None]
    return [abs(stated - found) / size for stated, found, size in largest if size > 0.0]


def _same(found: Mapping[str, str | float], wanted: Mapping[str, str | float], name: str) -> bool:
    one, other = found.get(name), wanted.get(name)
    if isinstance(one, float) and isinstance(other, int | float):
        return bool(abs(one - other) <= STATED_LIMIT * abs(other))
    return one == other
