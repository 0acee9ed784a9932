"""What a STEP file says around its geometry, as its text has it: schema, accuracy, products, and who hangs in what.

Readers of the kernel let most of it pass: a part that hangs twice, a product without a name, an accuracy of 10 mm.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from cadpanel.brep.step.schemas import SCHEMAS, UNCERTAINTY, Schema
from cadpanel.brep.step.text import real, string

_STRING = r"'(?:[^']|'')*'"
_PRODUCT = re.compile(rf"=PRODUCT\(({_STRING}),({_STRING}),{_STRING},")
_INSTANCE = re.compile(rf"=NEXT_ASSEMBLY_USAGE_OCCURRENCE\({_STRING},({_STRING}),{_STRING},#(\d+),#(\d+),")
_ACCURACY = re.compile(r"=UNCERTAINTY_MEASURE_WITH_UNIT\(LENGTH_MEASURE\(([^)]*)\)")
_SCHEMA = re.compile(rf"FILE_SCHEMA\(\(({_STRING})\)\)")
# Of a line that one of these finds something in, and of no other: text of all panels is not held at once.
_MARKS = ("=PRODUCT(", "=NEXT_ASSEMBLY_USAGE_OCCURRENCE(", "=UNCERTAINTY_MEASURE_WITH_UNIT(", "FILE_SCHEMA(")


def frame_faults(path: Path, title: str, parts: Sequence[tuple[str, str]], schema: Schema) -> Iterator[str]:
    """One sentence for everything around the geometry of a file that is not as it was to be.

    Args:
        path: the file, as cadpanel wrote it.
        title: name and number of the assembly.
        parts: of each part its number and its name, in their order.
        schema: that was asked for.

    Raises:
        OSError: it cannot be read.
    """
    with path.open(encoding="ascii", errors="replace") as file:
        text = "".join(line for line in file if any(mark in line for mark in _MARKS))
    if _SCHEMA.findall(text) != [string(SCHEMAS[schema].name)]:
        yield f"'{path.name}' does not say once that its schema is {schema}."
    if _ACCURACY.findall(text) != [real(UNCERTAINTY)]:
        yield f"'{path.name}' does not say once that its accuracy is {UNCERTAINTY:g} mm."
    products = _PRODUCT.findall(text)
    wanted = [(string(title), string(title)), *((string(number), string(name)) for number, name in parts)]
    for number, name in Counter(wanted) - Counter(products):
        yield f"'{path.name}' holds no product {name} with the part number {number}."
    for number, name in Counter(products) - Counter(wanted):
        yield f"'{path.name}' holds a product {name} with the part number {number}, which is not expected there."
    instances = _INSTANCE.findall(text)
    names = [name for name, _, _ in instances]
    if names != [string(name) for _, name in parts]:
        yield f"The parts that hang in the assembly of '{path.name}' are not the panels, each once and in their order."
    if len({whole for _, whole, _ in instances}) > 1 or len({part for _, _, part in instances}) < len(instances):
        yield f"A part hangs twice, or in another part, in the assembly of '{path.name}'."
