"""The add-on's folder: what is written, what is replaced, and what is refused; no FreeCAD is needed."""

from __future__ import annotations

import json
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from cadpanel.cli.main import main
from cadpanel.errors import DeliveryError, SettingsError
from cadpanel.freecad import install as installing
from cadpanel.freecad.install import ADDON, WORKBENCH, folder_of_addons, install


def test_the_add_on_lies_as_freecad_wants_it_and_knows_this_python(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["freecad", "install", "--to", str(tmp_path / "Mod")]) == 0
    place = tmp_path / "Mod" / "cadpanel"
    assert str(place) in capsys.readouterr().out
    assert not (place / "freecad" / "__init__.py").exists()  # it is FreeCAD's own name space
    assert {file.name for file in ADDON.iterdir() if file.suffix in (".py", ".svg")} <= {
        file.name for file in (place / WORKBENCH).iterdir()
    }
    assert json.loads((place / WORKBENCH / "interpreter.json").read_text(encoding="utf-8"))["python"] == sys.executable
    tags = {one.tag.rpartition("}")[2]: one.text for one in ElementTree.parse(place / "package.xml").iter()}
    assert (tags["classname"], tags["freecadmin"]) == ("CadpanelWorkbench", "0.20.0")
    assert tags["version"] != "{version}"


def test_an_older_add_on_of_ours_is_replaced_and_nothing_else(tmp_path: Path) -> None:
    place = install(tmp_path)
    (place / WORKBENCH / "old.py").touch()
    install(tmp_path)
    assert not (place / WORKBENCH / "old.py").exists()
    (place / "package.xml").write_text("<name>another</name>", encoding="utf-8")
    with pytest.raises(DeliveryError, match="is not an add-on of cadpanel's: move it elsewhere"):
        install(tmp_path)
    (tmp_path / "file").touch()
    with pytest.raises(DeliveryError, match="cannot be written"):
        install(tmp_path / "file")


def test_without_freecad_one_is_asked_where_it_keeps_add_ons(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(installing, "PROGRAMS", ("a-program-that-is-not-there",))
    with pytest.raises(SettingsError, match=r"name its folder of add-ons with --to DIR"):
        folder_of_addons()
    monkeypatch.setattr(installing, "PROGRAMS", ("true",))
    with pytest.raises(SettingsError, match="does not say where FreeCAD keeps add-ons"):
        folder_of_addons()
