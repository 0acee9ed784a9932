"""From fitted panels to exact solids and skins, with what the report says of each. Nothing is written here."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from typing import NamedTuple

from cadpanel.arrays import Array
from cadpanel.brep.building.many import MadeSheet, make_sheets
from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.kernel.types import Shell, Solid
from cadpanel.brep.step.properties import Validation
from cadpanel.delivery.panel_fixings import PanelFixings, panel_fixings
from cadpanel.delivery.panel_returns import Returned, returned
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import PanelError
from cadpanel.geometry.edge_planes import SeamEdges
from cadpanel.geometry.joint_widths import widest_joint
from cadpanel.geometry.joints import Joint, Jointed, cut_to_seams
from cadpanel.geometry.panel import Panel, Straightened
from cadpanel.geometry.sheet_checks import other_face, sheet_depth
from cadpanel.reference.model import Seam

# What is going on, how much of it is done, and of how much.
Progress = Callable[[str, int, int], None]
FOUR_EDGES = ("end 0", "end 1", "side 0", "side 1")


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelSheet:
    """A panel's sheet as an exact solid, and the formula's numbers to hold it against.

    Attributes:
        shape: the panel as it is built: a cone that is all but a cylinder has become one, and it is cut back from its
            seams by half a joint.
        fitted: the same before it was cut back.
        other: the sheet's other face.
        solid: the sheet.
        skin: the open shell that approximates the reference.
        check, skin_check: by which a receiver sees that the solid and the skin arrived whole.
        area: of the skin, mm^2.
        volume: of the sheet, mm^3.
        fixings: its holes; None where none are asked for. The skin has none.
        returns: its edges that are folded; their cylinders and planes are patches of `shape`, not of `fitted`.
        tray: where it is a flat panel that is folded, the length and the inner radius of its returns, mm.
        moved: how far the farthest corner of `fitted` lies from where the fit had it, mm.
        notes: what the fabricator should know, one sentence each.
    """

    shape: Panel
    fitted: Panel
    other: Panel
    solid: Solid
    skin: Shell
    check: Validation
    skin_check: Validation
    area: float
    volume: float
    fixings: PanelFixings | None
    returns: tuple[str, ...]
    tray: tuple[float, float] | None
    moved: float
    notes: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Built:
    """All sheets of a fit.

    Attributes:
        panels: one sheet a panel.
        joints: of each seam, where it stands.
    """

    panels: tuple[PanelSheet, ...]
    joints: tuple[Joint, ...]


def build_panels(
    shapes: Sequence[Panel],
    sheet: SheetSettings,
    seams: Sequence[Seam] = (),
    progress: Progress | None = None,
    own_joints: Mapping[int, float] | None = None,
    shop: ShopSettings | None = None,
) -> Built:
    """Build the sheet and the skin of every panel, cut back from the seams.

    Args:
        shapes: as they were fitted.
        sheet: thickness, joint and side.
        seams: which of their edges meet.
        progress: told of every panel.
        own_joints: clear widths of single seams, by their places, mm.
        shop: what is done to sheets: holes and returns.

    Raises:
        PanelError: a panel cannot be built; the message names it, the reason and the remedy.
    """
    tell = progress or say_nothing
    tell("build", 0, len(shapes))
    straight = [shape.straightened() for shape in shapes]
    fitted = [one.shape for one in straight]
    edges, square = seam_edges(shapes, seams, own_joints or {}), sheet.ends == "square"
    try:
        depth = sheet_depth(sheet.thickness, sheet.skin_side)
        jointed = cut_to_seams(fitted, edges, sheet.joint, depth)
        panels = _build_all(straight, jointed, (sheet, shop or ShopSettings()), tell)
    except PanelError:
        narrow = widest_joint(fitted, edges, sheet.joint, sheet.thickness, sheet.skin_side, square=square)
        if narrow is None:
            raise
        raise PanelError(narrow.panel, narrow.reason) from None
    return Built(panels=panels, joints=jointed.joints)


def seam_edges(shapes: Sequence[Panel], seams: Sequence[Seam], own_joints: Mapping[int, float]) -> list[SeamEdges]:
    """The seams of a reference by the names of edges that panels know, some with joints of their own, mm."""

    def edge(panel: int, number: int) -> str:
        return FOUR_EDGES[number] if shapes[panel].four_sided else f"edge {number}"

    return [
        SeamEdges(
            panels=seam.panels,
            edges=(edge(seam.panels[0], seam.edges[0]), edge(seam.panels[1], seam.edges[1])),
            joint=own_joints.get(place),
        )
        for place, seam in enumerate(seams)
    ]


def say_nothing(_step: str, _done: int, _of: int) -> None:
    """The progress of those who did not ask for it."""


def _build_all(
    straight: Sequence[Straightened[Panel]],
    jointed: Jointed,
    asked: tuple[SheetSettings, ShopSettings],
    tell: Progress,
) -> tuple[PanelSheet, ...]:
    planned = [_plan(one, returned(shape, *asked), *asked) for one, shape in zip(straight, jointed.shapes, strict=True)]
    done = count(1)

    def told(more: int) -> None:
        for _ in range(more):
            tell("build", next(done), len(planned))

    made = make_sheets([plan.wanted for plan in planned], told)
    return tuple(_panel_sheet(plan, sheet) for plan, sheet in zip(planned, made, strict=True))


class _Plan(NamedTuple):
    """A panel as it is to be built."""

    straight: Straightened[Panel]
    cut: Returned
    fixings: PanelFixings | None
    wanted: Sheet


def _plan(straight: Straightened[Panel], cut: Returned, sheet: SheetSettings, shop: ShopSettings) -> _Plan:
    depth = sheet_depth(sheet.thickness, sheet.skin_side)
    shape = cut.shape.squared(depth) if sheet.ends == "square" else cut.shape
    fixings = panel_fixings(shape, sheet, shop)
    holes = () if fixings is None else fixings.holes
    return _Plan(
        straight, cut, fixings, Sheet(shape=shape, thickness=sheet.thickness, skin_side=sheet.skin_side, holes=holes)
    )


def _panel_sheet(plan: _Plan, made: MadeSheet) -> PanelSheet:
    straight, cut, fixings, wanted = plan
    shape, thickness, skin_side = wanted.shape, wanted.thickness, wanted.skin_side
    found = made.measured
    volume = found.volume - (fixings.volume if fixings is not None else 0.0)
    notes = tuple(
        f"The cone of patch {index + 1} is so slender that it is built as a cylinder; "
        f"no corner moves by more than {straight.largest_move:.2g} mm."
        for index in straight.patches
    )
    return PanelSheet(
        shape=shape,
        fitted=straight.shape,
        other=other_face(shape, thickness, skin_side),
        solid=made.solid,
        skin=made.skin,
        check=_validation(found.area, volume, found.centroid),
        skin_check=_validation(found.skin_area, None, found.skin_centroid),
        area=shape.area(),
        volume=volume,
        fixings=fixings,
        returns=cut.edges,
        tray=cut.tray,
        moved=straight.largest_move,
        notes=(*notes, *cut.notes),
    )


def _validation(area: float, volume: float | None, centroid: Array) -> Validation:
    """Of a solid of that volume, mm3, or of an open shell."""
    x, y, z = centroid.tolist()
    return Validation(area=area, volume=volume, centroid=(x, y, z))
