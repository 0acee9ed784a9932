"""What limits and rules on seams are for: a drawing fitted for closed gaps alone, and as one would send it to a shop.

python examples/before_and_after.py [REFERENCE.step|canopy|column] [OUT] [PICTURE.png]

The canopy (60 m, 30 panels) and the column (8 m, 64 panels) are drawn by `shapes.py`; any other strip is read from a
file. Both deliveries are read back, and their seams are drawn, coloured by how far each turns from the drawn one.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from shapes import SHAPES  # type: ignore[import-not-found] # beside this file, where Python looks first

import cadpanel as cp
from cadpanel.delivery.records.report import ReportModel, read_report

which = sys.argv[1] if len(sys.argv) > 1 else "canopy"
out = Path(sys.argv[2] if len(sys.argv) > 2 else f"build/example_{Path(which).stem}")
picture = Path(sys.argv[3]) if len(sys.argv) > 3 else out / "picture.png"
out.mkdir(parents=True, exist_ok=True)

# Gaps of 2 mm and nothing said of seams, as fits were made before seams had limits; and what is asked for instead.
SEAMS_AS_THEY_COME = {"seam_turn": 90.0, "evenness": 0.5, "seam_level": 1000.0, "drift_along": 0.05}
FITS: dict[str, dict[str, Any]] = {
    "gaps of 2 mm alone": {"gap_tolerance": 2.0, **SEAMS_AS_THEY_COME},
    "default limits": {},
}
if which == "column":
    FITS = {f"cones, {name}": {"feature": "cone", **how} for name, how in FITS.items()}
# How far the column's rings are off their planes is shown so many times as large.
LARGER = 100.0
MOST_TURN = 0.5 if which == "column" else 12.0


def drawn() -> cp.Reference:
    """The reference as panels."""
    if which not in ("canopy", "column"):
        return cp.read(which)
    file = out / f"{which}.step"
    SHAPES[which]().exportStep(str(file))
    return cp.read(file, divide=30) if which == "canopy" else cp.read(file, grid=(8, 2))


def outlines(report: ReportModel) -> list[np.ndarray]:
    """Every panel's outline as points, before it was cut back for joints."""
    corners = [np.array(panel.fitted.corners) for panel in report.panels if panel.fitted is not None]
    return [np.concatenate([rows[0], rows[-1][::-1], rows[0][:1]]) for rows in corners]


def seams(report: ReportModel) -> tuple[list[np.ndarray], list[float]]:
    """Every edge on a seam as points, and by how many degrees it turns from the drawn one."""
    panels = {panel.name: panel for panel in report.panels}
    lines, turns = [], []
    for seam in report.seams:
        for name, edge in zip(seam.panels, seam.edges, strict=True):
            fitted = panels[name].fitted
            assert fitted is not None
            rows, place = np.array(fitted.corners), int(edge[-1])
            lines.append(rows[place] if edge.startswith("end") else rows[:, -place])
            turns.append(seam.turn)
    return lines, turns


def developed(points: np.ndarray) -> np.ndarray:
    """Laid out flat: the canopy along its arc, seen from above; the column round its axis; else as seen from above."""
    x, y, z = points.T
    if which == "canopy":
        return np.stack([90_000.0 * np.arctan2(x, 90_000.0 - y), np.hypot(x, 90_000.0 - y)], axis=1)
    if which == "column":
        middle = np.mod(np.arctan2(y.mean(), x.mean()) + 0.1, 2.0 * np.pi) - 0.1
        turned = np.mod(np.arctan2(y, x) - middle + np.pi, 2.0 * np.pi) - np.pi
        level = heights[np.abs(z[:, None] - heights).argmin(axis=1)]
        return np.stack([1000.0 * (middle + turned), level + LARGER * (z - level)], axis=1)
    return np.stack([x, y], axis=1)


reference = drawn()
heights = np.unique(np.round([panel.corners[..., 2] for panel in reference.panels if panel.four_sided], 1))
reports = {}
for name, how, folder in zip(FITS, FITS.values(), ("before", "after"), strict=True):
    result = cp.fit(reference, **how)
    cp.write_step(result, out / f"{folder}.step")
    cp.deliver(result, out / folder, outputs="step", overwrite=True)
    reports[name] = read_report(out / folder / "report.json")
    worst = max(reports[name].seams, key=lambda seam: seam.turn)
    print(f"{name}: the seam {worst.panels[0]} to {worst.panels[1]} turns most, by {worst.turn:.1f} degrees")

figure = Figure(figsize=(12.0, 5.0), layout="constrained")
columns = 2 if which == "column" else 1
for ax, (name, report) in zip(figure.subplots(2 // columns, columns), reports.items(), strict=True):
    ax.add_collection(LineCollection([developed(line) for line in outlines(report)], colors="0.6", linewidths=0.8))
    lines, turns = seams(report)
    drawing = LineCollection([developed(line) for line in lines], cmap="turbo", linewidths=1.8, clim=(0.0, MOST_TURN))
    drawing.set_array(np.array(turns))
    ax.add_collection(drawing)
    ax.autoscale()
    if which == "canopy":
        ax.set_xlim(20_000.0, 50_000.0)
    ax.set_aspect("equal")
    ax.set_axis_off()
    summary = report.summary
    measured = f"step {summary.max_step:.1f} mm, RMS deviation {summary.rms_deviation:.1f} mm"
    if which == "column":
        measured += f",\nrings off their planes by {summary.max_off_level:.1f} mm, drawn {LARGER:g} times"
    ax.set_title(f"{name}\nseams turn by up to {max(turns):.1f} degrees, {measured}", fontsize=9)
    figure.colorbar(drawing, ax=ax, label="degrees", shrink=0.8)
figure.savefig(picture, dpi=70)
print(f"Written: {picture}")
