"""A delivery's page as a picture in a file."""

from __future__ import annotations

from pathlib import Path

from cadpanel.delivery.page.html import read_page
from cadpanel.delivery.page.packing import unpacked
from cadpanel.delivery.page.scene import Scene
from cadpanel.delivery.pictures.colours import Colour, require_matplotlib
from cadpanel.delivery.pictures.model import draw_model
from cadpanel.delivery.pictures.views import View
from cadpanel.errors import DeliveryError


def scene_of_page(page: Path) -> Scene:
    """What the page of a delivery shows.

    Raises:
        DeliveryError: it cannot be read, or is no page of ours.
    """
    _, shapes = read_page(page)
    try:
        return unpacked(shapes)
    except (ValueError, KeyError, TypeError, IndexError) as error:
        raise DeliveryError(f"'{page}' shows no panels: {error}; write the delivery again.") from error


def write_picture(page: Path, path: Path, color: Colour, view: View) -> None:
    """Draw the page of a delivery into a PNG file.

    Raises:
        SettingsError: matplotlib is missing, or there is no such colour or view.
        DeliveryError: the page cannot be read, or the file cannot be written.
    """
    require_matplotlib()
    from cadpanel.delivery.pictures.figure import png_bytes

    data = png_bytes(draw_model(scene_of_page(page), color, view))
    try:
        path.write_bytes(data)
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be written: {error.strerror or error}.") from error
