"""Which faces of a model are the skin: chosen by name, layer, colour or number."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from glob import escape

from cadpanel.brep.files.model import Model, ModelFace, UnreadableFace
from cadpanel.errors import ReferenceFileError
from cadpanel.reference.texts import choice_named

# No file has a thousand million faces, and Python refuses to read numbers that are much longer.
NUMBERS = re.compile(r"0*(\d{1,9})(?:\s*-\s*0*(\d{1,9}))?")
# Words that a message lists of each kind at most.
MOST_LISTED = 8

# What the file says of a face, by the key that asks for it.
_KEYS: dict[str, Callable[[ModelFace | UnreadableFace], tuple[str, ...]]] = {
    "name": lambda face: face.names,
    "layer": lambda face: (face.label.layer,) if face.label.layer else (),
    "color": lambda face: (face.label.color,) if face.label.color else (),
}


def select_faces(model: Model, chosen: Sequence[str] | None) -> tuple[ModelFace, ...]:
    """The faces that are the skin, in file order.

    Args:
        model: what the file holds.
        chosen: as `ReferenceSettings.faces` says; None for all faces, if no solid is among them.

    Raises:
        ReferenceFileError: the file holds no faces, a choice fits none or one that cannot be read, or a solid's outer
            faces are not chosen.
    """
    faces, unreadable = model.faces(), model.unreadable()
    require_faces(model)
    if chosen is None:
        solid = next((face for face in faces if face.of_solid), None)
        if solid is not None:
            raise ReferenceFileError(
                f"'{model.source}' holds a solid, of which face {solid.number} is one: say which of its faces are the "
                f"skin (by number, name, layer or color; {_offers(faces)})."
            )
        return faces
    taken: set[int] = set()
    for word in chosen:
        fitting = _chosen(word, sorted([*faces, *unreadable], key=lambda face: face.number))
        if not fitting:
            raise ReferenceFileError(f"'{model.source}' has no face '{word}': {_offers(faces)}.")
        taken |= fitting
    for lost in unreadable:
        if lost.number in taken:
            raise ReferenceFileError(
                f"Face {lost.number} of '{model.source}' is chosen, and cannot be read: {lost.why}; repair or rebuild "
                "it where it was modelled, or choose other faces."
            )
    return tuple(face for face in faces if face.number in taken)


def require_faces(model: Model) -> None:
    """Refuse a model without faces.

    Raises:
        ReferenceFileError: saying whether there are any that cannot be read.
    """
    if model.faces():
        return
    lost = model.unreadable()
    if lost:
        raise ReferenceFileError(
            f"'{model.source}' holds no face that can be read, as {lost[0].why}: repair or rebuild the faces of the "
            "skin where they were modelled and export them again."
        )
    raise ReferenceFileError(
        f"'{model.source}' holds no faces, only curves, points or nothing: export the faces of the skin, too."
    )


def _chosen(word: str, faces: Sequence[ModelFace | UnreadableFace]) -> set[int]:
    """The numbers of the faces that one word chooses, none where one of them is not there."""
    numbers = NUMBERS.fullmatch(word)
    if numbers is not None:
        first = int(numbers[1])
        last = int(numbers[2] or first)
        return set(range(first, last + 1)) if first >= 1 and last <= len(faces) else set()
    key, equals, wanted = word.partition("=")
    key = key.strip()
    if not equals or key not in _KEYS:
        key, wanted = "name", word
    wanted = wanted.strip().lower() if key == "color" else wanted.strip()
    said = {face.number: _KEYS[key](face) for face in faces}
    alike = {number for number, texts in said.items() if wanted in texts}
    if key == "name" and not alike:  # nor is it a name of the file's, but of one panel among several of that name
        alike = {face.number for face in faces if face.panel == wanted}
    pattern = escape(wanted).replace("[*]", "*")  # no other sign stands for anything
    return alike or {number for number, texts in said.items() if any(fnmatchcase(text, pattern) for text in texts)}


def _offers(faces: Sequence[ModelFace]) -> str:
    """What there is to choose from."""
    offers = [f"it has faces 1 to {len(faces)}" if len(faces) > 1 else "it has face 1 only"]
    for key, said in _KEYS.items():
        words = sorted({word for face in faces for word in said(face)})
        if words:
            more = f" and {len(words) - MOST_LISTED} more" if len(words) > MOST_LISTED else ""
            offers.append(f"{key}s {', '.join(map(choice_named, words[:MOST_LISTED]))}{more}")
    return "; ".join(offers)
