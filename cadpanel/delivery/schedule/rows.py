"""The rows of a schedule, from the records of a report alone."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.records.blanks import BendModel, BlankModel
from cadpanel.delivery.records.report import PanelModel, SeamModel
from cadpanel.delivery.schedule.csv_text import Cell, Row

_MM2_PER_M2 = 1e6
# Radii that differ by no more than a part of this many mm are counted together.
_RADIUS_STEP = 10.0

PANEL_HEADINGS = (
    *("row", "panel", "strip", "feature", "thickness mm", "file"),
    *("blank length mm", "blank width mm", "area m2", "mass kg", "stock"),
    *("largest deviation mm", "RMS deviation mm", "largest gap mm", "largest kink deg"),
    *("end 0 bevel least deg", "end 0 bevel largest deg", "end 1 bevel least deg", "end 1 bevel largest deg"),
    *("other edges bevel least deg", "other edges bevel largest deg", "fixing holes"),
)
BEND_HEADINGS = (
    *("bend", "direction", "inner radius least mm", "inner radius largest mm", "sweep deg", "half angle deg"),
    *("length at end 0 mm", "length at end 1 mm", "angle at end 0 deg", "angle at end 1 deg", "press hits"),
)


def schedule_rows(contents: Contents) -> Iterator[Row]:
    """Headings; one row a panel with its first bend, one more for every further bend; totals."""
    yield (*PANEL_HEADINGS, *BEND_HEADINGS)
    worst = _worst_of_seams(contents.seams)
    for panel in contents.records:
        assert panel.blank is not None  # reports from before there were schedules have none to write
        cells = _panel_cells(panel, panel.blank, contents.sheet.thickness, worst.get(panel.name, (None, None)))
        yield ("panel", *cells, *(_bend_cells(1, panel.bends[0]) if panel.bends else ()))
        for number, bend in enumerate(panel.bends[1:], start=2):
            blanks = [None] * (len(PANEL_HEADINGS) - 2)
            yield ("bend", panel.name, *blanks, *_bend_cells(number, bend))
    yield ()
    yield from _totals(contents)


def strip_of(name: str) -> str:
    """The strip or surface that a panel belongs to: what stands before the last hyphen of its name."""
    return name.rpartition("-")[0]


def _panel_cells(
    panel: PanelModel, blank: BlankModel, thickness: float, seams: tuple[float | None, float | None]
) -> list[Cell]:
    gap, kink = seams
    bevels = [panel.bevels.get(end, (None, None)) for end in ("end 0", "end 1")]
    others = [angle for edge, pair in panel.bevels.items() if not edge.startswith("end") for angle in pair]
    cells: list[Cell] = [panel.name, strip_of(panel.name), panel.feature, thickness, f"{blank.file}.dxf"]
    cells += [_round(blank.width, 2), _round(blank.height, 2), _round(blank.area / _MM2_PER_M2, 6)]
    cells += [_round(panel.mass, 3), blank.stock, _round(panel.max_deviation, 3), _round(panel.rms_deviation, 3)]
    cells += [_round(gap, 3), _round(kink, 3)]
    cells += [_round(angle, 2) for pair in (*bevels, (min(others), max(others))) for angle in pair]
    return [*cells, len(panel.fixings)]


def _bend_cells(number: int, bend: BendModel) -> list[Cell]:
    cells: list[Cell] = [number, bend.direction, _round(bend.radius[0], 2), _round(bend.radius[1], 2)]
    cells += [_round(bend.sweep, 3), _round(bend.half_angle, 4)]
    return [*cells, *(_round(one, 2) for one in bend.lengths), *(_round(one, 3) for one in bend.angles), bend.hits]


def _round(value: float | None, digits: int) -> float | None:
    """To so many digits, and never to a negative zero."""
    return None if value is None else round(value, digits) + 0.0


def _worst_of_seams(seams: Iterable[SeamModel]) -> Mapping[str, tuple[float, float]]:
    found: dict[str, tuple[float, float]] = defaultdict(lambda: (0.0, 0.0))
    for seam in seams:
        gap = max(seam.max_corner_gap, seam.max_seam_gap)
        for name in seam.panels:
            found[name] = max(found[name][0], gap), max(found[name][1], seam.max_kink)
    return found


def _totals(contents: Contents) -> Iterator[Row]:
    """How many panels, how much area and how heavy, by feature, thickness and sheet; bends by radius."""
    yield ("totals of", "", "panels", "area m2", "mass kg", "fixing holes")
    panels = contents.records
    yield _sum("all panels", "", panels)
    thickness = f"{contents.sheet.thickness:g}"
    groups: list[tuple[str, Callable[[PanelModel], str]]] = [
        ("feature", lambda panel: panel.feature),
        ("thickness mm", lambda _: thickness),
    ]
    if contents.shop.stock:
        groups.append(("stock", lambda panel: _stock(panel.blank)))
    for what, key in groups:
        yield from (_sum(what, value, own) for value, own in _grouped(panels, key).items())
    yield from _totals_of_bends(panels)


def _totals_of_bends(panels: Sequence[PanelModel]) -> Iterator[Row]:
    """How many bends, how far and in how many strokes, by their mean inner radius; nothing where nothing is bent."""
    if not any(panel.bends for panel in panels):
        return
    yield ()
    yield ("bends by inner radius", "mm", "bends", "sum of sweeps deg", "press hits")
    bends = [bend for panel in panels for bend in panel.bends]
    by_radius: dict[int, list[BendModel]] = defaultdict(list)
    for bend in bends:
        by_radius[int((0.5 * sum(bend.radius)) // _RADIUS_STEP)].append(bend)
    for step, own in sorted(by_radius.items()):
        span = f"{step * _RADIUS_STEP:g} to {(step + 1) * _RADIUS_STEP:g}"
        yield ("", span, len(own), _round(sum(bend.sweep for bend in own), 3), sum(bend.hits for bend in own))


def _stock(blank: BlankModel | None) -> str:
    return "none" if blank is None or blank.stock is None else blank.stock


def _grouped(panels: Sequence[PanelModel], key: Callable[[PanelModel], str]) -> dict[str, list[PanelModel]]:
    found: dict[str, list[PanelModel]] = defaultdict(list)
    for panel in panels:
        found[key(panel)].append(panel)
    return dict(sorted(found.items()))


def _sum(what: str, value: str, panels: Sequence[PanelModel]) -> Row:
    area = sum(panel.blank.area for panel in panels if panel.blank is not None) / _MM2_PER_M2
    mass = sum(panel.mass for panel in panels if panel.mass is not None)
    holes = sum(len(panel.fixings) for panel in panels)
    return (what, value, len(panels), _round(area, 6), _round(mass, 3), holes)
