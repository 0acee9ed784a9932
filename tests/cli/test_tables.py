"""What the console says at the end of a fit."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cadpanel.cli.tables import length, print_report
from cadpanel.delivery.records.report import read_report


@pytest.mark.parametrize(("kinks", "told"), [((1.0, 3.0), False), ((12.2, 3.1), True), ((0.0, 12.2), True)])
def test_a_kink_that_people_see_is_told_with_its_seam(
    delivered: Path, capsys: pytest.CaptureFixture[str], kinks: tuple[float, float], told: bool
) -> None:
    report = read_report(delivered / "report.json")
    seams = [seam.model_copy(update={"max_kink": kink}) for seam, kink in zip(report.seams, kinks, strict=True)]
    print_report(report.model_copy(update={"seams": tuple(seams)}), delivered, 1.0)
    said = capsys.readouterr().out
    assert ("largest kink" in said) is told
    if told:
        first, second = seams[kinks.index(12.2)].panels
        assert f"The largest kink, 12.2 degrees, is between '{first}' and '{second}'" in said


@pytest.mark.parametrize("sides", [(), ("side 0",), ("side 1",), ("side 0", "side 1")])
@pytest.mark.parametrize("flat", [False, True])
def test_returns_are_neither_taken_for_the_bend_nor_hide_it(
    delivered: Path, capsys: pytest.CaptureFixture[str], sides: tuple[str, ...], flat: bool
) -> None:
    report = read_report(delivered / "report.json")
    panels = []
    for panel in report.panels:
        leg, round_ = panel.patches[0], panel.patches[1]
        own, taken = (
            (panel.patches[:1], tuple((row[0], row[-1]) for row in panel.taken))
            if flat
            else (panel.patches, panel.taken)
        )
        patches = (*(leg, round_) * ("side 0" in sides), *own, *(round_, leg) * ("side 1" in sides))
        corners = tuple((*row[:1] * (len(patches) + 1),) for row in panel.corners)
        told = {"patches": patches, "taken": taken, "returns": sides, "corners": corners}
        panels.append(panel.model_copy(update=told))
    print_report(report.model_copy(update={"panels": tuple(panels)}), delivered, 1.0)
    assert ("Taken for the bend" in capsys.readouterr().out) is not flat


def test_baselines_stand_beside_the_result_where_they_are_asked_for(
    delivered: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    report = read_report(delivered / "report.json")
    told = []
    for verbose in (False, True):
        print_report(report, delivered, 1.0, verbose=verbose)
        told.append(next(line for line in capsys.readouterr().out.splitlines() if "RMS deviation" in line))
    numbers = [re.findall(r"\d+\.\d+", line) for line in told]
    every = (report.baselines.local, report.baselines.two_stage, report.summary)
    assert numbers[1] == [length(one.rms_deviation) for one in every]
    assert numbers[0] == numbers[1][2:]
