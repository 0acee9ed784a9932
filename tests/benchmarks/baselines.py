"""All ways to approximate the same panels, side by side.

    python -m tests.benchmarks.baselines
    python -m tests.benchmarks.baselines FILE --divide 8 --lip 300
    python -m tests.benchmarks.baselines --without annealing

Prints a table in Markdown, one row a file and method: deviation over the area and at most, the widest gap along a seam,
the farthest corner from the drawn one, the largest turn of an end, the largest warp, and seconds of the processor.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

import cadpanel as cp
from cadpanel.errors import CadpanelError
from cadpanel.studies.baselines.catalogue import BASELINES

app = typer.Typer(add_completion=False)
FIXTURES = [Path("fixtures") / f"kai_tak_{name}.step" for name in ("nw", "se_south", "se_east")]
COLUMNS = "panels, RMS mm, largest mm, corner gap mm, seam gap mm, corner drift mm, turn degrees, warp degrees, s"
HEAD = f"| reference | method | {COLUMNS.replace(', ', ' | ')} |"


@app.command()
def table(
    files: Annotated[list[Path] | None, typer.Argument(help="The fixtures, if none.")] = None,
    divide: Annotated[int | None, typer.Option(help="Cut each strip into so many panels.")] = None,
    lip: Annotated[float | None, typer.Option(help="Keep only a band of this width about the lip, mm.")] = None,
    faces: Annotated[str | None, typer.Option(help="Which faces are the skin.")] = None,
    unit: Annotated[str | None, typer.Option(help="Of a file that has none.")] = None,
    without: Annotated[list[str] | None, typer.Option(help="Methods to leave out.")] = None,
) -> None:
    """Print the table."""
    print(HEAD)
    print("|---|---" + "|---" * (HEAD.count("|") - 3) + "|")
    for file in files or FIXTURES:
        reference = cp.read(file, divide=divide, lip=lip, faces=faces, unit=unit)
        for name in BASELINES:
            if name not in (without or []):
                print(f"| {file.stem} {_row(name, reference)}", flush=True)


def _row(name: str, reference: cp.Reference) -> str:
    began = time.process_time()
    try:
        out = BASELINES[name].run(reference)
    except CadpanelError as error:
        return f"| {name} | not possible: {error} |"
    seconds = time.process_time() - began
    return (
        f"| {name} | {out.panels} | {out.rms:.2f} | {out.largest:.1f} | {out.corner_gap:.2f} | {out.seam_gap:.2f} "
        f"| {out.drift:.1f} | {out.turn:.2f} | {out.warp:.2f} | {seconds:.2f} |"
    )


if __name__ == "__main__":
    app()
