"""A STEP file cut in two: nothing lost, nothing twice but what all share, and left whole where that is unsure."""

import re
from pathlib import Path

import pytest

from cadpanel.brep.files.step_parts import cut_in_two
from cadpanel.brep.files.text_check import QUOTED
from fixtures.make_fixtures import Fixture, write
from tests.benchmarks.strips import long_lip
from tests.kernel_step import write_by_kernel
from tests.reference_shapes import Lip, kernel_lip, write_products

FIXTURES = Path(__file__).parents[3] / "fixtures"
NW = (FIXTURES / "kai_tak_nw.step").read_bytes()
INSTANCE = re.compile(rb"#(\d+)\s*=([^;]*);")
REFERENCE = re.compile(rb"#(\d+)")


def small(*products, more=b"", application=b"#1=APPLICATION_CONTEXT('a');\n"):
    """Products of one point each, under one context; `more` follows them."""
    text = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n" + application
    for place, name in enumerate(products, start=1):
        text += b"#%d0=PRODUCT('%s','',#1);\n#%d1=PRODUCT_DEFINITION('',#%d0);\n" % (place, name, place, place)
        text += b"#%d2=CARTESIAN_POINT('',(1.,2.,3.));\n#%d3=SHAPE(#%d1,#%d2);\n" % (place, place, place, place)
    return text + more + b"ENDSEC;\nEND-ISO-10303-21;\n"


def cut(text, groups=1):
    parts = cut_in_two(text, groups)
    assert parts is not None
    return parts


def joined(part):
    return b"".join(part.pieces)


def numbers(text):
    return [int(number) for number, _ in INSTANCE.findall(text)]


@pytest.mark.parametrize("text", [NW, small(b"a", b"b", b"c")], ids=["a strip", "three points"])
def test_both_parts_are_files_whose_references_are_all_there(text):
    parts = cut(text)
    for part in map(joined, parts):
        bare = QUOTED.sub(b"''", part)  # texts name contexts by numbers
        there = set(numbers(bare))
        assert all(int(used) in there for _, rest in INSTANCE.findall(bare) for used in REFERENCE.findall(rest))
        assert part.startswith(text[: text.index(b"DATA;")])
        assert part.endswith(b"END-ISO-10303-21;\n")


@pytest.mark.parametrize("text", [NW, small(b"a", b"b", b"c")], ids=["a strip", "three points"])
def test_instances_stand_in_their_order_and_are_in_both_only_where_both_need_them(text):
    one, other = (numbers(joined(part)) for part in cut(text))
    order = numbers(text)
    assert sorted(one, key=order.index) == one
    assert sorted(other, key=order.index) == other
    twice = {*one} & {*other}
    kinds = {kind for number, kind in INSTANCE.findall(text) if int(number) in twice}
    assert not any(b"ADVANCED_FACE" in kind or b"CARTESIAN_POINT('',(1." in kind for kind in kinds)


@pytest.mark.parametrize("groups", [1, 2, 3, 4])
def test_the_first_part_holds_whole_groups_of_products(groups):
    one, other = cut(NW, groups)
    assert one.products % groups == 0
    assert one.products + other.products == 8
    for part in (one, other):
        assert joined(part).count(b" = PRODUCT_DEFINITION(") == part.products


def test_products_of_less_than_two_groups_stay_together():
    assert cut_in_two(NW, 16) is None


@pytest.mark.parametrize(
    "text",
    [
        small(b"a"),
        small(),
        small(b"a", b"b").replace(b"DATA;", b"DATE;"),
        small(b"a", b"b").replace(b"ENDSEC;", b""),
        small(b"a", b"b").replace(b"#12", b"#21"),  # a number twice
        small(b"a", b"b").replace(b"#11,#12", b"#11,#99"),  # a reference to nothing
        small(b"a", b"b").replace(b"#11,#12", b"#11,#999999999"),
        small(b"a", b"b").replace(b"#11,#12", b"#11,#"),
        small(b"a", b"b", more=b"/* a comment */"),
        small(b"a", b"b", more=b"text"),
        small(b"a", b"b'"),  # a quote that does not end
        small(b"a", b"b", more=b"#50=NEXT_ASSEMBLY_USAGE_OCCURRENCE(#11,#21);\n"),
        small(b"a", b"b", more=b"#50=CARTESIAN_POINT('',(0.,0.,0.));\n"),  # of which nobody knows whose it is
        small(b"a", b"b", more=b"DATA;\n"),
        b"",
        b"DATA;ENDSEC;",
        b"DATA;;;;ENDSEC;",
    ],
)
def test_a_file_that_is_not_plain_stays_whole(text):
    assert cut_in_two(text, 1) is None


SHAPES = [
    *(b"SHAPE_REPRESENTATION", b"SHELL_BASED_SURFACE_MODEL", b"OPEN_SHELL", b"ADVANCED_FACE", b"FACE_OUTER_BOUND"),
    *(b"EDGE_LOOP", b"ORIENTED_EDGE", b"EDGE_CURVE", b"VERTEX_POINT", b"B_SPLINE_CURVE_WITH_KNOTS", b"PLANE"),
    *(b"MAPPED_ITEM", b"REPRESENTATION_MAP", b"PRODUCT", b"PRODUCT_DEFINITION_FORMATION", b"PRODUCT_DEFINITION_SHAPE"),
    *(b"WHAT_NOBODY_KNOWS", b"CARTESIAN_POINTS", b"(BOUNDED_CURVE()B_SPLINE_CURVE", b"( BOUNDED_SURFACE()X"),
]
SAID = [
    *(b"APPLICATION_CONTEXT", b"PRODUCT_CONTEXT", b"CARTESIAN_POINT", b"DIRECTION", b"AXIS2_PLACEMENT_3D"),
    *(b"COLOUR_RGB", b"SURFACE_STYLE_USAGE", b"(GEOMETRIC_REPRESENTATION_CONTEXT", b"( LENGTH_UNIT()NAMED_UNIT"),
]


def shared(kind):
    """Two products of which either refers to an instance of some kind."""
    text = small(b"a", b"b", more=b"#50=%s('',#1);\n" % kind)
    return text.replace(b"#12)", b"#12,#50)").replace(b"#22)", b"#22,#50)")


@pytest.mark.parametrize("kind", SHAPES, ids=bytes.decode)
def test_a_file_whose_products_share_a_shape_stays_whole(kind):
    assert cut_in_two(shared(kind), 1) is None


@pytest.mark.parametrize("kind", SAID, ids=bytes.decode)
def test_what_is_only_said_of_products_may_be_shared(kind):
    assert all(50 in numbers(joined(part)) for part in cut(shared(kind)))


def test_a_product_may_show_a_shape_again_unless_it_is_the_other_ones():
    more = b"#50=SHAPE_REPRESENTATION('',(#12));\n#51=MAPPED_ITEM('',#52,#12);\n#52=REPRESENTATION_MAP(#12,#50);\n"
    again = small(b"a", b"b", more=more).replace(b"#11,#12)", b"#11,#51)")
    assert {50, 51, 52} <= {*numbers(joined(cut(again).one))}
    assert cut_in_two(again.replace(b"#21,#22)", b"#21,#50)"), 1) is None


def written_by_kernel(path):
    write_by_kernel(path, [(f"panel {place}", tray(place)) for place in range(4)])


def written_as_products(path):
    write_products(path, [(f"panel {place}", tray(place)) for place in range(4)])


def a_long_strip(path):
    write(Fixture(file=path.name, prefix="P", table=(), lip=long_lip(4)), path)


def tray(place):
    """Three flat faces of one panel, beside those of the others."""
    return kernel_lip(Lip(start=2000.0 * place, twist=0.0, taper=0.0))


@pytest.mark.parametrize("written", [written_by_kernel, written_as_products, a_long_strip])
def test_files_as_they_are_usually_written_are_cut(tmp_path, written):
    written(tmp_path / "written.step")
    assert [part.products for part in cut((tmp_path / "written.step").read_bytes())] == [2, 2]


@pytest.mark.parametrize("name", ["kai_tak_nw", "kai_tak_se_east", "kai_tak_se_south"])
def test_the_fixtures_are_cut(name):
    cut((FIXTURES / f"{name}.step").read_bytes())


def test_lists_of_what_is_drawn_are_left_out():
    more = b"#50=PRESENTATION_LAYER_ASSIGNMENT('x','',(#12,#22));\n"
    parts = cut(small(b"a", b"b", more=more))
    assert not any(50 in numbers(joined(part)) for part in parts)


def test_what_is_said_of_one_product_goes_with_it():
    more = b"#50=ITEM(#22,#51);\n#51=COLOUR(1.);\n"
    one, other = (numbers(joined(part)) for part in cut(small(b"a", b"b", more=more)))
    assert not {50, 51} & {*one}
    assert {50, 51} <= {*other}


@pytest.mark.parametrize("name", [b"a;b", b"#21", b"=PRODUCT_DEFINITION(", b"it''s", b"#5=X(#9);"])
def test_texts_may_say_anything(name):
    parts = cut(small(name, b"b", b"c"))
    assert [part.products for part in parts] == [2, 1]


@pytest.mark.parametrize("stop", range(0, small(b"a", b"b").rindex(b"ENDSEC"), 7))
def test_a_text_that_breaks_off_is_cut_nowhere(stop):
    text = small(b"a", b"b")[:stop]
    assert cut_in_two(text, 1) is None
