"""The archive that a FreeCAD document is, dated by the environment: the same delivery gives the same bytes."""

from __future__ import annotations

import io
from collections.abc import Iterable
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.document.tree import tree
from cadpanel.delivery.document.xml import document_xml, gui_xml
from cadpanel.delivery.source_date import archive_date

DOCUMENT_XML, GUI_XML = "Document.xml", "GuiDocument.xml"
# From the right, in front and above, as FreeCAD's isometric view: axis and angle, and the way from there.
_TURN = (0.74290609, 0.30772209, 0.59447283, 1.2171158)
_FROM = np.array([1.0, -1.0, 1.0]) / np.sqrt(3.0)


def archive_bytes(contents: Contents, shapes: Iterable[tuple[str, bytes]]) -> bytes:
    """The whole file. FreeCAD reads it in one pass, so shapes stand between the file that names them and the looks.

    Raises:
        SettingsError: SOURCE_DATE_EPOCH is no number of seconds.
    """
    return packed(*xml_files(contents), shapes)


def packed(document: bytes, looks: bytes, shapes: Iterable[tuple[str, bytes]]) -> bytes:
    """The archive of a document's two files and its shapes.

    Raises:
        SettingsError: SOURCE_DATE_EPOCH is no number of seconds.
    """
    out, date = io.BytesIO(), archive_date()
    with ZipFile(out, "w", ZIP_DEFLATED) as archive:
        for name, data in ((DOCUMENT_XML, document), *shapes, (GUI_XML, looks)):
            entry = ZipInfo(name, date)
            entry.compress_type = ZIP_DEFLATED
            archive.writestr(entry, data)
    return out.getvalue()


def xml_files(contents: Contents) -> tuple[bytes, bytes]:
    """Document.xml and GuiDocument.xml, made of what the report says and of nothing else."""
    objects = tree(contents)
    corners = np.concatenate([np.reshape(panel.corners, (-1, 3)) for panel in contents.records])
    return document_xml(contents.title, objects), gui_xml(objects, camera(corners))


def camera(points: Array) -> str:
    """A camera that sees points (n, 3) as a whole, in the words of Open Inventor."""
    low, high = points.min(axis=0), points.max(axis=0)
    reach = max(1.0, float(np.linalg.norm(high - low)))
    x, y, z = (0.5 * (low + high) + reach * _FROM).round(3).tolist()
    turn = " ".join(f"{part:.8g}" for part in _TURN)
    return (
        f"OrthographicCamera {{\n  viewportMapping ADJUST_CAMERA\n  position {x} {y} {z}\n  orientation {turn}\n"
        f"  nearDistance 0\n  farDistance {2.0 * reach:.6g}\n  aspectRatio 1\n  focalDistance {reach:.6g}\n"
        f"  height {reach:.6g}\n}}\n"
    )
