"""All files of a loft, in a folder: the surface, its flat pattern, what was measured, and a picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.building.loft_skin import build_loft
from cadpanel.brep.proof.archive import kept_areas
from cadpanel.brep.proof.loft_facts import loft_facts
from cadpanel.brep.step.file import write_step
from cadpanel.brep.step.products import Header
from cadpanel.delivery.document.loft import FLAT_FILE, SURFACE_FILE, loft_bytes
from cadpanel.delivery.drawing.dxf import dxf_bytes, frame_of
from cadpanel.delivery.drawing.entities import Contour, Entity, Line
from cadpanel.delivery.own_files import LOFT, LOFT_DOCUMENT, LOFT_DXF, LOFT_PNG, LOFT_STEP
from cadpanel.delivery.records.jsonfile import Vector
from cadpanel.delivery.records.loft import LoftModel, LoftProofModel, loft_record, write_loft
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.source_date import source_date
from cadpanel.delivery.study_plot import can_plot
from cadpanel.errors import DeliveryError, LoftError, ProofError
from cadpanel.geometry.biarcs import arc_chains, arc_contour_area
from cadpanel.lofting.checks import at
from cadpanel.lofting.flat import outline
from cadpanel.lofting.loft import Loft

COLOUR = (0.55, 0.65, 0.75)
# By how much the kernel's area may differ from ours, as a share; and for each radian of warp, whose integrand has sharp
# bends where the normal turns over.
_SAME_AREA, _SAME_WARPED = 1e-6, 1e-4
# Beyond a right angle, radians, tangent planes at both ends of a ruling look to opposite sides.
_TURNED_OVER = 0.5 * np.pi
_NO_PICTURE = "There is no picture, as matplotlib is not installed: pip install 'cadpanel[plot]'."


def write_loft_files(
    loft: Loft,
    folder: Path,
    *,
    allowed_warp: float,
    shop: ShopSettings | None = None,
    file: str | None = None,
    notes: Sequence[str] = (),
    origin: Vector = (0.0, 0.0, 0.0),
) -> LoftModel:
    """Write loft.step, loft.dxf, loft.FCStd, loft.json and loft.png, and read the first three back.

    Args:
        loft: the surface.
        folder: where.
        allowed_warp: degrees of warp that are not told as too many.
        shop: how the drawing is made.
        file: that the rails were read from.
        notes: on its reading.
        origin: what was taken off its coordinates, mm.

    Raises:
        DeliveryError: a file cannot be written.
        LoftError: the surface turns over, so that its flat pattern would lie upon itself.
        ProofError: what is read back is not what was written.
    """
    how = shop or ShopSettings()
    write_step(
        folder / LOFT_STEP, [(loft.name, build_loft(loft), COLOUR)], title=loft.name, header=Header(date=source_date())
    )
    contour = flat_contour(loft, how.chord)
    rulings = flat_rulings(loft, how.roll_pitch)
    drawing: list[Entity] = [Contour(how.layer("CUT"), contour)]
    if not how.dxf_contour_only:
        drawing += [Line(how.layer("ROLL"), *line) for line in rulings]
    _write(folder / LOFT_DXF, dxf_bytes(drawing, frame_of(how), how.dxf_entities))
    _write(folder / LOFT_DOCUMENT, loft_bytes(loft, folder / LOFT_STEP, contour, rulings))
    proof = _proved(loft, folder, contour, how)
    told = () if can_plot() else (_NO_PICTURE,)
    record = loft_record(
        loft,
        allowed_warp=allowed_warp,
        chord=how.chord,
        proof=proof,
        file=file,
        notes=[*notes, *told],
        origin=origin,
    )
    write_loft(record, folder / LOFT)
    if can_plot():
        from cadpanel.delivery.pictures.figure import png_bytes
        from cadpanel.delivery.pictures.loft import draw_loft

        _write(folder / LOFT_PNG, png_bytes(draw_loft(loft)))
    return record


def _write(path: Path, data: bytes) -> None:
    try:
        path.write_bytes(data)
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be written: {error.strerror or error}.") from error


def flat_contour(loft: Loft, chord: float) -> Array:
    """(v, 3) the outline of the flat pattern as a closed chain of arcs within `chord` mm: starts and bulges."""
    return np.concatenate(arc_chains(outline(loft.flat[0]), chord))


def flat_rulings(loft: Loft, pitch: float) -> Array:
    """(m, 2, 2) rulings of the flat pattern, about `pitch` mm apart on the longer rail, and where pieces meet."""
    found = []
    for piece, flat in zip(loft.pieces, loft.flat[0], strict=True):
        lengths = (piece.shares[1] - piece.shares[0]) * [rail.length for rail in loft.rails]
        count = max(2, int(np.ceil(float(np.abs(lengths).max()) / pitch - 1e-9)) + 1)
        found.append(flat.rulings(np.linspace(0.0, 1.0, count))[1:])
    return np.concatenate(found)[:-1]


def _folded(loft: Loft) -> str:
    """What is wrong with rails between which the surface turns over, and where."""
    piece, place = np.unravel_index(int(loft.warps.argmax()), loft.warps.shape)
    ends = loft.pieces[piece].jets(np.linspace(0.0, 1.0, loft.warps.shape[1])[[place]])
    return (
        f"between the rails '{loft.rails[0].name}' and '{loft.rails[1].name}' the surface turns over and would lie "
        f"upon itself in the plane: at {at(ends[0].point[0])} it is warped by {np.degrees(loft.warps.max()):.0f} "
        "degrees; draw rails that bend alike, or loft shorter parts of them"
    )


def _proved(loft: Loft, folder: Path, contour: Array, how: ShopSettings) -> LoftProofModel:
    from ezdxf.filemanagement import readfile

    facts, error = loft_facts(folder / LOFT_STEP), loft.flat[1]
    expected = tuple("ruled" if kind is None else kind.word for kind in loft.faces)
    document = readfile(folder / LOFT_DXF)
    audit = document.audit()
    drawn = [entity for entity in document.modelspace() if entity.dxf.layer == how.layer("CUT")]
    area = arc_contour_area(contour)
    # A chord's width all along, and what warp takes from the surface.
    allowed = abs(error.area) + how.chord * float(np.linalg.norm(contour[:, :2] - np.roll(contour[:, :2], 1, axis=0)))
    allowed += how.chord * sum(rail.length for rail in loft.rails)
    if abs(area - error.surface) > allowed and loft.max_warp > _TURNED_OVER:
        raise LoftError(_folded(loft))
    kept = kept_areas(folder / LOFT_DOCUMENT)
    faults = [
        fault
        for wrong, fault in (
            (not facts.valid, f"'{LOFT_STEP}': the kernel's check of its shape fails."),
            (facts.faces != expected, f"'{LOFT_STEP}' holds {', '.join(facts.faces)}, expected {', '.join(expected)}."),
            (
                abs(facts.area - error.surface) > (_SAME_AREA + _SAME_WARPED * loft.max_warp) * error.surface,
                f"'{LOFT_STEP}': its faces have {facts.area:.6g} mm2, expected {error.surface:.6g}.",
            ),
            (
                abs(kept[SURFACE_FILE] - facts.area) > (_SAME_AREA + _SAME_WARPED * loft.max_warp) * facts.area,
                f"'{LOFT_DOCUMENT}': its surface has {kept[SURFACE_FILE]:.6g} mm2, expected {facts.area:.6g}.",
            ),
            (
                abs(kept[FLAT_FILE] - area) > _SAME_AREA * area,
                f"'{LOFT_DOCUMENT}': its flat pattern has {kept[FLAT_FILE]:.6g} mm2, expected {area:.6g}.",
            ),
            (bool(audit.errors), f"'{LOFT_DXF}': ezdxf finds {len(audit.errors)} faults."),
            (not drawn, f"'{LOFT_DXF}' holds nothing on the layer that is cut."),
            (
                abs(area - error.surface) > allowed,
                f"'{LOFT_DXF}': its contour encloses {area:.6g} mm2, expected {error.surface:.6g}.",
            ),
        )
        if wrong
    ]
    if faults:
        raise ProofError(faults)
    return LoftProofModel(faces=facts.faces, area=facts.area, drawn_area=area, audit_errors=len(audit.errors))
