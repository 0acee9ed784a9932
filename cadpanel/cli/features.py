"""The command `cadpanel features`."""

from __future__ import annotations

from cadpanel.features.catalogue import AUTO, CATALOGUE, POLYGON, feature


def features() -> None:
    """List the shape features, with their independent numbers and their sections across the panel."""
    from rich.table import Table

    from cadpanel.cli.tables import console

    table = Table(title="Shape features, for --feature", title_justify="left", title_style="bold")
    for heading in ("Name", "Numbers", "Section", "For"):
        table.add_column(heading, justify="right" if heading == "Numbers" else "left")
    for name, entry in CATALOGUE.items():
        table.add_row(name, str(len(feature(name).free)), entry.picture, entry.use)
        if name == "planar-quadrilateral":
            table.add_row(POLYGON, "3 + 2n", r"/\__", "flat sheet with n corners: triangles, hexagons")
    two, three = (len(feature(f"cone-spline-{cones}").free) for cones in (2, 3))
    table.add_row(
        "cone-spline-K", f"{two - 2 * (three - two)} + {three - two}K", "(((((", "any developable strip, by K cones"
    )
    table.add_row(AUTO, "", "", "for each panel the cheapest of these that stays within --max-deviation")
    out = console()
    out.print(table)
    out.print(
        "Numbers are the independent unknowns of a panel, its trimming included. '_' is a plane, '(' a cylinder or "
        "cone; neighbouring patches meet without a kink.",
        soft_wrap=True,
    )
