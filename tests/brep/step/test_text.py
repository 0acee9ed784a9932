"""The text of a STEP file: numbers and names that read back as they were, and instances that are shared."""

import io
import math
import re
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.brep.step.text import ITEMS_A_LINE, NoReal, StepText, real, references, string

CODES = re.compile(r"''|\\\\|\\X4\\((?:[0-9A-F]{8})+)\\X0\\|\\X2\\((?:[0-9A-F]{4})+)\\X0\\")


def unquoted(text):
    """What ISO 10303-21 says of a string, read back."""

    def character(found):
        if found[1]:
            return bytes.fromhex(found[1]).decode("utf-32-be")
        return bytes.fromhex(found[2]).decode("utf-16-be") if found[2] else found[0][0]

    return CODES.sub(character, text[1:-1])


@given(number=st.floats(allow_nan=False, allow_infinity=False))
def test_a_real_has_a_point_and_all_its_digits(number):
    text = real(number)
    assert float(text) == number
    assert re.fullmatch(r"-?\d+\.\d*(E[-+]?\d+)?", text)


@pytest.mark.parametrize(("number", "text"), [(1e-07, "1.E-07"), (2.5e20, "2.5E+20"), (3.0, "3.0"), (-0.0, "-0.0")])
def test_reals_are_written_as_the_standard_wants_them(number, text):
    assert real(number) == text


@pytest.mark.parametrize("kind", [int, bool, np.int64, np.float32, np.float64, Fraction])
def test_numbers_of_any_kind_are_reals(kind):
    assert real(kind(1)) == "1.0"


@pytest.mark.parametrize("number", [math.inf, -math.inf, math.nan, np.float32("inf")])
def test_what_is_not_finite_is_no_real(number):
    with pytest.raises(NoReal, match=f"the number {float(number)}, and STEP has finite ones alone"):
        real(number)


@given(text=st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0")))
def test_a_string_is_printable_ascii_and_reads_back(text):
    written = string(text)
    assert written[0] == written[-1] == "'"
    assert all(32 <= ord(character) < 127 for character in written)
    assert unquoted(written) == text


@given(count=st.integers(0, 50))
def test_references_are_listed_in_order_and_no_line_grows(count):
    text = references(range(1, count + 1))
    assert [int(one) for one in re.findall(r"#(\d+)", text)] == list(range(1, count + 1))
    assert max(line.count("#") for line in text.splitlines()) <= ITEMS_A_LINE
    assert (text[0], text[-1]) == ("(", ")")


def test_equal_points_share_an_instance_until_they_are_forgotten():
    file = io.StringIO()
    text = StepText(file)
    first = text.shared("CARTESIAN_POINT", (1.0, 2.0, 3.0))
    assert text.shared("CARTESIAN_POINT", (1.0, 2.0, 3.0)) == first
    assert text.shared("DIRECTION", (1.0, 2.0, 3.0)) != first
    assert text.shared("CARTESIAN_POINT", (1.0, 2.0, float(np.nextafter(3.0, 4.0)))) != first
    text.forget()
    assert text.shared("CARTESIAN_POINT", (1.0, 2.0, 3.0)) == 4
    assert text.add("VECTOR('',#2,1.)") == 5
    assert file.getvalue().splitlines()[0] == "#1=CARTESIAN_POINT('',(1.0,2.0,3.0));"
    assert file.getvalue().endswith("#5=VECTOR('',#2,1.);\n")
