"""What the kernel says stands in one sentence."""

from cadpanel.brep.kernel.said import said_by


def test_lines_and_places_in_memory_go_and_a_kind_stands_for_no_words():
    assert said_by(RuntimeError("EXCEPTION in Read(...)\n0x55e0e6c29710 : UNKNOWN TYPE\n")) == (
        "EXCEPTION in Read(...) UNKNOWN TYPE"
    )
    assert said_by(KeyError()) == "KeyError"
