"""The shapes of a document, as the files that its archive keeps: solids, skins, flat patterns and seams."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.building.drawn import edges_along, flat_face
from cadpanel.brep.building.shown import shown_binary
from cadpanel.brep.kernel.kept import kept_binary
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.document.tree import drawn_seams, flat_file, panel_file, seam_file, skin_file
from cadpanel.delivery.drawing.entities import Contour, Drawing
from cadpanel.delivery.drawing.layout import in_rows
from cadpanel.delivery.drawing.part import bend_lines, contours
from cadpanel.delivery.sheets import PanelSheet


def shape_files(contents: Contents, panels: Sequence[PanelSheet]) -> Iterator[tuple[str, bytes]]:
    """Name and bytes of every file, in the order in which objects of the document name them.

    Solids, which are shown when it opens, come with their triangles; FreeCAD makes those of others when it shows them.

    Args:
        contents: what the document tells of.
        panels: the sheets of the panels in it, as they were built.
    """
    for place, panel in enumerate(panels):
        yield panel_file(place), shown_binary(panel.solid)
    places = {panel.shape.name: place for place, panel in enumerate(panels)}
    for number, seam in enumerate(drawn_seams(contents)):
        own = [(places[name], edge) for name, edge in zip(seam.panels, seam.edges, strict=True) if name in places]
        rows = [(panels[place].skin, panels[place].shape.edge(edge).corners) for place, edge in own]
        yield seam_file(number), kept_binary(edges_along(rows))
    for place, panel in enumerate(panels):
        yield skin_file(place), kept_binary(panel.skin)
    for place, flat in enumerate(laid_out(contents)):
        yield flat_file(place), kept_binary(flat_face(*flat))


def laid_out(contents: Contents) -> list[tuple[Array, Array, Array]]:
    """Of each flat pattern the contour (v, 3), bend lines (m, 2, 2) and holes (h, 3), in rows from the top."""
    chains = contours(contents.parts, contents.shop.chord)
    drawings: list[Drawing] = [(Contour("", chain),) for chain in chains]
    return [
        (chain + np.append(shift, 0.0), bend_lines(part) + shift, part.circles + np.append(shift, 0.0))
        for chain, part, shift in zip(chains, contents.parts, in_rows(drawings), strict=True)
    ]
