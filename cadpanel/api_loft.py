"""What a Python program calls to span developable surfaces between curves. Millimetres throughout."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack, cast

from cadpanel.api_keywords import check_keywords
from cadpanel.delivery.folder import delivery_folder
from cadpanel.errors import SettingsError
from cadpanel.kinds import checked, shown
from cadpanel.lofting.loft import Loft, loft
from cadpanel.lofting.rail import Rail
from cadpanel.reference.settings import ReferenceKeywords, ReferenceSettings

if TYPE_CHECKING:
    from cadpanel.delivery.records.loft import LoftModel

__all__ = ["Loft", "Rail", "deliver_loft", "loft", "rails"]


@checked
def rails(path: str | Path, *names: str, **changes: Unpack[ReferenceKeywords]) -> tuple[Rail, Rail]:
    """Two curves of a file, to be spanned by `loft`.

    Args:
        path: a STEP, IGES, .brep or .3dm file.
        names: of both: a number, a name, or "layer=NAME"; none where the file holds two curves.
        changes: how it is read, for example unit="m".

    Raises:
        ReferenceFileError: the file cannot be read, or holds no loose curves.
        LoftError: there are no such curves.
    """
    from cadpanel.brep.curves.rails import chosen_rails, read_curves

    check_keywords("read", changes)
    return chosen_rails(read_curves(path, ReferenceSettings(**cast("dict[str, Any]", changes))), names)


@checked
def deliver_loft(loft: Loft, out: str | Path, *, max_warp: float = 1.0, overwrite: bool = False) -> LoftModel:
    """Write a loft into a folder, whole or not at all: loft.step, loft.dxf, loft.FCStd, loft.json, loft.png.

    Args:
        loft: the surface.
        out: the folder.
        max_warp: degrees of warp that are allowed; the record says whether it is kept.
        overwrite: replace what cadpanel wrote there before.

    Returns:
        What loft.json holds.

    Raises:
        DeliveryError: the folder cannot be written.
        LoftError: the surface turns over, so that its flat pattern would lie upon itself.
        SettingsError: what is given is no loft, or the largest warp no number of degrees.
        ProofError: what is read back is not what was written.
    """
    from cadpanel.delivery.loft_files import write_loft_files

    if not isinstance(loft, Loft):
        raise SettingsError(f"what is delivered is a loft as loft() gives it, not {shown(loft)}")
    if not 0.0 <= max_warp < math.inf:
        raise SettingsError(f"the largest warp is degrees, 0 or more, not {max_warp:g}")
    with delivery_folder(Path(out), overwrite=overwrite) as folder:
        return write_loft_files(loft, folder, allowed_warp=max_warp)
