"""The command `cadpanel loft`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table
from rich.text import Text

from cadpanel.brep.files.text_check import require_files
from cadpanel.brep.isolation.client import start_reader
from cadpanel.cli import options
from cadpanel.cli.groups import OUTPUT, SHAPE
from cadpanel.cli.steps import steps
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.lofting.distance import Distance
from cadpanel.reference.settings import ReferenceSettings

if TYPE_CHECKING:
    from cadpanel.delivery.records.loft import LoftModel


@options.made_of_settings
def loft(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="STEP, IGES, .brep or .3dm file with curves.")],
    how: Annotated[ReferenceSettings, options.Only(("unit",))],
    shop: Annotated[
        ShopSettings, options.Only(("chord", "roll_pitch", "dxf_entities", "dxf_layers", "dxf_contour_only"))
    ],
    out: options.Out,
    rails: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[CURVE_A CURVE_B]", help="Both rails by number, name or layer=NAME; needless where there are two."
        ),
    ] = None,
    distance: Annotated[
        Distance,
        typer.Option(
            help="What the pairing of points makes small: the angle between tangent planes, or their distance.",
            rich_help_panel=SHAPE,
        ),
    ] = "warp",
    max_warp: Annotated[
        float,
        typer.Option(
            "--max-warp", metavar="DEG", min=0.0, max=180.0, help="Warp that is allowed.", rich_help_panel=SHAPE
        ),
    ] = 1.0,
    name: Annotated[
        str | None, typer.Option("--name", help="Of the product; the file's own if not given.", rich_help_panel=OUTPUT)
    ] = None,
    overwrite: options.Overwrite = False,
    quiet: options.Quiet = False,
) -> None:
    """Span a developable surface between two curves, and unroll it.

    Exit codes: 0 it is written; 1 it is written, but warped by more than --max-warp; 2 refused.
    """
    require_files(file, how)
    with delivery_folder(out, overwrite=overwrite) as folder, steps(quiet=quiet) as shown:
        start_reader()
        shown.begin("Read curves", file.name)
        # Here, not above: neither help nor a refusal should wait for the CAD kernel.
        from cadpanel.brep.curves.rails import chosen_rails, read_curves
        from cadpanel.delivery.loft_files import write_loft_files
        from cadpanel.lofting.loft import loft as span

        found = read_curves(file, how)
        shown.begin("Pair rails")
        surface = span(*chosen_rails(found, rails or []), distance=distance, name=name or file.stem)
        shown.begin("Write and read back")
        record = write_loft_files(
            surface,
            folder,
            allowed_warp=max_warp,
            shop=shop,
            file=found.source,
            notes=found.notes,
            origin=found.origin,
        )
    if not quiet:
        print_loft(record, out)
    if not record.tolerance_met:
        raise typer.Exit(1)


def _short(value: float) -> str:
    """Two digits, and all of those before the point."""
    return f"{value:.0f}" if value >= 100.0 else f"{value:.2g}"


def print_loft(record: LoftModel, out: Path) -> None:
    """A table of its pieces, its warp, and its flat pattern."""
    from cadpanel.cli.tables import console

    screen = console()
    a, b = record.rails
    table = Table(title=f"{record.name}: {a.name} to {b.name}", title_justify="left", title_style="bold")
    for heading in ("piece", "of rail A, %", "of rail B, %", "largest warp, degrees"):
        table.add_column(heading, justify="left" if heading == "piece" else "right")
    for piece in record.pieces:
        (a0, b0), (a1, b1) = piece.shares
        table.add_row(
            Text(piece.kind if piece.fan_from is None else f"{piece.kind} fan from {piece.fan_from}"),
            f"{100.0 * a0:.2f} - {100.0 * a1:.2f}",
            f"{100.0 * b0:.2f} - {100.0 * b1:.2f}",
            _short(piece.max_warp),
        )
    screen.print(table)
    kept = "within" if record.tolerance_met else "more than"
    lines = [
        f"Warp {_short(record.max_warp)} degrees at most, {kept} the {record.allowed_warp:g} allowed; rails left by "
        f"{_short(record.off)} mm at most.",
        f"Flat pattern: {record.flat.area:.0f} mm2, lengths off by {_short(record.flat.length_error)} mm at most.",
        *record.notes,
        f"Written: {out}",
    ]
    for line in lines:
        screen.print(Text(line), soft_wrap=True)
