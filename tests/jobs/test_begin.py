"""Which way to cut a job begins with, of surfaces that are only told about."""

from __future__ import annotations

import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cadpanel.brep.skin.conjugate import SeamLean
from cadpanel.brep.survey import SurfaceSurvey
from cadpanel.errors import PanelError, ReferenceFileError
from cadpanel.jobs import begin as module
from cadpanel.jobs.begin import Begun, begun_job
from cadpanel.jobs.names import first_fault
from cadpanel.jobs.variables import substituted
from cadpanel.reference.settings import ReferenceSettings

LEANING = SeamLean(mean=5.0, largest=9.0, at=100.0)


def surface(name: str, faces: tuple[int, ...], strip: tuple[float, float] | None, **more: Any) -> SurfaceSurvey:
    return SurfaceSurvey(name=name, faces=faces, area=4e6, strip=strip, **{"lips": (), "seams": None} | more)


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    """A job for surfaces where only some ways to cut and some features give panels."""

    def begin(surfaces: list[SurfaceSurvey], *, reads: Any, fits: Any = lambda *_: True) -> dict[str, Any]:
        def read(_file: Path, how: ReferenceSettings) -> SimpleNamespace:
            if not reads(how):
                raise ReferenceFileError(f"it cannot be cut by {how.way}.")
            return SimpleNamespace(panels=[SimpleNamespace(edges=[0] * 4)] * 3, seams=[], settings=how)

        def fit(reference: Any, settings: Any) -> None:
            if not fits(reference.settings, settings.feature):
                raise PanelError("S1-01", "is none.")

        monkeypatch.setattr("cadpanel.brep.read.read_reference", read)
        monkeypatch.setattr("cadpanel.brep.survey.survey", lambda *_: SimpleNamespace(surfaces=tuple(surfaces)))
        monkeypatch.setattr(module, "fit", fit)
        text = begun_job(tmp_path / "a" / "skin.brep", ReferenceSettings(unit="m"), tmp_path)
        found = tomllib.loads(text)
        assert found["defaults"] == {"reference": "a/skin.brep", "unit": "m"}
        regions: dict[str, Any] = found["regions"]
        return regions

    return begin


def test_products_that_are_panels_are_taken_as_they_are(begun: Any) -> None:
    assert begun([], reads=lambda how: how.way is None) == {"skin": {"feature": "plane-cone-plane"}}
    found = begun([], reads=lambda how: how.way is None, fits=lambda _, feature: feature == "planar-quadrilateral")
    assert found == {"skin": {"feature": "planar-quadrilateral"}}


def test_every_surface_has_the_first_way_to_cut_that_gives_panels(begun: Any) -> None:
    surfaces = [
        surface("S1", (1, 2, 3, 7), (9000.0, 800.0), seams=LEANING),
        surface("Roof, north", (4,), (9000.0, 8000.0)),
        surface("Job.toml", (5, 6), None),
    ]
    assert begun(surfaces, reads=lambda how: how.way is not None) == {
        "S1": {"faces": ["1-3", "7"], "panel_length": 2000.0, "seams": "conjugate", "feature": "cone"},
        "Roof, north": {"faces": ["4"], "panel_size": [1000.0, 1000.0], "feature": "cone"},
        "Job.toml-2": {"faces": ["5-6"], "panel_size": [1000.0, 1000.0], "feature": "cone"},
    }
    found = begun(surfaces[:1], reads=lambda how: how.way == "grid", fits=lambda _, feature: feature != "cone")
    assert found == {"S1": {"grid": [2, 2], "feature": "planar-quadrilateral"}}


def test_a_surface_that_nothing_cuts_is_left_out_and_a_file_of_such_is_refused(begun: Any) -> None:
    surfaces = [surface("S1", (1,), (3000.0, 500.0)), surface("S2", (2,), None)]
    assert set(begun(surfaces, reads=lambda how: how.faces == ("1",) and how.way == "panel_length")) == {"S1"}
    with pytest.raises(ReferenceFileError, match=r"no way was found to cut 'skin\.brep' into panels: it cannot be cut"):
        begun(surfaces, reads=lambda _: False)


@pytest.mark.parametrize("name", ["${x}.step", "a\n[b]\x07.step", "job.toml.step", "$${x}'.step"])
def test_whatever_a_file_is_called_it_is_named_as_it_is(tmp_path: Path, name: str) -> None:
    """Among the names some that would be a variable, end a comment, or be the file of a job."""
    good = Begun(module._name(Path(name).stem), "", {"faces": ("name=${y}",)})
    bad = Begun("S2", "", {}, "it\x07is")
    read = tomllib.loads(module._text(tmp_path / name, ReferenceSettings(), tmp_path, (good, bad)))
    assert substituted(read["defaults"]["reference"], {}) == name
    ((region, values),) = read["regions"].items()
    assert first_fault([region], [True]) is None
    assert substituted(values, {}) == {"faces": ["name=${y}"]}


def test_lengths_to_begin_with_have_two_digits() -> None:
    assert [module._round(one) for one in (2000.0, 1234.5, 87.6, 0.123)] == pytest.approx([2000.0, 1200.0, 87.0, 0.12])
    assert np.log10(module.USUAL_LENGTH) > 3
