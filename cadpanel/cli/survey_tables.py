"""What `cadpanel inspect` found, as tables."""

from __future__ import annotations

import math

from rich.table import Table
from rich.text import Text

from cadpanel.brep.skin.conjugate import SeamLean
from cadpanel.brep.survey import FaceSurvey, Survey
from cadpanel.cli.tables import console, counted

NOTHING = "-"
# A lean that is worth a sentence, degrees.
WORTH_TELLING = 2.0
LEANING = (
    "Seams lean: by how much a seam would have to lean from square for two flat flanges to meet in it without a step; "
    "in the mean, and where it is most, mm along the strip. Where square seams are cut, closing them takes panels off "
    "the drawing; 'fit --divide N --seams conjugate' cuts seams that lean, up to --cut-turn."
)


def print_survey(found: Survey) -> None:
    """The file, its faces, surfaces, curves and notes."""
    out = console()
    out.print(
        Text(
            f"{found.source}: {found.format}, unit {found.unit}, {counted(len(found.faces), 'face')}, "
            f"{counted(len(found.surfaces), 'surface')}, {counted(len(found.curves), 'loose curve')}; all lengths in mm"
        ),
        soft_wrap=True,
    )
    if found.faces:
        out.print(_faces(found))
        out.print(_surfaces(found))
        if any(surface.seams is not None and surface.seams.largest >= WORTH_TELLING for surface in found.surfaces):
            out.print(Text(LEANING), soft_wrap=True)
    if found.curves:
        out.print(_curves(found))
    for note in found.notes:
        out.print(Text(f"Note: {note}"), soft_wrap=True)


def _faces(found: Survey) -> Table:
    table = Table(title="Faces", title_justify="left", title_style="bold")
    said = [word for word in ("name", "layer", "color") if any(getattr(face.label, word) for face in found.faces)]
    # As a product it may be called otherwise than its face; of several with one name, each has a number.
    panels = any(face.panel not in ("", face.label.name) for face in found.faces)
    for heading in ("face", *said, *(["panel"] if panels else []), "stored as"):
        table.add_column(heading, overflow="fold")
    for heading in ("area, m2", "u x v", "curved", "off a plane", "Gauss, sr", "radius"):
        table.add_column(heading, justify="right")
    for face in found.faces:
        measured = face.curvature
        table.add_row(
            str(face.number),
            *(Text(getattr(face.label, word) or NOTHING) for word in said),
            *([Text(face.panel or NOTHING)] if panels else []),
            _kind(face),
            f"{face.area / 1e6:.4g}",
            f"{face.size[0]:.0f} x {face.size[1]:.0f}",
            measured.kind,
            f"{measured.off_plane:.3f}",
            f"{measured.total_gaussian:.1e}",
            NOTHING if math.isinf(measured.smallest_radius) else f"{measured.smallest_radius:.4g}",
        )
    return table


def _kind(face: FaceSurvey) -> str:
    poles = f" {face.poles[0]}x{face.poles[1]}" if face.poles[0] else ""
    return f"{face.kind}{poles}{', trimmed' if face.trimmed else ''}{', of a solid' if face.of_solid else ''}"


def _surfaces(found: Survey) -> Table:
    table = Table(title="Surfaces: faces that hang together", title_justify="left", title_style="bold")
    for heading in ("surface", "faces", "area, m2", "length x width", "lips: turn, width, radius", "seams lean"):
        table.add_column(heading, overflow="fold")
    for surface in found.surfaces:
        lips = [f"{lip.turn:.1f} degrees over {lip.width:.1f}, radius {lip.radius:.1f}" for lip in surface.lips or ()]
        table.add_row(
            Text(surface.name),
            ", ".join(map(str, surface.faces)),
            f"{surface.area / 1e6:.4g}",
            NOTHING if surface.strip is None else f"{surface.strip[0]:.1f} x {surface.strip[1]:.1f}",
            "not measured" if surface.lips is None else "\n".join(lips) or "none",
            NOTHING if surface.seams is None else _lean(surface.seams),
        )
    return table


def _lean(seams: SeamLean) -> str:
    if seams.largest < WORTH_TELLING:
        return "square is right"
    return f"{seams.mean:.0f} degrees, {seams.largest:.0f} at {seams.at:.0f}"


def _curves(found: Survey) -> Table:
    table = Table(title="Loose curves", title_justify="left", title_style="bold")
    for heading in ("curve", "name", "layer", "color", "length"):
        table.add_column(heading, overflow="fold")
    for curve in found.curves:
        words = (curve.label.name, curve.label.layer, curve.label.color)
        table.add_row(str(curve.number), *(Text(word or NOTHING) for word in words), f"{curve.length:.1f}")
    return table
