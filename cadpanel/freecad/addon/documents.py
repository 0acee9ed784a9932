"""What a delivery's document holds: its panels, and the folder that it lies in."""

from __future__ import annotations

import fnmatch
import json
from pathlib import Path
from typing import Any

DOCUMENT = "panels.FCStd"
REPORT = "report.json"
_SCHEMA = "cadpanel.report/1"


class DeliveryMissing(Exception):
    """There is no delivery where one is needed; one sentence says so, and what to do."""


def panels_of(document: Any) -> list[Any]:
    """The panels' solids, in the order of the delivery.

    Raises:
        DeliveryMissing: it holds none.
    """
    found = [thing for thing in document.Objects if "WantedFeature" in thing.PropertiesList] if document else []
    if not found:
        raise DeliveryMissing("This document holds no panels of cadpanel: open a delivery first.")
    return found


def beside_panels(document: Any, group: str) -> list[Any]:
    """The objects in one of the groups "Seams", "Skins" and "Flats"."""
    found = document.getObject(group)
    return list(found.Group) if found is not None else []


def folder_of(document: Any) -> str:
    """The folder of the delivery that a document belongs to.

    Raises:
        DeliveryMissing: there is no report beside the document.
    """
    folder = Path(document.FileName).parent
    if not document.FileName or not (folder / REPORT).is_file():
        raise DeliveryMissing(f"There is no {REPORT} beside this document: open {DOCUMENT} in its delivery's folder.")
    return str(folder)


def report_of(folder: str) -> dict[str, Any]:
    """The numbers of the delivery in a folder.

    Raises:
        DeliveryMissing: its report cannot be read, or is not cadpanel's.
    """
    path = Path(folder) / REPORT
    try:
        with path.open(encoding="utf-8") as file:
            found: dict[str, Any] = json.load(file)
    except (OSError, ValueError) as error:
        raise DeliveryMissing(f"'{path}' cannot be read ({error}): choose the folder of a delivery.") from error
    if found.get("schema") != _SCHEMA:
        raise DeliveryMissing(f"'{path}' is not a report of cadpanel: choose the folder of a delivery.")
    return found


def document_in(folder: str) -> str:
    """The document of the delivery in a folder.

    Raises:
        DeliveryMissing: it has none.
    """
    report_of(folder)
    path = Path(folder) / DOCUMENT
    if not path.is_file():
        raise DeliveryMissing(f"'{folder}' holds no {DOCUMENT}: write the delivery again, with the output 'freecad'.")
    return str(path)


def named(document: Any, pattern: str) -> list[Any]:
    """The panels whose names a pattern fits, with * for anything; upper and lower case count alike."""
    wanted = pattern.strip().casefold()
    return [one for one in panels_of(document) if fnmatch.fnmatchcase(one.PanelName.casefold(), wanted)]


def show_flats(document: Any) -> bool:
    """Show the flat patterns instead of the panels, or the other way round; whether flat patterns are shown now."""
    flats = beside_panels(document, "Flats")
    show = not any(one.Visibility for one in flats)
    for one in flats:
        one.Visibility = show
    for one in [*panels_of(document), *beside_panels(document, "Seams")]:
        one.Visibility = not show
    for name, shown in (("Flats", show), ("Panels", not show), ("Seams", not show)):
        group = document.getObject(name)
        if group is not None:
            group.Visibility = shown
    return show
