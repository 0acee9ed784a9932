"""Tables on paper tell what the records do."""

from cadpanel.delivery.pages.tables import BENDS, EDGES, bend_rows, edge_rows
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from tests.shapes import folded_panel


def test_rows_have_a_cell_under_every_heading():
    (part,) = flat_parts([folded_panel(radius=200.0, sweep=1.0)], SheetSettings(), ShopSettings())
    (bend,) = bend_rows(part.bends)
    assert len(bend) == len(BENDS)
    assert bend[:3] == ("1", part.bends[0].direction, "197.0 - 197.0")
    assert bend[-1] == str(part.bends[0].hits)
    edges = edge_rows(part, {"end 1": "P2"})
    assert {len(row) for row in edges} == {len(EDGES)}
    assert [row[0] for row in edges] == list(part.size.edges)
    assert [row[2] for row in edges if row[0] == "end 1"] == ["P2"]
