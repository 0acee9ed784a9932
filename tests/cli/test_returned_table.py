"""The table of what came back: what is as it was is counted, what differs has a row."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cadpanel.brep.proof.returned_solids import SolidBack
from cadpanel.cli.returned_table import print_solids_back

SAME = SolidBack(name="N 1", called="N 1", apart=2e-8, volume=-1e-12, area=0.0, valid=True)


def test_solids_that_differ_or_are_called_otherwise_have_a_row(capsys: pytest.CaptureFixture[str]) -> None:
    off, renamed = replace(SAME, name="N 2", called="N 2", apart=0.25), replace(SAME, name="N 3", called="[Body]")
    print_solids_back([SAME, off, renamed], "back.step")
    said = capsys.readouterr().out
    assert said.startswith("back.step: 3 solids of the delivery, off by 0.25 mm at most, volumes by 1e-12")
    assert [name in said for name in ("N 1", "N 2", "[Body]")] == [False, True, True]


def test_what_is_the_same_is_one_line_and_nothing_is_none(capsys: pytest.CaptureFixture[str]) -> None:
    print_solids_back([SAME], "back.step")
    assert capsys.readouterr().out.count("\n") == 1
    print_solids_back([], "back.step")
    assert capsys.readouterr().out == ""
