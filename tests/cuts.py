"""Models cut into panels in memory, and what the panels must keep."""

from pathlib import Path

import numpy as np
import pytest
from OCP.TopAbs import TopAbs_FACE

from cadpanel.brep.cutting.ways import cut_surfaces, load_drawn
from cadpanel.brep.faces.sampling import sample_faces
from cadpanel.brep.files.face_choice import select_faces
from cadpanel.brep.files.model import Label, Model, Part
from cadpanel.brep.kernel.shapes import compound_of, shapes_of
from cadpanel.brep.read import read_reference
from cadpanel.brep.skin.adjacency import surfaces_of
from cadpanel.brep.skin.face_cleanup import skin_faces
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.reference.settings import ReferenceSettings
from tests.model_files import write_shape

EQUAL = 2e-3  # part by which panels of equal length may differ where they are measured along chords
LOST = 2e-5  # part of the area by which the panels may miss the surface: the kernel integrates no better


def model_of(*shapes, name="roof.step", names=()):
    labels = [Label(name=word) for word in names] or [Label()] * len(shapes)
    parts = tuple(
        Part(label=label, shape=shape, face_labels=(Label(),) * len(shapes_of(shape, TopAbs_FACE)))
        for label, shape in zip(labels, shapes, strict=True)
    )
    return Model(source=name, format="STEP", unit="millimetre", parts=parts)


def cut(model, **how):
    wanted = ReferenceSettings(**how)
    skin, mended = skin_faces(select_faces(model, wanted.faces), model.source, wanted.seam_tolerance)
    surfaces, gaps = surfaces_of(skin, model.source, wanted.seam_tolerance)
    done = cut_surfaces(model, surfaces, wanted, load_drawn(model, wanted, Path(model.source)))
    return done.panels, (*mended, *gaps, *done.notes)


def panels_of(model, **how):
    return cut(model, **how)[0]


def area(panels):
    return sum(area_of(face) for panel in panels for face in panel.faces)


def assert_covers(panels, faces):
    assert area(panels) == pytest.approx(sum(map(area_of, faces)), rel=LOST)
    assert len({panel.name for panel in panels}) == len(panels)


def reference_of(tmp_path, *faces, **how):
    return read_reference(write_shape(tmp_path / "skin.brep", compound_of(faces)), ReferenceSettings(unit="mm", **how))


def middle(panel):
    (samples, *others) = sample_faces(compound_of(panel.faces))
    points = np.concatenate([face.points for face in (samples, *others)])
    return points.mean(axis=0)


def surface_of(*faces, tolerance=1.0):
    """The one surface that faces make together, cleaned up as those of a file are."""
    skin, _ = skin_faces(select_faces(model_of(*faces), None), "roof.step", tolerance)
    (found,), _ = surfaces_of(skin, "roof.step", tolerance)
    return found
