"""Jobs of a few panels that the tests share."""

from __future__ import annotations

from pathlib import Path

from cadpanel.jobs.engine.engine import Engine
from cadpanel.jobs.engine.serial import Serial
from cadpanel.jobs.read import read_job
from cadpanel.jobs.results import Results
from cadpanel.jobs.run import Part, Place, make_regions
from cadpanel.jobs.summary import SummaryModel
from cadpanel.jobs.task import parts_of
from fixtures.lips import Lip
from fixtures.make_fixtures import Fixture, write

DATE = "1700000000"
SMALL = Lip(panels=2, fold=(100.0, 96.0), radius=(480.0, 430.0), lower=(500.0, 450.0), upper=(600.0, 550.0))


def reference(folder: Path) -> Path:
    """A strip of two panels in a file."""
    path = folder / "lip.step"
    write(Fixture(file=path.name, prefix="N", table=(), lip=SMALL), path)
    return path


def job(folder: Path, regions: str, defaults: str = "") -> Path:
    """A job file beside the strip: regions as TOML, one a line, NAME = {...}."""
    path = folder / "job.toml"
    usual = 'reference = "lip.step"\nmethod = "local"\noutputs = ["step"]'
    path.write_text(f"[defaults]\n{usual}\n{defaults}\n\n[regions]\n{regions}\n", encoding="utf-8")
    return path


def parts(path: Path) -> list[Part]:
    """The regions of a job with their tasks, dated."""
    return parts_of(read_job(path).regions, DATE)


def made(path: Path, out: Path, results: Results | None = None, engine: Engine | None = None) -> SummaryModel:
    """Run a job."""
    return make_regions(parts(path), Place(out=out), lambda: engine or Serial(), results, lambda *_: None)


def files(folder: Path) -> dict[str, bytes]:
    """The files of a delivery that hold no times of a clock."""
    timed = {"report.json", "manifest.json"}
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name not in timed
    }
