"""An assembly of files is read as it was written, and what another program wrote is known as such."""

from __future__ import annotations

from pathlib import Path

import pytest

from cadpanel.brep.step.file import write_assembly, write_step
from cadpanel.brep.step.hung_files import HungFile, hung_files, is_written_here
from cadpanel.brep.step.part_files import PartFile
from cadpanel.brep.step.products import Header
from cadpanel.errors import DeliveryError

PARTS = [
    PartFile(name="north", path="north/panels.step", placed=(8.3e8 + 1e-7, -2.1e8, 1e-9)),
    PartFile(name="south #3 = 'a'", path="south #3 = 'a';/panels.step"),
    PartFile(name="süd\n", path=r"..\s/panels.step", placed=(1.0 / 3.0, 0.0, 0.0)),
]


@pytest.mark.parametrize("count", [0, 1, 3])
def test_files_and_places_are_read_with_every_digit(tmp_path: Path, count: int) -> None:
    write_assembly(tmp_path / "b.step", PARTS[:count], title="b'c", header=Header(author="O'Neil", note="; #1"))
    assert hung_files(tmp_path / "b.step") == tuple(HungFile(part.path, part.placed) for part in PARTS[:count])
    assert is_written_here(tmp_path / "b.step")


def test_what_another_program_saved_is_not_written_here(tmp_path: Path) -> None:
    write_step(tmp_path / "a.step", [], title="cadpanel")
    text = (tmp_path / "a.step").read_text(encoding="ascii")
    assert is_written_here(tmp_path / "a.step")
    (tmp_path / "a.step").write_text(text.replace("'cadpanel','cadpanel',''", "'OCCT 7.8','FreeCAD',''"))
    assert not is_written_here(tmp_path / "a.step")
    (tmp_path / "a.step").write_bytes(b"")
    assert not is_written_here(tmp_path / "a.step")


@pytest.mark.parametrize(
    ("written", "other"),
    [
        ("DOCUMENT_FILE(", "DOCUMENT("),
        ("CARTESIAN_POINT('',(8", "CARTESIAN_POINT('',(x"),
        ("=NEXT_ASSEMBLY", "9=NEXT_ASSEMBLY"),
        (",1e-09)", ")"),
        ("#", "ü"),
        ("'cadpanel','cadpanel'", "'another','one'"),
        ("END-ISO", ""),
    ],
)
def test_a_damaged_assembly_is_one_sentence(tmp_path: Path, written: str, other: str) -> None:
    path = tmp_path / "b.step"
    write_assembly(path, PARTS[:1], title="b")
    text = path.read_text(encoding="ascii").replace("1.E-09", "1e-09")
    assert written in text
    path.write_text(text.replace(written, other), encoding="utf-8")
    with pytest.raises(DeliveryError, match=r"b\.step' (is no assembly of files|cannot be read)"):
        hung_files(path)
    with pytest.raises(DeliveryError, match="cannot be read"):
        hung_files(tmp_path / "none.step")
