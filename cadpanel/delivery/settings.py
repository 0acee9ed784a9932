"""What the sheets are made of and how they are written: the settings of a delivery, checked when they are made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from cadpanel.errors import SettingsError
from cadpanel.geometry.limits import THICKEST_SHEET, THINNEST_SHEET, WIDEST_JOINT
from cadpanel.geometry.sheet_checks import SkinSide
from cadpanel.setting import Option, Range, check_ranges, setting

Schema = Literal["AP242", "AP214"]
Ends = Literal["bevel", "square"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SheetSettings:
    """How panels are built and written.

    Attributes:
        thickness: of the sheet, mm.
        joint: clear width between any two neighbouring sheets, mm; the fitted skins meet in its middle.
        ends: "bevel": walls stand in the planes of joints and ends; "square": square to the sheet, as lasers cut them,
            where the shorter face of such a wall ends.
        skin_side: "outer": the skin is the outer face and the sheet lies inside; "inner": the other way round.
        schema: of the STEP files, "AP242" or "AP214".
    """

    thickness: float = setting(
        3.0,
        within=Range(what="sheet thickness", least=THINNEST_SHEET, most=THICKEST_SHEET, unit=" mm"),
        option=Option(metavar="MM", help="Of the sheet."),
    )
    joint: float = setting(
        0.0,
        within=Range(what="joint", least=0.0, most=WIDEST_JOINT, unit=" mm"),
        option=Option(metavar="MM", help="Clear width between neighbouring sheets, along the whole seam."),
    )
    ends: Ends = setting(
        "bevel",
        option=Option(help="Walls in the planes of joints and ends, or square to the sheet, as lasers cut them?"),
    )
    skin_side: SkinSide = setting("outer", option=Option(help="Is the fitted skin the sheet's outer or inner face?"))
    schema: Schema = setting("AP242", option=Option(help="Of the STEP files."))

    def __post_init__(self) -> None:
        """Check every setting.

        Raises:
            SettingsError: a setting is out of range; the message says which and what it may be.
        """
        check_ranges(self)
        _require_one_of("way in which ends stand", self.ends, get_args(Ends))
        _require_one_of("skin side", self.skin_side, get_args(SkinSide))
        _require_one_of("STEP schema", self.schema, get_args(Schema))


def _require_one_of(what: str, value: str, choices: tuple[str, ...]) -> None:
    if value not in choices:
        raise SettingsError(f"the {what} must be {' or '.join(choices)}, not '{value}'")
