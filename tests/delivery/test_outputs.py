"""A delivery holds what the catalogue of outputs says, and a new output is written and demanded like the old ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.delivery import deliver as delivering
from cadpanel.delivery import verify as verifying
from cadpanel.delivery.folder import COMPARISON, OWN_FILES, REPORT
from cadpanel.delivery.outputs.catalogue import OUTPUTS
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.delivery.settings import SheetSettings
from cadpanel.errors import DeliveryError
from tests.delivered import fitted


class NameList(Output):
    """The panels' names, one a line."""

    name = "names"
    files = ("names.txt",)
    always = True

    def write(self, folder: Path, delivery: Delivery) -> None:
        lines = [f"{delivery.title} {delivery.sheet.thickness:g}", *(panel.shape.name for panel in delivery.panels)]
        (folder / "names.txt").write_text("\n".join(lines), encoding="utf-8")


def test_outputs_have_names_and_files_of_their_own() -> None:
    files = [file for output in OUTPUTS for file in output.files]
    assert len({output.name for output in OUTPUTS}) == len(OUTPUTS)
    assert len(set(files)) == len(files)
    assert not {REPORT, COMPARISON} & set(files)
    assert {REPORT, COMPARISON, *files} == OWN_FILES


def test_a_delivery_holds_the_report_and_what_is_always_there(tmp_path: Path) -> None:
    delivering.deliver(fitted(), tmp_path / "out")
    always = {file for output in OUTPUTS if output.always for file in output.files}
    assert {path.name for path in (tmp_path / "out").iterdir()} == {REPORT, *always}


def test_a_new_output_is_written_told_of_and_demanded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    more = (*OUTPUTS, NameList())
    for module in (delivering, verifying):
        monkeypatch.setattr(module, "OUTPUTS", more)
    told: list[tuple[str, int, int]] = []
    delivering.deliver(
        fitted(), tmp_path / "out", SheetSettings(thickness=2.5), progress=lambda *step: told.append(step)
    )
    names = tmp_path / "out" / "names.txt"
    assert names.read_text(encoding="utf-8").splitlines() == ["arrays 2.5", "N 1", "N 2", "N 3"]
    assert ("write", len(more), len(more)) in told
    assert verifying.verify(tmp_path / "out").holds
    names.unlink()
    with pytest.raises(DeliveryError, match=r"holds no names\.txt"):
        verifying.verify(tmp_path / "out")


def test_an_output_that_is_not_always_there_is_neither_written_nor_demanded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = NameList()
    asked.always = False
    for module in (delivering, verifying):
        monkeypatch.setattr(module, "OUTPUTS", (*OUTPUTS, asked))
    delivering.deliver(fitted(), tmp_path / "out")
    assert not (tmp_path / "out" / "names.txt").exists()
    assert verifying.verify(tmp_path / "out").holds
