"""Faces of a STEP file that the kernel cannot make: of which products they are, by the file's own references.

The kernel tells at which instance it fails. Its own graph of references cannot be asked from here, so they are read
from the file's text, in which instances stand in the kernel's order.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from OCP.StepBasic import StepBasic_Product
from OCP.StepData import StepData_StepModel

from cadpanel.brep.files.text_check import QUOTED

INSTANCE = re.compile(rb"#(\d+)\s*=\s*(\(?)\s*(\w+)([^;]*);")
COMMENT = re.compile(rb"/\*.*?\*/", re.DOTALL)
REFERENCE = re.compile(rb"#(\d+)")
FACES = {b"ADVANCED_FACE", b"FACE_SURFACE"}
# Whatever lies on one of them is lost with it; a curve that fails may leave its face, cut in another way.
SURFACES = {
    *(b"PLANE", b"CYLINDRICAL_SURFACE", b"CONICAL_SURFACE", b"SPHERICAL_SURFACE", b"TOROIDAL_SURFACE"),
    *(b"SURFACE_OF_REVOLUTION", b"SURFACE_OF_LINEAR_EXTRUSION", b"B_SPLINE_SURFACE_WITH_KNOTS", b"B_SPLINE_SURFACE"),
    *(b"OFFSET_SURFACE", b"RECTANGULAR_TRIMMED_SURFACE", b"CURVE_BOUNDED_SURFACE", b"BOUNDED_SURFACE"),
    *(b"UNIFORM_SURFACE", b"QUASI_UNIFORM_SURFACE", b"BEZIER_SURFACE", b"DEGENERATE_TOROIDAL_SURFACE"),
}
DEFINED = b"SHAPE_DEFINITION_REPRESENTATION"
SAME_SHAPE = b"SHAPE_REPRESENTATION_RELATIONSHIP"
TO_THE_PRODUCT = (b"PRODUCT_DEFINITION_SHAPE", b"PRODUCT_DEFINITION", b"PRODUCT_DEFINITION_FORMATION")


class Failure(NamedTuple):
    """Where the kernel fails: the place of an instance in the file, from 1, and what it says."""

    place: int
    said: str


class LostFace(NamedTuple):
    """A face that the kernel cannot make: the name of its product, and what the kernel says."""

    product: str
    said: str

    @property
    def why(self) -> str:
        """As a clause."""
        return f"the CAD kernel cannot make it ({self.said})"


@dataclass(frozen=True, slots=True)
class _Data:
    """The instances of a file by their numbers: what they are, what they refer to, and what refers to them."""

    kinds: Mapping[int, bytes]
    refers: Mapping[int, Sequence[int]]
    users: Mapping[int, Sequence[int]]


def lost_faces(text: bytes, model: StepData_StepModel, failures: Sequence[Failure]) -> list[LostFace] | None:
    """The faces that are lost where the kernel fails.

    Args:
        text: of the file.
        model: what the kernel has read of it.
        failures: at least one.

    Returns:
        None where it is not certain which faces are lost, and that nothing else is.
    """
    data = _data(text)
    order = list(data.kinds)
    if len(order) != model.NbEntities():
        return None
    found: dict[int, LostFace] = {}
    for failure in failures:
        faces = list(_faces_on(data, order[failure.place - 1]))
        for face in faces:
            products = list(_products_of(data, face))
            if len(products) != 1:
                return None
            product = model.Value(order.index(products[0]) + 1)
            if not isinstance(product, StepBasic_Product):
                return None
            found[face] = LostFace(str(product.Name().ToCString()), failure.said)
        if not faces:
            return None
    return list(found.values())


def _data(text: bytes) -> _Data:
    bare = COMMENT.sub(b"", QUOTED.sub(b"''", text))
    kinds: dict[int, bytes] = {}
    refers: dict[int, Sequence[int]] = {}
    users: dict[int, list[int]] = {}
    for number, complex_, kind, rest in INSTANCE.findall(bare):
        own = int(number)
        # Of several kinds at once the first names a surface; a relation with a transformation is no shape's own.
        kinds[own] = b"(" + kind if complex_ and kind not in SURFACES else kind
        refers[own] = [int(one) for one in REFERENCE.findall(rest)]
        for one in refers[own]:
            users.setdefault(one, []).append(own)
    return _Data(kinds, refers, users)


def _faces_on(data: _Data, failed: int) -> Iterator[int]:
    """The faces on a surface, or on surfaces made of it; none where it is no surface."""
    seen, left = {failed}, [failed] if data.kinds[failed] in SURFACES else []
    while left:
        one = left.pop()
        kind = data.kinds[one]
        if kind in FACES:
            yield one
        elif kind in SURFACES:
            new = [user for user in data.users.get(one, ()) if user not in seen]
            seen.update(new)
            left += new


def _products_of(data: _Data, face: int) -> Iterator[int]:
    """The products whose shape a face is a part of."""
    seen, left = {face}, [face]
    while left:
        one = left.pop()
        kind = data.kinds[one]
        if kind == DEFINED:
            yield from _down(data, one)
            continue
        new = [*data.users.get(one, ()), *(data.refers[one] if kind == SAME_SHAPE else ())]
        new = [user for user in new if user not in seen and user in data.kinds]
        seen.update(new)
        left += new


def _down(data: _Data, defined: int) -> Iterator[int]:
    """The products that a definition of a shape belongs to."""
    for one in data.refers[defined]:
        kind = data.kinds.get(one, b"")
        if kind == b"PRODUCT":
            yield one
        elif kind.startswith(TO_THE_PRODUCT):
            yield from _down(data, one)
