"""Faces are chosen by number, name, layer or colour, in file order; a choice that fits none is told what there is."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

from cadpanel.brep.files.face_choice import MOST_LISTED, select_faces
from cadpanel.brep.files.model import Label, Model, Part
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.errors import ReferenceFileError
from tests.known_faces import flat

WORDS = ("Roof", "roof edge", "wall [1]", "wall 2", "", "Roof")
LAYERS = ("A", "A", "B", "B*", "", "C")
COLORS = ("#FF0000", "#ff0000", "#00ff00", "", "", "#0000ff")


def plate(x):
    return flat([(x, 0, 0), (x + 1, 0, 0), (x + 1, 1, 0), (x, 1, 0)])


def model(words=WORDS, layers=LAYERS, colors=COLORS):
    labels = tuple(
        Label(name=name, layer=layer, color=color.lower())
        for name, layer, color in zip(words, layers, colors, strict=True)
    )
    parts = (Part(label=Label(), shape=compound_of([plate(2.0 * k) for k in range(len(labels))]), face_labels=labels),)
    return Model(source="roof.step", format="STEP", unit="millimetre", parts=parts)


def chosen(*words):
    return [face.number for face in select_faces(model(), words)]


@pytest.mark.parametrize(
    ("word", "numbers"),
    [
        ("3", [3]),
        ("2-4", [2, 3, 4]),
        (" 002 - 04".strip(), [2, 3, 4]),
        ("Roof", [1, 6]),
        ("name=Roof", [1, 6]),
        ("name = Roof", [1, 6]),
        ("roof*", [2]),
        ("*oof*", [1, 2, 6]),
        ("wall [1]", [3]),
        ("wall*", [3, 4]),
        ("layer=A", [1, 2]),
        ("layer=B*", [4]),  # its very name comes before what the star could stand for
        ("layer=C", [6]),
        ("color=#FF0000", [1, 2]),
        ("color=#0*", [3, 6]),
    ],
)
def test_one_word_chooses(word, numbers):
    assert chosen(word) == numbers


@given(numbers=st.lists(st.integers(1, 6), min_size=1, max_size=8))
def test_several_words_choose_together_each_face_once_in_file_order(numbers):
    assert chosen(*map(str, numbers)) == sorted(set(numbers))


@pytest.mark.parametrize("word", ["0", "7", "0-3", "2-7", "4-2", "layer=D", "Roo?", "color=red", "kind=Roof", "roof"])
def test_a_choice_that_fits_none_is_refused_with_what_there_is(word):
    with pytest.raises(ReferenceFileError, match=r"'roof.step' has no face '.*': it has faces 1 to 6; names Roof,"):
        chosen("1", word)


def test_no_more_words_are_listed_than_can_be_read():
    names = [f"n{k:02d}" for k in range(MOST_LISTED + 3)]
    many = model(names, [""] * len(names), [""] * len(names))
    with pytest.raises(ReferenceFileError, match=r"names n00, .*n07 and 3 more\.$"):
        select_faces(many, ["none"])
    with pytest.raises(ReferenceFileError, match=r"it has face 1 only\.$"):
        select_faces(model([""], [""], [""]), ["none"])


def test_all_faces_are_taken_where_none_are_chosen_unless_there_is_a_solid():
    assert len(select_faces(model(), None)) == len(WORDS)
    box = BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape()
    solid = Model(
        source="box.step",
        format="STEP",
        unit="millimetre",
        parts=(Part(label=Label(), shape=box, face_labels=(Label(),) * 6),),
    )
    with pytest.raises(ReferenceFileError, match=r"'box.step' holds a solid, of which face 1 is one"):
        select_faces(solid, None)
    assert [face.number for face in select_faces(solid, ["2", "5-6"])] == [2, 5, 6]


def test_a_file_without_faces_is_refused():
    empty = Model(source="none.step", format="STEP", unit="millimetre", parts=())
    with pytest.raises(ReferenceFileError, match=r"'none.step' holds no faces"):
        select_faces(empty, None)
