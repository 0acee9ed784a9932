"""A region of a job: what is read, how, and what comes of it; checked when the job is read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.settings import ReferenceSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class Region:
    """One region.

    Attributes:
        name: also that of its folder.
        reference: the file.
        sha256: of the file's bytes; empty where any will do.
        deliveries: where the earlier deliveries lie that panels are locked to, by the names that rules have for these.
        given: the settings as the job has them, as TOML knows them; files by their whole paths, rules as their file has
            them.
        how, settings, sheet, shop: what these make.
    """

    name: str
    reference: Path
    sha256: str
    deliveries: Mapping[str, Path]
    given: Mapping[str, Any]
    how: ReferenceSettings
    settings: FitSettings
    sheet: SheetSettings
    shop: ShopSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """What a job file asks for, without variables, defaults and matrices.

    Attributes:
        out: the folder to write into, if the file names one.
        regions: in the order of the file, those of a matrix one after the other.
    """

    out: Path | None
    regions: tuple[Region, ...]
