"""The command `cadpanel view`."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Annotated

import typer

from cadpanel.cli.steps import steps
from cadpanel.delivery.outputs.report_html import PAGE
from cadpanel.delivery.pictures.colours import Colour, require_matplotlib
from cadpanel.delivery.pictures.views import View
from cadpanel.errors import DeliveryError, SettingsError


def view(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A folder that 'cadpanel fit' wrote.")],
    png: Annotated[
        Path | None, typer.Option("--png", metavar="FILE", help="Draw the panels into this file; needs no screen.")
    ] = None,
    color: Annotated[
        Colour | None,
        typer.Option("--color", help="With --png: what panels and seams are coloured by; deviation if none."),
    ] = None,
    view: Annotated[
        View | None,
        typer.Option("--from", help="With --png: from where they are seen; north is along y, up along z."),
    ] = None,
) -> None:
    """Open the page of a delivery in a browser, or draw its panels into a file.

    Exit codes: 0 it is opened or drawn; 2 there is no page, or no browser.
    """
    page = folder if folder.name == PAGE and folder.is_file() else folder / PAGE
    if not page.is_file():
        raise DeliveryError(
            f"'{folder}' holds no {PAGE}: name a folder that 'cadpanel fit' wrote, with html among its --outputs."
        )
    if png is not None:
        if png.suffix.casefold() != ".png":
            raise SettingsError(f"'{png}' is no name for a picture that --png draws: let it end in .png")
        require_matplotlib()
        from cadpanel.delivery.pictures.files import write_picture

        with steps(quiet=False) as shown:
            shown.begin("Draw", png.name)
            write_picture(page, png, color or "deviation", view or "outside")
        return
    if color is not None or view is not None:
        raise SettingsError("--color and --from go with --png FILE: in the page, buttons choose both")
    if not webbrowser.open(page.resolve().as_uri()):
        raise DeliveryError(f"no browser could be started: open '{page}' in one, or draw it with --png FILE.")
