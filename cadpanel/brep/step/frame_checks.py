"""What a STEP file says around its geometry, as its text has it: schema, accuracy, products, materials, assembly.

Readers of the kernel let most of it pass: a part that hangs twice, a product without a name, an accuracy of 10 mm.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from cadpanel.brep.step.properties import Material
from cadpanel.brep.step.schemas import SCHEMAS, UNCERTAINTY, Schema
from cadpanel.brep.step.text import real, string

_STRING = r"'(?:[^']|'')*'"
_PRODUCT = re.compile(rf"=PRODUCT\(({_STRING}),({_STRING}),({_STRING}),")
_INSTANCE = re.compile(rf"=NEXT_ASSEMBLY_USAGE_OCCURRENCE\({_STRING},({_STRING}),{_STRING},#(\d+),#(\d+),")
_ACCURACY = re.compile(r"=UNCERTAINTY_MEASURE_WITH_UNIT\(LENGTH_MEASURE\(([^)]*)\)")
_WHO = re.compile(rf"FILE_NAME\({_STRING},{_STRING},\(({_STRING})\),\(({_STRING})\),")
_SCHEMA = re.compile(rf"FILE_SCHEMA\(\(({_STRING})\)\)")
_MATERIAL = re.compile(rf"=DESCRIPTIVE_REPRESENTATION_ITEM\(({_STRING}),\1\)")
_DENSITY = re.compile(r"=MEASURE_REPRESENTATION_ITEM\('density measure',NUMERIC_MEASURE\(([^)]*)\)")
_EDGE = "=EDGE_CURVE("
_TURNED = re.compile(rb"=EDGE_CURVE\((?![^\n]*,\.T\.\);\n)")
_PLACE = re.compile(r"=(?:CARTESIAN_POINT|DIRECTION|AXIS2_PLACEMENT_3D)\(")
_ORIGIN = ("CARTESIAN_POINT('',(0.0,0.0,0.0));", "DIRECTION('',(0.,0.,1.));", "DIRECTION('',(1.,0.,0.));")
# Of a line that one of these finds something in, and of no other: text of all panels is not held at once.
_MARKS = (
    b"=PRODUCT(",
    b"=NEXT_ASSEMBLY_USAGE_OCCURRENCE(",
    b"=UNCERTAINTY_MEASURE_WITH_UNIT(",
    b"FILE_SCHEMA(",
    b"FILE_NAME(",
    b"=DESCRIPTIVE_REPRESENTATION_ITEM(",
    b"'density measure'",
)
_BLOCK = 1 << 20


class Part(NamedTuple):
    """What a product is called: its number, its name, and what is said of it."""

    number: str
    name: str
    description: str = ""


def frame_faults(
    path: Path,
    title: str,
    parts: Sequence[Part],
    schema: Schema,
    who: tuple[str, str] = ("", ""),
    materials: Sequence[Material] = (),
) -> Iterator[str]:
    """One sentence for everything around the geometry of a file that is not as it was to be.

    Args:
        path: the file, as cadpanel wrote it.
        title: name and number of the assembly.
        parts: what each part is called, in their order.
        schema: that was asked for.
        who: author and organization.
        materials: of the parts that have one, in their order.

    Raises:
        OSError: it cannot be read.
    """
    text = "".join(_told_lines(path))
    if _SCHEMA.findall(text) != [string(SCHEMAS[schema].name)]:
        yield f"'{path.name}' does not say once that its schema is {schema}."
    if _ACCURACY.findall(text) != [real(UNCERTAINTY)]:
        yield f"'{path.name}' does not say once that its accuracy is {UNCERTAINTY:g} mm."
    if _WHO.findall(text) != [(string(who[0]), string(who[1]))]:
        yield f"'{path.name}' does not say once that it is from '{who[0]}' of '{who[1]}'."
    called = {string(one.name) for one in materials}
    if set(_MATERIAL.findall(text)) != called or _DENSITY.findall(text) != [real(one.density) for one in materials]:
        yield f"'{path.name}' does not say of every panel what it is made of, as the report has it."
    if not _begins_at_origin(path):
        yield f"'{path.name}' does not begin with the origin that all its parts share."
    if _EDGE in text:
        yield f"'{path.name}' has edges that run against their curves, and cadpanel writes none."
    yield from _product_faults(path.name, _PRODUCT.findall(text), [Part(title, title), *parts])
    instances = _INSTANCE.findall(text)
    names = [name for name, _, _ in instances]
    if names != [string(part.name) for part in parts]:
        yield f"The parts that hang in the assembly of '{path.name}' are not the panels, each once and in their order."
    if len({whole for _, whole, _ in instances}) > 1 or len({part for _, _, part in instances}) < len(instances):
        yield f"A part hangs twice, or in another part, in the assembly of '{path.name}'."


def _begins_at_origin(path: Path) -> bool:
    """Whether the first placement of a file, from which all others are measured, is the origin with its axes."""
    with path.open(encoding="ascii", errors="replace") as file:
        found = [line.rstrip("\n").split("=") for line in islice(filter(_PLACE.search, file), 1 + len(_ORIGIN))]
    own = ",".join(line[0] for line in found[:-1])
    return [line[-1] for line in found] == [*_ORIGIN, f"AXIS2_PLACEMENT_3D('',{own});"]


def _told_lines(path: Path) -> Iterator[str]:
    """The lines that tell something, in their order; of edges those that do not run along their curves.

    Readers mend such edges, each in its own way.
    """
    with path.open("rb") as file:
        while block := file.read(_BLOCK):
            block += file.readline()
            if b"\r" in block:
                block = block.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
            starts = {block.rfind(b"\n", 0, place) + 1 for mark in _MARKS for place in _places(mark, block)}
            starts |= {block.rfind(b"\n", 0, found.start()) + 1 for found in _TURNED.finditer(block)}
            for start in sorted(starts):
                stop = block.find(b"\n", start) + 1 or len(block)
                yield block[start:stop].decode("ascii", errors="replace")


def _places(mark: bytes, block: bytes) -> Iterator[int]:
    """Where a text stands in another one; far quicker than a pattern that finds any of several, or line by line."""
    place = block.find(mark)
    while place >= 0:
        yield place
        place = block.find(mark, place + 1)


def _product_faults(file: str, products: Sequence[tuple[str, str, str]], parts: Sequence[Part]) -> Iterator[str]:
    wanted = Counter((string(part.number), string(part.name), string(part.description)) for part in parts)
    for number, name, description in wanted - Counter(products):
        yield f"'{file}' holds no product {name} with the part number {number} that says {description}."
    for number, name, description in Counter(products) - wanted:
        yield (
            f"'{file}' holds a product {name} with the part number {number} that says {description}, which is not "
            "expected there."
        )
