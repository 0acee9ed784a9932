"""What a STEP file's text tells before the kernel sees it: where it breaks off, and numbers that are none."""

import os
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.brep.files.text_check import MARGIN_BYTES, check_step_text, contents, refuse_format
from cadpanel.errors import ReferenceFileError


def text_of(*instances):
    lines = ["ISO-10303-21;", "HEADER;", "ENDSEC;", "DATA;", *instances, "ENDSEC;", "END-ISO-10303-21;", ""]
    return "\n".join(lines).encode()


def point(number, x):
    return f"#{number}=CARTESIAN_POINT('',({x},0.,0.));"


@given(number=st.floats(allow_nan=False, allow_infinity=False).filter(lambda x: 1e-90 < abs(x) < 1e90 or x == 0.0))
def test_numbers_pass_however_they_are_written(tmp_path_factory, number):
    for written in (repr(number), f"{number:.6E}", f"{number:.3f}"):
        check_step_text(tmp_path_factory.getbasetemp() / "a.step", text_of(point(7, written)))


NO_NUMBERS = (
    "nan",
    "NaN",
    "-NAN",
    "inf",
    "-Infinity",
    "1.#QNAN",
    "1.#IND00",
    "1.E400",
    "2.5E+308",
    "-1.E+0101",
    "1" + 120 * "0" + ".",
)


@pytest.mark.parametrize("word", NO_NUMBERS)
def test_a_coordinate_that_is_no_number_is_refused_with_its_instance(tmp_path, word):
    text = text_of(point(12, "1."), point(34, word), point(56, "2."))
    with pytest.raises(
        ReferenceFileError, match=rf"'a.step' holds .*\({re.escape(word[:40])} at #34\): repair that face"
    ):
        check_step_text(tmp_path / "a.step", text)


@pytest.mark.parametrize(
    "word", ["0.E+000", "1.5E+003", "0.E+400", "-0.E999", "1.E-999", "0" * 200 + "5.", "1.E+0000099"]
)
def test_a_number_is_judged_by_its_value_and_not_by_its_digits(tmp_path, word):
    check_step_text(tmp_path / "a.step", text_of(point(12, word)))


@pytest.mark.parametrize("name", ["nan", "(inf,", "1.E400", "(nan)", "a ''b, nan ,'' c"])
def test_names_may_hold_anything(tmp_path, name):
    check_step_text(tmp_path / "a.step", text_of(f"#1=PRODUCT('{name}','x',$,(#2));", point(2, "1.E-300")))


@pytest.mark.parametrize(("behind", "passes"), [(0, True), (MARGIN_BYTES - 100, True), (MARGIN_BYTES + 100, False)])
def test_the_end_must_stand_near_the_end(tmp_path, behind, passes):
    text = text_of(point(1, "1.")) + b" " * behind
    if passes:
        check_step_text(tmp_path / "a.step", text)
    else:
        with pytest.raises(ReferenceFileError, match=r"'a.step' breaks off before its end"):
            check_step_text(tmp_path / "a.step", text)


@pytest.mark.parametrize(
    ("head", "called"),
    [
        (b"solid cube\nfacet", "an STL file"),
        (b"AC1032\x00", "a DWG drawing"),
        (b"  0\r\nSECTION\r\n", "a DXF drawing"),
        (b"PK\x03\x04rest", "a ZIP archive"),
        (b"\x1f\x8b\x08", "a gzip archive"),
        (b"ACIS", "of no format that it knows"),
    ],
)
def test_what_is_handed_over_by_mistake_is_called_by_its_name(tmp_path, head, called):
    assert f"'roof.stp' is {called}: cadpanel reads STEP" in str(refuse_format(tmp_path / "roof.stp", head))


def test_contents_are_the_bytes_or_the_first_of_them(tmp_path):
    (tmp_path / "a.step").write_bytes(b"  abc\n")
    assert contents(tmp_path / "a.step") == b"  abc\n"
    assert contents(tmp_path / "a.step", 3) == b"  a"


KINDS = {"missing": "does not exist", "folder": "is a folder", "empty": "is empty"}
if hasattr(os, "mkfifo"):
    KINDS["pipe"] = "is a pipe or a device"


@pytest.mark.parametrize(("kind", "said"), KINDS.items())
def test_what_is_no_file_is_refused(tmp_path, kind, said):
    path = tmp_path / "a.step"
    if kind == "folder":
        path.mkdir()
    elif kind == "empty":
        path.write_text(" \n ")
    elif kind == "pipe":
        os.mkfifo(path)
    with pytest.raises(ReferenceFileError, match=said):
        contents(path)
