"""An assembly whose parts are STEP files of their own, beside it: the way to a whole building that no one file holds.

Written as the CAx-IF recommends in "External References": a product without a shape, which stands in a document that
names a file. OCCT's reader, and with it FreeCAD, looks for that file from the folder of the assembly and hangs what it
holds in its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import IO

from cadpanel.brep.step.products import Header, StepFrame, begin_step_text, end_step_text
from cadpanel.brep.step.properties import PartData
from cadpanel.brep.step.schemas import Schema
from cadpanel.brep.step.text import StepText, string


@dataclass(frozen=True, slots=True, kw_only=True)
class PartFile:
    """A STEP file that is a part.

    Attributes:
        name: what the part is called.
        path: of the file, from the folder of the assembly, its folders parted by slashes.
        placed: where the origin of its coordinates lies in the assembly, mm.
    """

    name: str
    path: str
    placed: tuple[float, float, float] = (0.0, 0.0, 0.0)


def write_assembly_text(
    file: IO[str], parts: Sequence[PartFile], title: str, schema: Schema, header: Header | None = None
) -> None:
    """Write the whole file.

    Args:
        file: that is written from its beginning.
        parts: in their order.
        title: name of the assembly.
        schema: "AP242" or "AP214", that of the parts, too.
        header: who wrote it, and when.
    """
    text = begin_step_text(file, title, schema, header)
    frame = StepFrame(text, schema)
    assembly = frame.assembly(title, (part.placed for part in parts))
    kind = text.add("DOCUMENT_TYPE('')")
    for number, part in enumerate(parts, start=1):
        document = _document(text, part.path, kind, schema)
        data = PartData(number=f"{title}/{part.name}")
        product = frame.product(part.name, data, "SHAPE_REPRESENTATION", [], [document])
        _refer(text, document, product.definition)
        frame.place(product, assembly, number, part.name, part.placed)
    end_step_text(file)


def _document(text: StepText, path: str, kind: int, schema: Schema) -> int:
    """A document that is a file: where it is found, and in which format it is."""
    add, called = text.add, string(path)
    document = add(f"DOCUMENT_FILE({called},'','',#{kind},'',$)")
    role = add("IDENTIFICATION_ROLE('external document id and location','')")
    source = add("EXTERNAL_SOURCE(IDENTIFIER(''))")
    add(f"APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT({called},#{role},#{source},(#{document}))")
    add(f"DOCUMENT_REPRESENTATION_TYPE('digital',#{document})")
    found = add(f"PROPERTY_DEFINITION('document property','',#{document})")
    item = add(f"DESCRIPTIVE_REPRESENTATION_ITEM('data format','STEP {schema}')")
    context = add("REPRESENTATION_CONTEXT('','')")
    representation = add(f"REPRESENTATION('document format',(#{item}),#{context})")
    add(f"PROPERTY_DEFINITION_REPRESENTATION(#{found},#{representation})")
    return document


def _refer(text: StepText, document: int, definition: int) -> None:
    """Say that a product's shape is what the document holds."""
    text.add(f"PROPERTY_DEFINITION('external definition','',#{definition})")
    reference = text.add(f"APPLIED_DOCUMENT_REFERENCE(#{document},'',(#{definition}))")
    role = text.add("OBJECT_ROLE('mandatory',$)")
    text.add(f"ROLE_ASSOCIATION(#{role},#{reference})")
