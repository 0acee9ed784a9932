"""A study as a picture: deviation over gaps, one line for each feature and number of panels, its knee marked."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from cadpanel.delivery.records.study import StudyModel, StudyRowModel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MISSING = (
    "There is no plot, as matplotlib is not installed: pip install 'cadpanel[plot]', and run it again with --overwrite."
)
# Size in inches and resolution; the same figure gives the same bytes.
_SIZE, _DOTS = (11.0, 5.0), 130
_SALT = "cadpanel"


def can_plot() -> bool:
    """Whether the library that draws is installed."""
    return find_spec("matplotlib") is not None


def plot_study(study: StudyModel, paths: Sequence[Path]) -> None:
    """Draw a study into files, each in the format that its name ends in; see `draw_study`."""
    import matplotlib as mpl

    figure = draw_study(study)
    with mpl.rc_context({"svg.hashsalt": _SALT}):
        for path in paths:
            extra = {"Date": None} if path.suffix == ".svg" else {"Software": None}
            figure.savefig(path, dpi=_DOTS, metadata=extra)


def draw_study(study: StudyModel) -> Figure:
    """A study as a figure.

    Points that hold what was asked are full, others hollow; the knee of each line is a star.
    """
    from cadpanel.delivery.pictures.figure import Picture

    figure = Picture(figsize=_SIZE, layout="constrained")
    axes = figure.subplots(1, 2)
    for ax, what, heading in zip(
        axes, ("rms_deviation", "max_deviation"), ("RMS deviation, mm", "largest deviation, mm"), strict=True
    ):
        _draw(ax, study.rows, what)
        ax.set_xscale("log")
        ax.set_xlabel("largest gap allowed, mm")
        ax.set_ylabel(heading)
        ax.set_ylim(bottom=0.0)
        ax.grid(visible=True, which="both", alpha=0.3)
        gaps = sorted({row.gap_tolerance for row in study.rows})
        ax.set_xticks(gaps, labels=[f"{gap:g}" for gap in gaps], minor=False)
        ax.minorticks_off()
    figure.suptitle(f"{study.reference.file}: what a gap costs (full: held; hollow: not held; star: knee)")
    axes[0].legend(fontsize="small")
    return figure


def _draw(ax: Axes, rows: Sequence[StudyRowModel], what: str) -> None:
    for (divide, feature), group in groupby(rows, key=lambda row: (row.divide, row.feature)):
        found = [(row, row.summary) for row in group if row.summary is not None]
        points = [(row.gap_tolerance, float(getattr(measured, what))) for row, measured in found]
        if not points:
            continue
        name = feature if divide is None else f"{feature}, {divide} panels"
        (line,) = ax.plot(*zip(*points, strict=True), label=name)
        for (row, measured), (gap, value) in zip(found, points, strict=True):
            face = line.get_color() if measured.tolerance_met else "white"
            marker, size = ("*", 15.0) if row.knee else ("o", 6.0)
            ax.plot([gap], [value], marker=marker, markersize=size, color=line.get_color(), markerfacecolor=face)
