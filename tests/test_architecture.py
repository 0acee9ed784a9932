"""The shape of the project: which way imports go, what is public, how long a file may be, what stands at the top."""

from __future__ import annotations

import ast
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest
from importlinter.cli import lint_imports

import cadpanel
from tests.thorough import THOROUGH

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "cadpanel"
TESTS = ROOT / "tests"
LONGEST_FILE = 400
TOP_LEVEL = {"pyproject.toml", "cadpanel", "tests", "fixtures", "examples", "README.md", "LICENSE"}
HEAVY = {"OCP", "cadquery", "build123d", "vtk", "vtkmodules", "matplotlib", "IPython"}

# What users import from cadpanel itself. A name that leaves this list breaks someone's script.
PUBLIC = {
    *(
        "read",
        "inspect",
        "fit",
        "fewest_panels",
        "compare",
        "study",
        "deliver",
        "verify",
        "diff",
        "assemble",
        "run_job",
    ),
    *("build_solid", "build_skin", "to_cadquery", "to_build123d", "write_step", "unroll"),
    *("FitSettings", "ReferenceSettings", "Weights", "FitResult", "Measures", "Survey", "Verification"),
    *("Reference", "PanelReference", "Seam", "PanelShape", "PolygonShape", "PlanePatch", "ConePatch", "FlatPattern"),
    *("Feature", "Plane", "Cone", "Cylinder", "Blend"),
    *("fit_plane", "fit_cylinder", "fit_cone", "PlaneFit", "CylinderFit", "ConeFit"),
    *("loft", "rails", "deliver_loft", "Loft", "Rail", "LoftError"),
    *("CadpanelError", "ReferenceFileError", "PanelError", "SettingsError", "FitError", "DeliveryError", "ProofError"),
}


def test_imports_go_downwards_only(capsys: pytest.CaptureFixture[str]) -> None:
    status = lint_imports(config_filename=str(ROOT / "pyproject.toml"), no_cache=True, no_logo=True)
    assert status == 0, capsys.readouterr().out


def broken_contracts(folder: Path) -> set[str]:
    """The names of the contracts that the package in a folder breaks."""
    shutil.copy(ROOT / "pyproject.toml", folder)
    answer = subprocess.run(
        [
            sys.executable,
            "-c",
            "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports(no_cache=True))",
        ],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert answer.returncode == 1, answer.stderr
    return {line.partition(" BROKEN")[0] for line in answer.stdout.splitlines() if " BROKEN" in line}


WRONG_IMPORTS = [
    ("geometry", "cadpanel.features", "Imports go downwards only"),
    ("reference", "cadpanel.brep", "Imports go downwards only"),
    ("errors", "cadpanel.geometry", "Imports go downwards only"),
    ("solver", "cadpanel.terms", "The solver stands beside the layers"),
    ("features", "cadpanel.solver", "Only the terms and the fit call the solver"),
    ("delivery", "OCP.gp", "Only brep imports the CAD kernel"),
    ("fitting", "build123d", "Only brep imports the CAD kernel"),
    ("fitting", "cadpanel.brep", "Imports go downwards only"),
    ("studies", "cadpanel.delivery", "Imports go downwards only"),
    ("brep/files", "cadpanel.brep.cutting", "Inside brep, too"),
    ("brep/kernel", "cadpanel.brep.faces", "Inside brep, too"),
    ("brep/isolation", "OCP.gp", "Only brep imports the CAD kernel"),
    ("fitting/measures", "cadpanel.fitting.run", "Inside fitting, too"),
    ("fitting/measures", "cadpanel.terms.state", "What is measured hangs on panels and references"),
]


@pytest.mark.parametrize(
    ("layer", "wrong_import", "contract"),
    WRONG_IMPORTS if THOROUGH else WRONG_IMPORTS[::4],
)
def test_a_wrong_import_is_caught(tmp_path: Path, layer: str, wrong_import: str, contract: str) -> None:
    shutil.copytree(PACKAGE, tmp_path / "cadpanel", ignore=shutil.ignore_patterns("__pycache__"))
    file = tmp_path / "cadpanel" / ("errors.py" if layer == "errors" else f"{layer}/__init__.py")
    file.write_text(f"{file.read_text(encoding='utf-8')}\nimport {wrong_import}\n", encoding="utf-8")
    broken = broken_contracts(tmp_path)
    assert any(name.startswith(contract) for name in broken), broken


def test_a_circle_between_two_files_of_a_room_is_caught(tmp_path: Path) -> None:
    shutil.copytree(PACKAGE, tmp_path / "cadpanel", ignore=shutil.ignore_patterns("__pycache__"))
    file = tmp_path / "cadpanel" / "features" / "rulings.py"
    file.write_text(
        f"{file.read_text(encoding='utf-8')}\nif __debug__:\n    import cadpanel.features.walk\n", encoding="utf-8"
    )
    assert "No circles between the files of a room" in broken_contracts(tmp_path)


def asks_for_a_kind(text: str) -> list[str]:
    """Where a program asks whether a panel or a feature is of one kind."""
    return re.findall(r"isinstance\([^()]*,[^()]*\b(?:PanelShape|PolygonShape|Polygon|Feature)\b[^()]*\)", text)


def test_nobody_asks_whether_a_panel_is_a_chain_or_a_polygon() -> None:
    """A third kind is a class with the members of `Panel` and `PanelFeature`, not one more branch in many files."""
    asking = {str(path): asks_for_a_kind(path.read_text(encoding="utf-8")) for path in PACKAGE.rglob("*.py")}
    assert {path: found for path, found in asking.items() if found} == {}
    assert asks_for_a_kind("if isinstance(shape, PanelShape | PolygonShape):")
    assert asks_for_a_kind("not isinstance(named, str | Feature)")
    assert not asks_for_a_kind("isinstance(patch, ConePatch)")


def test_every_room_of_the_cad_side_has_a_name() -> None:
    loose = {path.name for path in (PACKAGE / "brep").glob("*.py")}
    assert loose == {"__init__.py", "read.py", "server.py", "survey.py"}


def test_every_folder_says_what_it_is_for() -> None:
    silent = [
        str(folder.relative_to(ROOT))
        for folder in PACKAGE.rglob("*")
        if folder.is_dir()
        and folder.name != "__pycache__"
        and not (folder / "__init__.py").read_text(encoding="utf-8").startswith('"""')
    ]
    assert silent == []


def test_importing_cadpanel_is_light() -> None:
    answer = subprocess.run(
        [sys.executable, "-c", "import json, sys, cadpanel; print(json.dumps(sorted(sys.modules)))"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    loaded = {name.partition(".")[0] for name in json.loads(answer.stdout)}
    assert "cadpanel" in loaded
    assert not loaded & HEAVY


def test_the_public_names_are_these() -> None:
    names = getattr(cadpanel, "__all__", [])
    assert set(names) == PUBLIC
    assert len(names) == len(PUBLIC)
    assert [name for name in names if not hasattr(cadpanel, name)] == []
    assert set(names) <= set(dir(cadpanel))


def test_a_name_that_is_not_public_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'nonsense'"):
        getattr(cadpanel, "nonsense")  # noqa: B009 - written plainly, the type checker would find it first


def test_no_file_is_too_long_to_read() -> None:
    lengths = {
        str(path.relative_to(ROOT)): len(path.read_text(encoding="utf-8").splitlines())
        for path in PACKAGE.rglob("*.py")
    }
    assert lengths
    assert {name: length for name, length in lengths.items() if length > LONGEST_FILE} == {}


def test_the_top_level_shows_only_what_it_should() -> None:
    listing = subprocess.run(
        # The checkout may belong to someone else than the user who runs the tests.
        ["git", "-c", "safe.directory=*", "ls-files", "-z"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
    )
    if listing.returncode != 0:
        pytest.skip("not a git checkout, so what belongs to the project cannot be told from what lies about")
    names = {name.partition("/")[0] for name in listing.stdout.split("\0") if name}
    assert {name for name in names if not name.startswith(".")} == TOP_LEVEL


# Folders of tests that are not about one package: another program, and commands.
BESIDE = {"attack", "freecad", "browser", "benchmarks", "mutation"}

# Modules without a test file of their name that no test imports: those without logic, with the reason, and those that
# are reached through one door only, with the tests that go through it.
WITHOUT_LOGIC = {
    "cadpanel.brep.kernel.types": "three other names for the kernel's types",
    "cadpanel.brep.files.format": "what a file format is asked for, abstract",
    "cadpanel.brep.building.sheet_faces": "the faces of a sheet by their names",
    "cadpanel.cli.features": "prints the catalogue",
}
THROUGH_A_DOOR = {
    "cadpanel.atomic.axis_starts": "tests/atomic/test_recovery.py",
    "cadpanel.atomic.clouds": "tests/atomic/test_laws.py",
    "cadpanel.atomic.deviations": "tests/atomic/test_laws.py",
    "cadpanel.atomic.flat_starts": "tests/atomic/test_recovery.py",
    "cadpanel.atomic.race": "tests/atomic/test_recovery.py",
    "cadpanel.atomic.result": "tests/atomic/test_errors.py",
    "cadpanel.atomic.surface": "tests/atomic/test_recovery.py",
    "cadpanel.brep.building.chain_sheet": "tests/brep/building/test_sheet.py",
    "cadpanel.brep.building.chain_skin": "tests/brep/building/test_sheet.py",
    "cadpanel.brep.cutting.by_stations": "tests/brep/cutting/test_ways.py",
    "cadpanel.brep.files.brep": "tests/brep/files/test_formats.py",
    "cadpanel.brep.files.rhino_objects": "tests/brep/files/test_rhino_blocks.py",
    "cadpanel.brep.proof.kept_facts": "tests/delivery/document/test_proof.py",
    "cadpanel.brep.proof.shape_facts": "tests/brep/proof/test_certificate.py",
    "cadpanel.cli.diff_table": "tests/cli/test_diff.py",
    "cadpanel.cli.freecad": "tests/freecad/test_install.py",
    "cadpanel.cli.silence": "tests/cli/test_steps.py",
    "cadpanel.cli.drawings": "tests/cli/test_explain.py",
    "cadpanel.cli.study_tables": "tests/cli/test_study.py",
    "cadpanel.cli.summary_table": "tests/cli/test_run.py",
    "cadpanel.cli.survey_tables": "tests/cli/test_cutting.py",
    "cadpanel.delivery.drawing.marks": "tests/delivery/drawing/test_part.py",
    "cadpanel.delivery.meshes.panels": "tests/delivery/meshes/test_glb.py",
    "cadpanel.delivery.meshes.proof": "tests/delivery/meshes/test_glb.py",
    "cadpanel.delivery.document.loft": "tests/cli/test_loft.py",
    "cadpanel.delivery.document.neighbours": "tests/freecad/test_freecad_document.py",
    "cadpanel.delivery.document.panels": "tests/freecad/test_freecad_document.py",
    "cadpanel.delivery.outputs.tables": "tests/delivery/schedule/test_setting_out_rows.py",
    "cadpanel.delivery.pages.dimensions": "tests/delivery/pages/test_document.py",
    "cadpanel.delivery.pages.flat_view": "tests/delivery/pages/test_document.py",
    "cadpanel.delivery.pages.overview": "tests/delivery/pages/test_document.py",
    "cadpanel.delivery.records.blanks": "tests/delivery/records/test_flat_parts.py",
    "cadpanel.delivery.records.difference": "tests/delivery/test_diff.py",
    "cadpanel.delivery.records.study_rows": "tests/cli/test_study.py",
    "cadpanel.features.chain_shapes": "tests/features/test_panel_shapes.py",
    "cadpanel.fitting.methods.restarts": "tests/fitting/methods/test_laws.py",
    "cadpanel.fitting.outline": "tests/terms/limits/test_corner_drift.py",
    "cadpanel.fitting.rules.feature": "tests/fitting/rules/test_places.py",
    "cadpanel.fitting.rules.level": "tests/fitting/rules/test_places.py",
    "cadpanel.fitting.rules.lock": "tests/fitting/rules/test_places.py",
    "cadpanel.fitting.rules.mirror": "tests/fitting/rules/test_places.py",
    "cadpanel.fitting.rules.seam": "tests/fitting/rules/test_places.py",
    "cadpanel.fitting.rules.shop": "tests/fitting/rules/test_radii.py",
    "cadpanel.fitting.settling": "tests/fitting/rules/test_radii.py",
    "cadpanel.fitting.start.chains": "tests/fitting/test_every_feature.py",
    **{
        f"cadpanel.freecad.addon.{name}": "tests/freecad/test_freecad_addon.py"
        for name in ("checks", "colors", "commands", "fit_dialog", "init_gui", "qt")
    },
    "cadpanel.geometry.unroll_chains": "tests/geometry/test_unroll.py",
    "cadpanel.api_job": "tests/cli/test_run.py",
    "cadpanel.api_loft": "tests/cli/test_loft.py",
    "cadpanel.lofting.checks": "tests/lofting/test_loft.py",
    "cadpanel.lofting.pieces": "tests/lofting/test_flat.py",
    "cadpanel.lofting.settling": "tests/lofting/test_loft.py",
    "cadpanel.reference.alignment": "tests/reference/test_oriented_panel.py",
    "cadpanel.reference.inner_edges": "tests/reference/test_outline.py",
    "cadpanel.reference.outline_faults": "tests/reference/test_outline.py",
    "cadpanel.jobs.make": "tests/cli/test_fit.py",
    "cadpanel.terms.limits.chains": "tests/terms/test_limits.py",
    "cadpanel.studies.baselines.cone_strip": "tests/studies/baselines/test_catalogue.py",
    "cadpanel.studies.baselines.fitted": "tests/studies/baselines/test_catalogue.py",
    "cadpanel.studies.baselines.lofted": "tests/studies/baselines/test_catalogue.py",
    "cadpanel.studies.baselines.tangent_planes": "tests/studies/baselines/test_catalogue.py",
}


def modules() -> dict[str, Path]:
    """All modules of the package with their files, without those that are folders."""
    return {
        ".".join(file.relative_to(ROOT).with_suffix("").parts): file
        for file in sorted(PACKAGE.rglob("*.py"))
        if file.name != "__init__.py"
    }


def imported_by(files: Iterable[Path]) -> set[str]:
    """What Python files import, modules and names of modules alike."""
    found: set[str] = set()
    for file in files:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                found |= {name.name for name in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                found |= {node.module, *(f"{node.module}.{name.name}" for name in node.names)}
    return found


def test_every_folder_of_tests_mirrors_one_of_the_package() -> None:
    strange = [
        str(folder.relative_to(TESTS))
        for folder in TESTS.rglob("*")
        if folder.is_dir()
        and folder.name != "__pycache__"
        and folder.relative_to(TESTS).parts[0] not in BESIDE
        and not (PACKAGE / folder.relative_to(TESTS)).is_dir()
    ]
    assert strange == []


def test_the_tests_of_a_room_stand_in_its_folder() -> None:
    """Beside the folders of brep there are only the tests of what stands there, too."""
    loose = {path.stem.split("_")[1] for path in (TESTS / "brep").glob("test_*.py")}
    assert loose <= {"read", "survey", "server"}


def test_every_module_has_a_test_file_of_its_name_or_is_imported_by_a_test() -> None:
    known = imported_by(TESTS.rglob("*.py"))
    untested = [
        name
        for name, file in modules().items()
        if name not in known
        and not (TESTS / file.relative_to(PACKAGE)).with_name(f"test_{file.name}").is_file()
        and name not in WITHOUT_LOGIC
        and name not in THROUGH_A_DOOR
    ]
    assert untested == []


def test_the_modules_that_need_no_test_of_their_own_are_still_such() -> None:
    named = {**WITHOUT_LOGIC, **THROUGH_A_DOOR}
    assert set(named) <= set(modules())
    assert set(named) & imported_by(TESTS.rglob("*.py")) == set()
    assert [door for door in THROUGH_A_DOOR.values() if not (ROOT / door).is_file()] == []


def test_no_test_file_is_imported_by_another() -> None:
    """What tests share stands in modules that are no tests, so that a file of tests can be moved or deleted."""
    found = {name for name in imported_by(TESTS.rglob("*.py")) if name.startswith("tests.")}
    files = {".".join(file.relative_to(ROOT).with_suffix("").parts) for file in TESTS.rglob("test_*.py")}
    assert found & files == set()
