"""References as surfaces to look at: what has no area has no triangles, and still has its outline."""

from dataclasses import replace

import numpy as np

from cadpanel.delivery.page.ghosts import ghost, outline_of
from cadpanel.geometry.skin_mesh import skin_mesh
from tests.delivered import fitted, strip


def test_an_outline_goes_round_once_and_passes_each_corner_once():
    panel = strip().panels[0]
    outline = outline_of(panel)
    steps = np.linalg.norm(np.diff(outline, axis=0, append=outline[:1]), axis=1)
    assert steps.min() > 0.0
    assert steps.max() < 0.2 * panel.length
    for corner in panel.corners.reshape(-1, 3):
        assert np.linalg.norm(outline - corner, axis=1).min() == 0.0


def test_samples_on_one_line_make_no_surface():
    panel, mesh = strip().panels[0], skin_mesh(fitted().shapes[0])
    line = np.linspace(0.0, 1.0, 33)[:, None] * np.array([100.0, 0.0, 0.0])
    flat = replace(panel, points=line, edges=tuple(line for _ in panel.edges))
    one = replace(mesh, points=mesh.points[:1], chart=np.zeros((1, 2)), ways=np.array([[[1.0, 0, 0], [0, 1.0, 0]]]))
    assert len(ghost(flat, one).triangles) == 0
