"""Whether panels that were read cover what they were cut from."""

import pytest

from cadpanel.brep.splitting.splitter import area_of

LOST = 1e-3  # part of the area to which a panel's samples weigh it


def weight(panel):
    return sum(face.weights.sum() for face in panel.faces)


def assert_covers(panels, faces):
    assert sum(map(weight, panels)) == pytest.approx(sum(map(area_of, faces)), rel=LOST)
    assert len({panel.name for panel in panels}) == len(panels)
