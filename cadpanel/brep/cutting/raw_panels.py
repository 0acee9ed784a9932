"""From a file to panels: its products, the faces that are chosen, or what they are cut into, as samples."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import numpy as np
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.cutting.ways import cut_surfaces
from cadpanel.brep.faces.sampling import sample_panels
from cadpanel.brep.files.catalogue import checked_format_of
from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.loading import far_origin, load_model, origin_note
from cadpanel.brep.files.model import Model, NamedShape
from cadpanel.brep.files.names import unique_names
from cadpanel.brep.files.packing import PackedProducts
from cadpanel.brep.files.step import STEP
from cadpanel.brep.files.units import refuse_given, unit_missing
from cadpanel.brep.isolation.client import read_guarded
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.kernel.transforms import shifted
from cadpanel.brep.skin.adjacency import surfaces_of
from cadpanel.brep.skin.face_cleanup import skin_faces
from cadpanel.brep.skin.panel_cleanup import gap_notes, mend_panels
from cadpanel.errors import PanelError, ReferenceFileError
from cadpanel.reference.model import RawPanel
from cadpanel.reference.settings import ReferenceSettings

# Panels sampled together: enough to share the overhead, few enough to take little memory.
PANELS_AT_ONCE = 128


@dataclass(frozen=True, slots=True, kw_only=True)
class RawReference:
    """What a file gives before panels are made of it.

    Attributes:
        panels: sampled faces, panel by panel, mm.
        notes: what was mended or moved, and what should be known of the file, one sentence each.
    """

    panels: tuple[RawPanel, ...]
    notes: tuple[str, ...]


def raw_panels(path: Path, how: ReferenceSettings) -> RawReference:
    """Read a file into sampled faces, panel by panel, in millimetres.

    Without a way to cut the surface, panels are the file's products in their order. Those without a name are called
    "panel 1", "panel 2" by their place in the file; of several with one name the second becomes "name (2)", and so on.

    Raises:
        ReferenceFileError: the file cannot be read, holds no faces, or cannot be cut as asked.
        PanelError: a product is a solid, holds no face, or holds one that cannot be sampled.
    """
    if how.way is not None:
        return _cut_panels(path, how)
    if has_products(path, how):
        return _product_panels(path, how)
    return _part_panels(load_model(path, how.millimetres), how)


def has_products(path: Path, how: ReferenceSettings) -> bool:
    """Whether each product of the file is to be a panel.

    Raises:
        ReferenceFileError: there is no such file, or it has no format that is known.
    """
    return how.way is None and how.faces is None and checked_format_of(path) is STEP


def _product_panels(path: Path, how: ReferenceSettings) -> RawReference:
    """The products of a STEP file as panels."""
    found = cast(PackedProducts, read_guarded("products", path, how.millimetres)).unpack()
    if found.unit is not None and how.millimetres is not None:
        raise refuse_given(path.name, found.unit)
    notes = [unit_missing(path.name)] if found.unit is None and how.millimetres is None else []
    products = found.shapes
    origin = far_origin([product.shape for product in products], path.name)
    if origin is not None:
        back = (-origin[0], -origin[1], -origin[2])
        products = tuple(replace(product, shape=shifted(product.shape, back)) for product in products)
        notes.append(origin_note(path.name, origin))
    panels, mended = _mended(products, path.name, how.seam_tolerance)
    return RawReference(panels=panels, notes=(*notes, *mended))


def _part_panels(model: Model, settings: ReferenceSettings) -> RawReference:
    """The parts of a model as panels, each with those of its faces that are chosen."""
    names = model.panel_names()
    if settings.faces is None:
        shapes = [NamedShape(name, part.shape) for name, part in zip(names, model.parts, strict=True) if name]
        curves = names.count("")
        many = "1 loose curve, which is no panel" if curves == 1 else f"{curves} loose curves, which are no panels"
        notes = [f"'{model.source}' holds {many}."] if curves else []
        panels, mended = _mended(shapes, model.source, settings.seam_tolerance)
        return RawReference(panels=panels, notes=(*model.notes, *notes, *mended))
    chosen, mended = skin_faces(select_faces(model, settings.faces), model.source, settings.seam_tolerance)
    parts = sorted({face.source.part for face in chosen})
    shapes = [
        NamedShape(names[part], compound_of(face.source.face for face in chosen if face.source.part == part))
        for part in parts
    ]
    panels = _sampled(shapes, model.source)
    gaps = gap_notes(panels, model.source, settings.seam_tolerance)
    return RawReference(panels=panels, notes=(*model.notes, *mended, *gaps))


def _cut_panels(path: Path, settings: ReferenceSettings) -> RawReference:
    """The chosen faces of a file, cut into panels."""
    model = load_model(path, settings.millimetres, beside_unitless=settings.beside(path) is not None)
    skin, mended = skin_faces(select_faces(model, settings.faces), model.source, settings.seam_tolerance)
    surfaces, gaps = surfaces_of(skin, model.source, settings.seam_tolerance)
    cut = cut_surfaces(model, surfaces, settings, path)
    shapes = [NamedShape(panel.name, compound_of(panel.faces)) for panel in cut.panels]
    notes = dict.fromkeys((*model.notes, *mended, *gaps, *cut.notes))  # the reference may be read as a spine, too
    return RawReference(panels=_sampled(shapes, model.source), notes=tuple(notes))


def _mended(
    products: Sequence[NamedShape], source: str, tolerance: float
) -> tuple[tuple[RawPanel, ...], tuple[str, ...]]:
    """Sample panels as the file has them, and mend what can be; with notes."""
    return mend_panels(_sampled(products, source), [product.shape for product in products], source, tolerance)


def _sampled(products: Iterable[NamedShape], source: str) -> tuple[RawPanel, ...]:
    """Sample panels under names of their own."""
    shapes = tuple(products)
    names = unique_names([product.name for product in shapes])
    named = list(zip(names, (product.shape for product in shapes), strict=True))
    panels = tuple(
        panel
        for start in range(0, len(named), PANELS_AT_ONCE)
        for panel in _sample(named[start : start + PANELS_AT_ONCE], source)
    )
    if not any(panel.faces for panel in panels):
        raise ReferenceFileError(
            f"'{source}' holds no faces, only curves, points or nothing: "
            "export the faces of the skin, one product a panel."
        )
    for panel in panels:
        if not panel.faces:
            raise PanelError(panel.name, f"in '{source}', it holds no face: take it out of the export.")
    return panels


def _sample(named: Sequence[tuple[str, TopoDS_Shape]], source: str) -> list[RawPanel]:
    """Sample some panels' faces, or say which of them has none that can be sampled, and why."""
    for name, shape in named:
        if shapes_of(shape, TopAbs_SOLID):
            raise PanelError(
                name,
                f"in '{source}', it is a solid: export only the faces of its skin, not the solid, or choose them.",
            )
    try:
        samples = sample_panels([shape for _, shape in named])
    except Standard_Failure as error:
        if len(named) > 1:  # which of them is it?
            return [panel for one in named for panel in _sample([one], source)]
        raise PanelError(
            named[0][0],
            f"in '{source}', the CAD kernel cannot evaluate its faces ({error}): repair them and export again.",
        ) from error
    panels = [RawPanel(name=name, faces=faces) for (name, _), faces in zip(named, samples, strict=True)]
    for panel in panels:
        if not _is_finite(panel):
            raise PanelError(
                panel.name, f"in '{source}', it has points that are not numbers: repair its faces and export again."
            )
    return panels


def _is_finite(panel: RawPanel) -> bool:
    """Whether all points, normals and weights of a panel are numbers."""
    arrays = [
        array
        for face in panel.faces
        for array in (face.points, face.normals, face.weights, *face.edges, *face.edge_normals)
    ]
    return all(bool(np.isfinite(array).all()) for array in arrays)
