"""The directions of a seam's width, step and shift."""

import numpy as np
import pytest

from cadpanel.geometry.seam_frames import SHIFT, STEP, WIDTH, seam_frames, tangents_at


def test_directions_are_square_to_each_other_and_of_unit_length():
    random = np.random.default_rng(1)
    frames = seam_frames(random.normal(size=(5, 4, 3)), random.normal(size=(5, 4, 3)))
    assert frames @ np.swapaxes(frames, -1, -2) == pytest.approx(np.broadcast_to(np.eye(3), frames.shape), abs=1e-12)


def test_the_step_goes_out_of_the_skin_and_the_shift_along_the_seam():
    (frame,) = seam_frames(np.array([[[0.0, 5.0, 0.3]]]), np.array([[[0.0, 0.0, 2.0]]]))[0]
    assert frame[STEP] == pytest.approx([0.0, 0.0, 1.0])
    assert frame[SHIFT] == pytest.approx([0.0, 1.0, 0.0])
    assert np.abs(frame[WIDTH]) == pytest.approx([1.0, 0.0, 0.0])


def test_turning_everything_turns_the_directions():
    random = np.random.default_rng(2)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    tangents, normals = random.normal(size=(2, 3, 2, 3))
    turned = seam_frames(tangents @ turn.T, normals @ turn.T)
    assert turned == pytest.approx(seam_frames(tangents, normals) @ turn.T, abs=1e-12)


def test_a_seam_that_bends_at_a_corner_goes_on_between_both_ways():
    corners = np.array([[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0]]])
    found = tangents_at(corners)
    assert found[0, 0] == pytest.approx([1.0, 0.0, 0.0])
    assert found[0, 1] == pytest.approx([1.0, 1.0, 0.0])
    assert found[0, 2] == pytest.approx([0.0, 1.0, 0.0])


def test_of_points_round_a_circle_the_directions_are_those_of_its_tangents():
    turns = np.linspace(0.0, 2.0, 9)
    (found,) = tangents_at(np.column_stack([np.cos(turns), np.sin(turns), 0.0 * turns])[None])
    ways = found / np.linalg.norm(found, axis=-1, keepdims=True)
    assert ways[1:-1] == pytest.approx(np.column_stack([-np.sin(turns), np.cos(turns), 0.0 * turns])[1:-1])
