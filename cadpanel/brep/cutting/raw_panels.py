"""From a file to panels: its products, the faces that are chosen, or what they are cut into, as samples."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.cutting.ways import Drawn, cut_surfaces
from cadpanel.brep.faces.sampling import sample_panels
from cadpanel.brep.files.face_choice import require_faces, select_faces
from cadpanel.brep.files.model import Model, NamedShape, Products
from cadpanel.brep.files.names import unique_names
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.skin.adjacency import surfaces_of
from cadpanel.brep.skin.face_cleanup import skin_faces
from cadpanel.brep.skin.panel_cleanup import Mended, gap_notes, mend_panels
from cadpanel.errors import PanelError, ReferenceFileError
from cadpanel.geometry.limits import LARGEST_COORDINATE
from cadpanel.geometry.vectors import norm
from cadpanel.reference.model import FaceSamples, RawPanel
from cadpanel.reference.outline import Outline
from cadpanel.reference.settings import ReferenceSettings

# Panels sampled together: enough to share the overhead, few enough to take little memory.
PANELS_AT_ONCE = 128


@dataclass(frozen=True, slots=True, kw_only=True)
class RawReference:
    """What a file gives before panels are made of it.

    Attributes:
        panels: sampled faces, panel by panel, mm.
        notes: what was mended or moved, and what should be known of the file, one sentence each.
        origin: what was taken off all coordinates of the file, mm.
        outlines: of the panels, where they are found already.
    """

    panels: tuple[RawPanel, ...]
    notes: tuple[str, ...]
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    outlines: tuple[Outline, ...] | None = None


def raw_panels(found: Model | Products, how: ReferenceSettings, drawn: Drawn | None = None) -> RawReference:
    """Cut and sample what a file holds into faces, panel by panel, in millimetres.

    Without a way to cut the surface, panels are the file's products in their order. Those without a name are called
    "panel 1", "panel 2" by their place in the file; of several with one name the second becomes "name (2)", and so on.

    Args:
        found: as `load_reference` reads it.
        how: the settings by which it was read.
        drawn: as `load_drawn` gives it, what the surface is cut by.

    Raises:
        ReferenceFileError: the file holds no faces, or cannot be cut as asked.
        PanelError: a product is a solid, holds no face, or holds one that cannot be sampled.
    """
    if isinstance(found, Products):
        mended = mended_products(found.shapes, found.source, how.seam_tolerance)
        notes = mended.notes(found.source, how.seam_tolerance)
        return RawReference(
            panels=mended.panels, notes=(*found.notes, *notes), origin=found.origin, outlines=all_of(mended.outlines)
        )
    raw = _part_panels(found, how) if how.way is None else _cut_panels(found, how, drawn)
    return replace(raw, origin=found.origin)


def all_of(outlines: Sequence[Outline | None]) -> tuple[Outline, ...] | None:
    """The outlines, if there are all of them."""
    found = tuple(outline for outline in outlines if outline is not None)
    return found if len(found) == len(outlines) else None


def _part_panels(model: Model, settings: ReferenceSettings) -> RawReference:
    """The parts of a model as panels, each with those of its faces that are chosen."""
    names = model.panel_names()
    if settings.faces is None:
        require_faces(model)
        shapes = [NamedShape(name, part.shape) for name, part in zip(names, model.parts, strict=True) if name]
        curves = sum(not part.face_labels and not part.unreadable for part in model.parts)
        many = "1 loose curve, which is no panel" if curves == 1 else f"{curves} loose curves, which are no panels"
        notes = [f"'{model.source}' holds {many}."] if curves else []
        whole = mended_products(shapes, model.source, settings.seam_tolerance)
        notes += whole.notes(model.source, settings.seam_tolerance)
        return RawReference(panels=whole.panels, notes=(*model.notes, *notes), outlines=all_of(whole.outlines))
    chosen, mended = skin_faces(
        select_faces(model, settings.faces), model.source, settings.seam_tolerance, chosen=settings.faces is not None
    )
    parts = sorted({face.source.part for face in chosen})
    shapes = [
        NamedShape(names[part], compound_of(face.source.face for face in chosen if face.source.part == part))
        for part in parts
    ]
    require_reach([face.samples for face in chosen], model.source)
    panels = _sampled(shapes, model.source)
    gaps = gap_notes(panels, model.source, settings.seam_tolerance)
    return RawReference(panels=panels, notes=(*model.notes, *mended, *gaps))


def _cut_panels(model: Model, settings: ReferenceSettings, drawn: Drawn | None) -> RawReference:
    """The chosen faces of a model, cut into panels."""
    skin, mended = skin_faces(
        select_faces(model, settings.faces), model.source, settings.seam_tolerance, chosen=settings.faces is not None
    )
    require_reach([face.samples for face in skin], model.source)
    left_out = (settings.faces and _names_left_out(model, [face.number for face in skin])) or None
    surfaces, gaps = surfaces_of(skin, model.source, settings.seam_tolerance, left_out=left_out)
    cut = cut_surfaces(model, surfaces, settings, drawn)
    shapes = [NamedShape(panel.name, compound_of(panel.faces)) for panel in cut.panels]
    notes = dict.fromkeys((*model.notes, *mended, *gaps, *cut.notes))  # of several surfaces the same may be said
    return RawReference(panels=_sampled(shapes, model.source), notes=tuple(notes))


def _names_left_out(model: Model, skin: Collection[int]) -> list[str]:
    """The names of all other faces of a model than those of such numbers."""
    return [face.label.name for face in model.faces() if face.number not in skin]


def require_reach(faces: Sequence[FaceSamples], source: str) -> None:
    """Refuse a skin so large, or so far away, that no panel of it could be built.

    Raises:
        ReferenceFileError: saying how far it reaches.
    """
    reach = max((float(norm(edge).max()) for face in faces for edge in (face.points, *face.edges)), default=0.0)
    if reach > LARGEST_COORDINATE:
        raise ReferenceFileError(
            f"The skin in '{source}' reaches {reach:.3g} mm from the middle of the model, and panels can be built "
            f"within {LARGEST_COORDINATE:g} mm: look for a wrong unit, or choose faces that lie closer together."
        )


def mended_products(products: Sequence[NamedShape], source: str, tolerance: float) -> Mended:
    """Sample panels as a file has them, and mend what can be.

    Raises:
        ReferenceFileError: they hold no faces, or reach too far.
        PanelError: one is a solid, holds no face, or holds one that cannot be sampled.
    """
    panels = _sampled(products, source)
    require_reach([face for panel in panels for face in panel.faces], source)
    return mend_panels(panels, [product.shape for product in products], source, tolerance)


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
