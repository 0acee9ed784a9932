"""What we write is what ISO 10303 allows: known types, so many attributes of these kinds, references that resolve."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.step.file import write_assembly, write_step
from cadpanel.brep.step.part_files import PartFile
from cadpanel.brep.step.products import Place
from cadpanel.brep.step.properties import Material, PartData, Validation
from cadpanel.brep.step.schemas import SCHEMAS
from cadpanel.delivery.settings import Schema, SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.delivery.shop_settings import ShopSettings
from tests.delivered import fitted
from tests.part21 import faults, read_instances
from tests.trays import THICKNESS, tray

PANELS = 2


@pytest.fixture(scope="module", params=list(SCHEMAS))
def files(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ...]:
    """Sheets with holes and square ends, and their skins, with all that we say of them; an assembly of both files."""
    folder, schema = tmp_path_factory.mktemp("conformity"), request.param
    shapes = fitted().shapes[:PANELS]
    built = build_panels(shapes, SheetSettings(ends="square"), shop=ShopSettings(fixings=(6.0, 400.0, 20.0))).panels
    solids = [(one.shape.name, one.solid) for one in built]
    skins = [(one.shape.name, one.skin) for one in built]
    _write(folder / "panels.step", schema, solids, [one.check for one in built])
    _write(folder / "skins.step", schema, skins, [one.skin_check for one in built])
    places = ((0.0, 0.0, 0.0), (1.0, 2.0, 3.0), (1.0, 2.0, 3.0))
    names = ("panels.step", "skins.step", "panels.step")
    parts = [
        PartFile(name=str(number), path=name, placed=placed)
        for number, (name, placed) in enumerate(zip(names, places, strict=True))
    ]
    write_assembly(folder / "building.step", parts, title="building", schema=schema)
    return folder / "panels.step", folder / "skins.step", folder / "building.step"


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folded flat panel alone."""
    path, check = (
        tmp_path_factory.mktemp("small") / "a.step",
        Validation(area=1.0, volume=1.0, centroid=(0.0, 0.0, 0.0)),
    )
    _write(path, "AP242", [("T", build_solid(tray(), THICKNESS))], [check], placed=(0.0, 0.0, 0.0))
    return path


def _write(path: Path, schema: Schema, shapes: list, checks: list, placed: Place = (1.0, 2.0, 3.0)) -> None:  # type: ignore[type-arg]
    said = [
        PartData(
            number=name,
            description="Blech 'ß', 3 mm",
            validation=check,
            material=Material(name="EN AW-5754", density=2700.0),
            attributes={"thickness": 3.0, "feature": "plane-cone-plane", "mass": 7.5},
        )
        for (name, _), check in zip(shapes, checks, strict=True)
    ]
    named = [(name, shape, (0.2, 0.4, 0.6)) for name, shape in shapes]
    write_step(path, named, title="t", schema=schema, placed=placed, data=said)


def test_every_instance_is_what_the_standard_says(files: tuple[Path, ...]) -> None:
    for path in files:
        assert list(faults(read_instances(path)))[:5] == []


def test_a_file_has_as_many_instances_as_its_panels_make(files: tuple[Path, ...]) -> None:
    for path, bodies in zip(files[:2], ("MANIFOLD_SOLID_BREP", "SHELL_BASED_SURFACE_MODEL"), strict=True):
        counts = Counter("+".join(parts) for parts in read_instances(path).values())
        assert counts[bodies] == counts["STYLED_ITEM"] == counts["NEXT_ASSEMBLY_USAGE_OCCURRENCE"] == PANELS
        for kind in ("", "_DEFINITION", "_DEFINITION_FORMATION"):
            assert counts[f"PRODUCT{kind}"] == counts["SHAPE_DEFINITION_REPRESENTATION"] == PANELS + 1
        assert counts["APPLICATION_PROTOCOL_DEFINITION"] == 1
        assert counts["ADVANCED_FACE"] == counts["FACE_OUTER_BOUND"]
        assert counts["EDGE_LOOP"] == counts["FACE_OUTER_BOUND"] + counts["FACE_BOUND"]
        assert counts["PROPERTY_DEFINITION"] == counts["PROPERTY_DEFINITION_REPRESENTATION"] == counts["REPRESENTATION"]
        if bodies == "MANIFOLD_SOLID_BREP":
            assert counts["ORIENTED_EDGE"] == 2 * counts["EDGE_CURVE"]


@pytest.mark.parametrize(
    ("was", "now", "said"),
    [
        ("CLOSED_SHELL('',(", "CLOSED_HULL('',(", "no such type is known"),
        ("CIRCLE('',#", "CIRCLE(#", "has 2 attributes instead of 3"),
        ("VERTEX_POINT('',", "VERTEX_POINT('',#1,", "has 3 attributes instead of 2"),
        ("MANIFOLD_SOLID_BREP('',#", "MANIFOLD_SOLID_BREP('',#9", "attribute 2 of MANIFOLD_SOLID_BREP"),
        (".BOTH.,", ".BOTH,", "no Part 21"),
        ("COLOUR_RGB('',", "COLOUR_RGB('',1,", "COLOUR_RGB"),
    ],
)
def test_what_the_standard_does_not_allow_is_seen(small: Path, tmp_path: Path, was: str, now: str, said: str) -> None:
    text = small.read_text()
    assert was in text
    (tmp_path / "a.step").write_text(text.replace(was, now, 1))
    try:
        found = " ".join(faults(read_instances(tmp_path / "a.step")))
    except ValueError as error:
        found = str(error)
    assert said in found


def test_a_part_and_what_it_hangs_in_have_different_contexts_and_axes_of_their_own(small: Path, tmp_path: Path) -> None:
    text = small.read_text()
    parts, assembly = re.findall(r"(#\d+)=\(GEOMETRIC_REPRESENTATION_CONTEXT\(3\)", text)
    own, other = re.findall(r"=ITEM_DEFINED_TRANSFORMATION\('','',(#\d+),(#\d+)\)", text)[0]
    for was, now, said in (
        (f",{assembly});", f",{parts});", f"both representations have the context {parts}"),
        (f"'',{own},{other})", f"'',{own},{own})", f"{own} is no item of the representation"),
        (f"'',{own},{other})", f"'',{other},{other})", f"{other} is no item of the representation"),
    ):
        assert was in text
        (tmp_path / "a.step").write_text(text.replace(was, now))
        [fault] = faults(read_instances(tmp_path / "a.step"))
        assert said in fault


def test_a_folded_flat_panel_is_written_as_the_standard_says(small: Path) -> None:
    assert list(faults(read_instances(small))) == []
