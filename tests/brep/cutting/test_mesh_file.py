"""Corners and faces from OBJ and OFF texts, as far as they are said, and refused where the text breaks off."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cadpanel.brep.cutting.mesh_file import corners_and_faces

number = st.floats(-1e6, 1e6)
corner = st.tuples(number, number, number)
meshes = st.lists(corner, min_size=3, max_size=8).flatmap(
    lambda corners: st.tuples(
        st.just(corners),
        st.lists(st.lists(st.integers(0, len(corners) - 1), min_size=3, max_size=5), min_size=1, max_size=5),
    )
)


def off(corners, faces, ending=""):
    rows = [" ".join(map(repr, one)) for one in corners]
    rows += [" ".join(map(str, (len(one), *one))) + ending for one in faces]
    return "\n".join(["OFF", f"{len(corners)} {len(faces)} 0", *rows])


@given(mesh=meshes, back=st.booleans(), normals=st.sampled_from(["", "/7", "//3", "/2/9"]))
def test_a_mesh_reads_back_from_either_format(mesh, back, normals):
    corners, faces = mesh
    wanted = [list(one) for one in corners], [tuple(one) for one in faces]
    assert corners_and_faces(off(corners, faces)) == wanted
    assert corners_and_faces(off(corners, faces, ending=" 255 0 0")) == wanted
    shift = -len(corners) if back else 1  # counted from the end, or from 1
    rows = ["v " + " ".join(map(repr, one)) for one in corners]
    rows += ["f " + " ".join(f"{k + shift}{normals}" for k in face) for face in faces]
    assert corners_and_faces("\n".join(["# a mesh", "vn 0 0 1", *rows, "usemtl steel"])) == wanted


def test_a_corner_that_is_not_there_keeps_an_index_out_of_range():
    _, (face,) = corners_and_faces("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 4\n")
    assert face == (0, 0, 3)
    _, (face,) = corners_and_faces("v 0 0 0\nf -2 1 1\n")
    assert face[0] < 0


def test_comments_and_lines_that_go_on_are_read_as_one():
    text = "v 0 0 0 # here \\\nv 1 0 0\nv 0 1 0\nf 1 \\\n 2 3\n"
    corners, faces = corners_and_faces(text)
    assert faces == [(0, 1, 2)]
    assert np.array(corners).tolist() == [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("OFF", "does not say how many"),
        ("OFF\n3", "does not say how many"),
        ("OFF\n2 1 0\n0 0 0\n1 0 0", "breaks off before its last"),
        ("OFF\n-1 0 0\n0 0 0", "breaks off"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2", "fewer corners than it says"),
        ("v 1 2\n", "fewer than three coordinates"),
        ("v 1 2 x\n", "could not convert"),
    ],
)
def test_a_text_that_breaks_off_is_refused(text, said):
    with pytest.raises(ValueError, match=said):
        corners_and_faces(text)
