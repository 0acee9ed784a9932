"""Delivered skins unfolded by FreeCAD's flatmesh, which knows nothing of cones: our flat patterns, within its error."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cadpanel.arrays import Array, IntArray
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.outputs.step_files import SKINS
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import read_report
from cadpanel.delivery.records.to_shape import recorded_shape
from cadpanel.delivery.settings import SheetSettings
from cadpanel.geometry.flat_sizes import flat_sizes
from cadpanel.geometry.polyline import distances_to_polylines
from cadpanel.geometry.unroll import unroll
from tests.delivered import fitted
from tests.freecad.program import run_in_freecad
from tests.thorough import thorough

pytestmark = [pytest.mark.freecad, thorough]
# Edges of triangles are as long in the plane to so many mm: flatmesh's own error, which adds up across a panel.
STRAIN, SUM_OF_STRAINS = 1e-3, 0.02
AREA = 3e-5  # relative; what a mesh with chords of 0.05 mm cuts off the cone


def unfolded(skins: Path) -> list[tuple[Array, Array, IntArray]]:
    """Of every shell of a file its nodes in space and in the plane, and the triangles between them."""
    given = {"CADPANEL_STEP_FILE": str(skins)}
    found = run_in_freecad("unfolder_driver.py", given, timeout=240.0)
    return [
        (np.array(shell["nodes"]), np.array(shell["flat"]), np.array(shell["triangles"])) for shell in found["shells"]
    ]


def laid_on(points: Array, others: Array) -> tuple[Array, Array, Array]:
    """The turn (2, 2), maybe over, and the two middles by which points (m, 2) come closest to others."""
    middles = points.mean(axis=0), others.mean(axis=0)
    left, _, right = np.linalg.svd((points - middles[0]).T @ (others - middles[1]))
    return left @ right, *middles


def test_flatmesh_unfolds_delivered_skins_to_our_flat_patterns(tmp_path: Path) -> None:
    deliver(fitted(), tmp_path / "out", SheetSettings(ends="square"))
    report = read_report(tmp_path / "out" / REPORT)
    shells = unfolded(tmp_path / "out" / SKINS)
    assert len(shells) == len(report.panels)
    for panel, (nodes, flat, triangles) in zip(report.panels, shells, strict=True):
        shape = recorded_shape(panel, -3.0, square=True)
        pattern = unroll(shape)
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        lengths = [np.linalg.norm(of[edges[:, 0]] - of[edges[:, 1]], axis=-1) for of in (nodes, flat)]
        assert np.abs(lengths[0] - lengths[1]).max() < STRAIN
        # The corners tell where the one lies on the other; then every node of the outline must lie on ours.
        points = np.concatenate([shape.corners()[0], shape.corners()[1, ::-1]])
        corners = np.linalg.norm(nodes[:, None] - points, axis=-1)
        assert corners.min(axis=0).max() < 1e-6
        own = pattern.curves.start
        turn, middle, other = laid_on(flat[corners.argmin(axis=0)], own)
        placed = (flat - middle) @ turn + other
        assert np.abs(placed[corners.argmin(axis=0)] - own).max() < SUM_OF_STRAINS
        pairs, counts = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
        border = placed[np.unique(pairs[counts == 1])]
        outline = pattern.curves.points(np.broadcast_to(np.linspace(0.0, 1.0, 257), (len(own), 257)))
        off = np.min([distances_to_polylines(border[None], line[None])[0] for line in outline], axis=0)
        assert off.max() < SUM_OF_STRAINS
        sides = placed[triangles[:, 1:]] - placed[triangles[:, :1]]
        area = 0.5 * np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]).sum()
        assert area == pytest.approx(flat_sizes([pattern])[0].area, rel=AREA)
