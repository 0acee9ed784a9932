"""report.html: the delivery to look at, one file that a browser opens without a network."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

PAGE = "report.html"
# A profile is sampled, and written in whole steps: by this it may exceed what was found along the whole seam, mm.
_ROUNDING = 0.01


class ReportHtml(Output):
    """Panels and seams in three dimensions, with their numbers and flat patterns."""

    name = "html"
    files = (PAGE,)

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.page.html import page_bytes
        from cadpanel.delivery.page.numbers import page_numbers
        from cadpanel.delivery.page.packing import packed
        from cadpanel.delivery.page.scene import scene_of
        from cadpanel.geometry.drilled_mesh import hole_rims
        from cadpanel.geometry.sheet_checks import sheet_depth

        assert delivery.result is not None
        panels = delivery.panels
        depth = sheet_depth(delivery.sheet.thickness, delivery.sheet.skin_side)
        rims = [hole_rims(panel.fixings.holes if panel.fixings is not None else (), depth) for panel in panels]
        scene = scene_of(delivery.result, [panel.shape for panel in panels], [panel.other for panel in panels], rims)
        shapes = {**packed(scene), "flats": _flats(delivery)}
        page = page_bytes(delivery.title, page_numbers(delivery), shapes)
        try:
            (folder / PAGE).write_bytes(page)
        except OSError as error:
            raise DeliveryError(f"'{folder / PAGE}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """Its numbers must be the report's; what it shows of seams may not exceed them, and every panel is there."""
        from cadpanel.delivery.page.flats import like_flats
        from cadpanel.delivery.page.html import is_written_so, read_page
        from cadpanel.delivery.page.numbers import page_numbers

        numbers, shapes = read_page(folder / PAGE)
        failures = []
        if numbers != page_numbers(contents):
            failures.append(f"'{PAGE}' does not tell the report's numbers.")
        if not like_flats(shapes.get("flats"), _flats(contents)):
            failures.append(f"'{PAGE}' does not show the flat patterns of the report.")
        failures += _unlike(shapes, contents)
        if not is_written_so(folder / PAGE, contents.title, numbers, shapes):
            failures.append(f"'{PAGE}' is not the page that this version writes: write the delivery again.")
        return Proof(numbers={"panels": len(contents.records)}, failures=tuple(failures))


def _flats(contents: Contents) -> list[dict[str, Any]]:
    from cadpanel.delivery.page.flats import packed_flats

    parts = contents.parts
    return packed_flats([part.pattern for part in parts], [part.circles for part in parts])


def _unlike(shapes: dict[str, Any], contents: Contents) -> list[str]:
    """What the pictures show that the report does not tell."""
    from cadpanel.delivery.page.packing import unpacked
    from cadpanel.delivery.page.picture_checks import off_their_panels
    from cadpanel.geometry.drilled_mesh import hole_count
    from cadpanel.geometry.sheet_checks import sheet_depth

    try:
        scene = unpacked(shapes)
    except (ValueError, KeyError, TypeError, IndexError) as error:
        return [f"'{PAGE}' holds no panels that could be shown: {error}."]
    if [panel.name for panel in scene.panels] != [record.name for record in contents.records]:
        return [f"'{PAGE}' does not show the panels that are delivered."]
    wrong = [
        f"'{PAGE}' does not show the {len(part.circles)} holes of panel '{panel.name}': write the delivery again."
        for panel, part in zip(scene.panels, contents.parts, strict=True)
        if hole_count(panel.triangles) != len(part.circles)
    ]
    shown = zip(scene.panels, contents.shapes, strict=True)
    depth = sheet_depth(contents.sheet.thickness, contents.sheet.skin_side)
    wrong += [f"'{PAGE}' shows panel '{name}' where it is not." for name in off_their_panels(shown, depth)]
    told = {seam.panels + seam.edges: seam for seam in contents.seams}
    most: dict[tuple[str, str], float] = {}
    for seam in told.values():
        most[seam.panels] = max(most.get(seam.panels, 0.0), seam.max_seam_gap)
    return wrong + [
        f"'{PAGE}' shows a gap of {seam.profile.gap.max():.2f} mm between '{seam.panels[0]}' and '{seam.panels[1]}', "
        "more than the report tells."
        for seam in scene.seams
        if seam.profile.gap.max() > most.get(seam.panels, 0.0) + _ROUNDING
    ]
