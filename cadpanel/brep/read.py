"""From a STEP file to the reference: which panels there are, what to approximate, and who meets whom."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer

from cadpanel.brep.file_check import check_step_file
from cadpanel.brep.products import NamedShape, read_products
from cadpanel.brep.sampling import sample_faces
from cadpanel.errors import PanelError, ReferenceFileError
from cadpanel.reference.assemble import SEAM_TOLERANCE, assemble
from cadpanel.reference.model import RawPanel, Reference


def read_reference(path: str | Path, seam_tolerance: float = SEAM_TOLERANCE) -> Reference:
    """Read a STEP file into panels with outlines and seams.

    Args:
        path: a STEP file in which each product is one panel's reference: a face, a shell, or a compound of faces.
        seam_tolerance: how far the ends of two panels that meet may lie apart, mm.

    Raises:
        ReferenceFileError: the file cannot be read, or does not hold panels.
        PanelError: one of the panels is none.
        SettingsError: the tolerance is no positive length.
    """
    path = Path(path)
    return assemble(read_raw_panels(path), source=path.name, seam_tolerance=seam_tolerance)


def read_raw_panels(path: str | Path) -> tuple[RawPanel, ...]:
    """Read a STEP file into sampled faces, panel by panel, in file order and millimetres.

    Panels without a name are called "panel 1", "panel 2" by their place in the file; of several products with one name
    the second becomes "name (2)", and so on.

    Raises:
        ReferenceFileError: the file cannot be read, or holds no faces.
        PanelError: a product is a solid, holds no face, or holds one that cannot be sampled.
    """
    path = Path(path)
    check_step_file(path)
    products = read_products(path)
    names = unique_names([product.name for product in products])
    panels = tuple(_sample(name, product, path.name) for name, product in zip(names, products, strict=True))
    if not any(panel.faces for panel in panels):
        raise ReferenceFileError(
            f"'{path.name}' holds no faces, only curves, points or nothing: "
            "export the faces of the skin, one product a panel."
        )
    for panel in panels:
        if not panel.faces:
            raise PanelError(panel.name, f"in '{path.name}', it holds no face: take it out of the export.")
    return panels


def unique_names(names: Sequence[str]) -> list[str]:
    """Name the nameless by their place, and number what has the same name."""
    given = [name or f"panel {place}" for place, name in enumerate(names, start=1)]
    taken = set(given)
    seen: set[str] = set()
    unique = []
    for name in given:
        candidate, number = name, 1
        while candidate in seen or (number > 1 and candidate in taken):
            number += 1
            candidate = f"{name} ({number})"
        seen.add(candidate)
        unique.append(candidate)
    return unique


def _sample(name: str, product: NamedShape, source: str) -> RawPanel:
    """Sample one panel's faces, or say why it has none that can be sampled."""
    if TopExp_Explorer(product.shape, TopAbs_SOLID).More():
        raise PanelError(name, f"in '{source}', it is a solid: export only the faces of its skin, not the solid.")
    try:
        faces = sample_faces(product.shape)
    except Standard_Failure as error:
        raise PanelError(
            name, f"in '{source}', the CAD kernel cannot evaluate its faces ({error}): repair them and export again."
        ) from error
    for face in faces:
        arrays = (face.points, face.normals, face.weights, *face.edges, *face.edge_normals)
        if not all(np.isfinite(array).all() for array in arrays):
            raise PanelError(
                name, f"in '{source}', it has points that are not numbers: repair its faces and export again."
            )
    return RawPanel(name=name, faces=faces)
