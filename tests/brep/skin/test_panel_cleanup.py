"""Panels that a file brings ready-made are mended like faces that are to be cut, with notes that name the panel."""

import numpy as np
import pytest

from cadpanel.brep.files.model import Label
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_reference
from cadpanel.errors import PanelError
from tests.brep.files.test_dirty import creased_face
from tests.model_files import write_labelled
from tests.reference_shapes import kernel_face, kernel_lip, strip, write_products

LIPS = strip(3)


def hair_beside(lip, width):
    """A face along the last flange's free edge."""
    return kernel_face(lambda u, v: lip(3.0 + u * width / lip.flange, v), (0.0, 1.0))


def written(path, *panels):
    if path.suffix == ".step":
        return write_products(path, [(f"lip {place}", panel) for place, panel in enumerate(panels)])
    return write_labelled(path, [(Label(name=f"lip {place}"), panel, []) for place, panel in enumerate(panels)])


@pytest.mark.parametrize("name", ["skin.step", "skin.iges"])
def test_double_faces_and_hairs_of_products_are_left_out_with_a_note(tmp_path, name):
    clean = [kernel_lip(lip) for lip in LIPS]
    again = kernel_face(LIPS[1], (1.0, 2.0), poles=17)
    faces = [kernel_face(LIPS[1], (k, k + 1.0)) for k in (0.0, 1.0, 2.0)]
    dirty = compound_of([faces[0], again.Reversed(), faces[1], hair_beside(LIPS[1], 0.02), faces[2]])
    expected = read_reference(written(tmp_path / f"clean_{name}", *clean))
    found = read_reference(written(tmp_path / name, clean[0], dirty, clean[2]))
    assert expected.notes == ()
    assert found.notes == (
        f"Face 4 of panel 'lip 1' of '{name}' is only 0.02 mm wide and is left out.",
        f"Face 3 of panel 'lip 1' of '{name}' lies on its face 2 and is left out.",
    )
    assert found.seams == expected.seams
    for here, there in zip(expected.panels, found.panels, strict=True):
        np.testing.assert_allclose(here.corners, there.corners, atol=0.05)
        assert here.weights.sum() == pytest.approx(there.weights.sum(), rel=1e-4)


def test_what_many_panels_have_is_one_note(tmp_path):
    panels = [compound_of([*faces, faces[0].Reversed()]) for faces in map(faces_of, LIPS)]
    (note,) = read_reference(written(tmp_path / "skin.step", *panels)).notes
    assert note == (
        "Face 4 of panel 'lip 0' of 'skin.step' lies on its face 1 and is left out (the first of 3 such faces)."
    )


def faces_of(lip):
    return [kernel_face(lip, (k, k + 1.0)) for k in (0.0, 1.0, 2.0)]


@pytest.mark.parametrize(("angle", "told"), [(0.2, False), (5.0, True)])
def test_a_crease_inside_a_face_of_a_product_is_told(tmp_path, angle, told):
    notes = read_reference(written(tmp_path / "skin.step", creased_face(angle))).notes
    said = f"Face 1 of panel 'lip 0' of 'skin.step' has a crease of {angle:.3g} degrees inside"
    assert [note.startswith(said) for note in notes] == [True] * told


def test_a_panel_that_is_nothing_but_a_hair_is_refused_and_not_left_out(tmp_path):
    with pytest.raises(PanelError, match=r"Panel 'lip 1': in 'skin.step', face 1 of 1 (has no area|is only)"):
        read_reference(written(tmp_path / "skin.step", kernel_lip(LIPS[0]), hair_beside(LIPS[0], 0.02)))
