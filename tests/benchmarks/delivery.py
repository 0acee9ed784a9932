"""How long a delivery takes, against OCCT's own STEP writer on the same solids.

    python -m tests.benchmarks.delivery --panels 1000

A strip of that many panels is written as STEP like the fixtures and fitted panel by panel; neither is timed.
Timed are reading that file, building the sheets, writing both files of the delivery and proving them, and, in the same
process, OCCT's XCAF writer with names and its own settings (AP242, parameter curves on) on the same solids; and then
what a shop gets besides STEP, which does not count among what is together.
The processor's seconds stand beside those of the clock: on a machine that others use, only they can be compared. They
count the second interpreters in full, their start included; the clock does not see what they do beside the first one.
They are told of on Linux only.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from shutil import rmtree
from typing import NamedTuple, TypeVar

from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.isolation.client import start_reader, stop_reader
from cadpanel.brep.kernel.messages import silence_kernel
from cadpanel.brep.proof.certificate import Certificate, certify
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam, PatchKind
from cadpanel.brep.proof.parallel import Helper, second_interpreter
from cadpanel.brep.read import read_reference
from cadpanel.delivery.built_already import built_already
from cadpanel.delivery.outputs.catalogue import OUTPUTS
from cadpanel.delivery.outputs.output import Delivery
from cadpanel.delivery.outputs.step_files import PANELS, SKINS, write_skins, write_solids
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.records.from_fit import with_flat_parts
from cadpanel.delivery.records.from_shape import patch_models, rows
from cadpanel.delivery.records.report import PanelModel, SeamModel
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import FOUR_EDGES, PanelSheet, build_panels
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.methods.local import fit_local
from cadpanel.fitting.problem import pose
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.shapes import panel_shapes
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.patches import ConePatch
from cadpanel.reference.model import Reference
from fixtures.lips import Lip
from fixtures.make_fixtures import Fixture, write
from tests.kernel_step import write_by_kernel

Result = TypeVar("Result")

# A strip may turn by so much over its whole length without meeting itself, degrees.
WHOLE_TURN = 270.0
UNMEASURED = (
    *("rms_deviation", "max_deviation", "hausdorff"),
    *("max_corner_drift", "max_drift_along", "max_free_edge_drift"),
)


def strip(panels: int) -> Lip:
    """A lip of that many panels whose fold, radius and twist vary along it."""
    return Lip(
        panels=panels,
        twist=(0.7, 1.1, -0.9, 0.8),
        plan=(WHOLE_TURN / max(panels, 45),),
        rise=(0.2 * WHOLE_TURN / max(panels, 45),),
        fold=(102.0, 94.0, 98.0),
        radius=(480.0, 300.0, 420.0, 260.0),
        lower=(520.0, 430.0),
        upper=(640.0, 540.0),
    )


def local_shapes(reference: Reference) -> tuple[Panel, ...]:
    """Every panel fitted alone: enough to have something to build."""
    posed, begin = pose(reference, [FitSettings().feature_for(4)] * len(reference.panels))
    return panel_shapes(posed, fit_local(posed, reference, begin, FitSettings()).unknowns)


def prove(folder: Path, reference: Reference, built: Sequence[PanelSheet], helper: Helper | None) -> Certificate:
    """The certificate of both files, every seam measured."""
    expected = [
        ExpectedPanel(
            name=one.shape.name,
            volume=one.volume,
            kinds=_kinds(one.shape),
            corners=one.shape.corners(),
            sheet=Sheet(shape=one.shape, thickness=SheetSettings().thickness, skin_side=SheetSettings().skin_side),
        )
        for one in built
    ]
    names = [panel.name for panel in reference.panels]
    seams = [
        ExpectedSeam(
            panels=(names[seam.panels[0]], names[seam.panels[1]]),
            edges=(FOUR_EDGES[seam.edges[0]], FOUR_EDGES[seam.edges[1]]),
        )
        for seam in reference.seams
    ]
    known = built_already(built, [one.shape for one in built])  # as a delivery does
    return certify(folder / PANELS, folder / SKINS, expected, seams, helper, 0.0, known)


def _kinds(shape: Panel) -> tuple[PatchKind, ...]:
    cones: dict[bool, PatchKind] = {True: "cone", False: "cylinder"}
    return tuple(cones[patch.half_angle != 0.0] if isinstance(patch, ConePatch) else "plane" for patch in shape.patches)


class Took(NamedTuple):
    """Seconds of the clock and of the processor, those of child processes included."""

    clock: float
    processor: float


def now() -> Took:
    """The clock and what the processor has done so far, for processes that still run, too."""
    return Took(time.perf_counter(), sum(os.times()[:4]) + sum(map(seconds_of, children())))


def children(process: int | str = "self") -> list[int]:
    """The processes that one has started and that run, this one if none is named, and all that those have started."""
    own = [int(child) for task in _tasks(process) for child in _started_by(task)]
    return [*own, *(further for child in own for further in children(child))]


def _tasks(process: int | str) -> list[Path]:
    try:
        return list(Path(f"/proc/{process}/task").iterdir())
    except OSError:  # it has ended meanwhile
        return []


def _started_by(task: Path) -> list[str]:
    try:
        return (task / "children").read_text().split()
    except OSError:  # a thread that has ended meanwhile
        return []


def timed(seconds: dict[str, Took], step: str, work: Callable[[], Result]) -> Result:
    """Do the work and note how long it took."""
    began = now()
    result = work()
    ended = now()
    seconds[step] = Took(ended.clock - began.clock, ended.processor - began.processor)
    return result


def seconds_of(process: int) -> float:
    """The processor's seconds of a process that runs, and of those that it has seen end, as Linux tells of them."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


def run(panels: int, folder: Path, outputs: Sequence[str] = ()) -> dict[str, Took]:
    """Seconds of every step, the bare writer's last."""
    silence_kernel()
    start_reader()  # as a command does, before it loads the kernel itself
    file = folder / f"strip_{panels}.step"
    if not file.exists():
        write(Fixture(file=file.name, prefix="P", table=(), lip=strip(panels)), file)
    seconds: dict[str, Took] = {}
    reference = timed(seconds, "read", lambda: read_reference(file))
    shapes = local_shapes(reference)
    with second_interpreter(panels) as helper:  # as a delivery does
        built = timed(seconds, "build", lambda: build_panels(shapes, SheetSettings(), reference.seams).panels)

        def write_both() -> None:
            write_skins(folder / SKINS, built, "strip")
            if helper is not None:
                helper.begin(folder / SKINS)
            write_solids(folder / PANELS, built, "strip")
            if helper is not None:
                helper.open(folder / PANELS)

        timed(seconds, "write", write_both)
        certificate = timed(seconds, "verify", lambda: prove(folder, reference, built, helper))
        stop_reader()
    if not certificate.holds:
        raise SystemExit(f"the proof fails: {certificate.failures[0]}")
    bare = [(one.shape.name, one.solid) for one in built]
    timed(seconds, "XCAF writer", lambda: write_by_kernel(folder / "bare.step", bare))
    for_the_shop(seconds, folder, reference, built, outputs)
    return seconds


def for_the_shop(
    seconds: dict[str, Took], folder: Path, reference: Reference, built: Sequence[PanelSheet], outputs: Sequence[str]
) -> None:
    """What a shop gets besides STEP: flat parts, other outputs, all if none is named, and the proof of them."""
    sheet, shop = SheetSettings(), ShopSettings()
    parts = timed(seconds, "flat parts", lambda: flat_parts([one.shape for one in built], sheet, shop))
    records = with_flat_parts([record(one) for one in built], built, parts, shop.density)
    delivery = Delivery(
        panels=tuple(built),
        title="strip",
        sheet=sheet,
        shop=shop,
        records=records,
        seams=seams_of(reference),
        parts=parts,
    )
    wanted = {*outputs} or {output.name for output in OUTPUTS} - {"html"}  # a page shows a fit
    timed_ones = [output for output in OUTPUTS if not output.always and output.name in wanted]
    for output in timed_ones:
        for name in output.folders:
            rmtree(folder / name, ignore_errors=True)
        timed(seconds, f"write {output.name}", lambda output=output: output.write(folder, delivery))  # type: ignore[misc]
    for output in timed_ones:
        proof = timed(seconds, f"prove {output.name}", lambda output=output: output.prove(folder, delivery))  # type: ignore[misc]
        if proof.failures:
            raise SystemExit(f"the proof fails: {proof.failures[0]}")


def record(built: PanelSheet) -> PanelModel:
    """A record of a panel whose fit nobody has measured."""
    told = {
        "name": built.shape.name,
        "feature": built.shape.feature,
        "corners": rows(built.shape.corners()),
        "patches": patch_models(built.shape),
        "area": built.area,
        "volume": built.volume,
        "surface": built.check.area,
        "centroid": built.check.centroid,
        "skin_centroid": built.skin_check.centroid,
    }
    return PanelModel.model_validate({**told, **dict.fromkeys(UNMEASURED, 0.0)})


def seams_of(reference: Reference) -> tuple[SeamModel, ...]:
    """Which panels meet; how well, nobody has measured."""
    names = [panel.name for panel in reference.panels]
    return tuple(
        SeamModel(
            panels=(names[seam.panels[0]], names[seam.panels[1]]),
            edges=(FOUR_EDGES[seam.edges[0]], FOUR_EDGES[seam.edges[1]]),
            reversed=seam.reversed,
            corner_gaps=(0.0,),
            max_corner_gap=0.0,
            max_seam_gap=0.0,
            max_kink=0.0,
        )
        for seam in reference.seams
    )


def main() -> None:
    """See the module's text."""
    parser = argparse.ArgumentParser(description="Time a delivery against OCCT's own STEP writer.")
    parser.add_argument("--panels", type=int, default=1000)
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--outputs", nargs="*", default=(), help="time these besides STEP; all if none is named")
    parser.add_argument("--folder", type=Path, help="keep the files there, and use the strip that is there")
    chosen = parser.parse_args()
    for _ in range(chosen.runs):
        with tempfile.TemporaryDirectory() as temporary:
            seconds = run(chosen.panels, chosen.folder or Path(temporary), chosen.outputs)
        print_table(chosen.panels, seconds)


def print_table(panels: int, seconds: dict[str, Took]) -> None:
    """Seconds of every step, and how many times those of the bare writer they are."""
    bare = seconds["XCAF writer"]
    steps = list(seconds)
    whole = [seconds[step] for step in steps[: steps.index("XCAF writer")]]
    together = Took(sum(took.clock for took in whole), sum(took.processor for took in whole))
    print(f"{panels:>6} panels   clock s   times    processor s   times")
    for step, took in (*seconds.items(), ("together", together)):
        clock, processor = took.clock / bare.clock, took.processor / bare.processor
        print(f"{step:<14} {took.clock:8.2f} {clock:7.2f} {took.processor:14.2f} {processor:7.2f}")


if __name__ == "__main__":
    main()
