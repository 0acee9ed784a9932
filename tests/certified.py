"""A small delivery of three cylinders in a row, and what its certificate is to find."""

from __future__ import annotations

from dataclasses import replace

from cadpanel.brep.building.sheet import build_skin, build_solid
from cadpanel.brep.proof.certificate import certify
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam, PatchKind
from cadpanel.brep.step.file import write_step
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.volume import sheet_volume
from tests.shapes import folded_panel, moved

THICKNESS = 3.0
GAP = 0.25
SEAMS = [ExpectedSeam(panels=(f"P{i}", f"P{i + 1}"), edges=("end 1", "end 0"), gap=GAP) for i in range(2)]


def expected(shape: PanelShape | PolygonShape) -> ExpectedPanel:
    built = shape.straightened().shape
    kinds: list[PatchKind] = [
        "plane" if not isinstance(patch, ConePatch) else "cone" if patch.half_angle else "cylinder"
        for patch in built.patches
    ]
    volume = sheet_volume(built, THICKNESS)
    return ExpectedPanel(name=shape.name, volume=volume, kinds=tuple(kinds), corners=built.corners())


def strip() -> list[PanelShape]:
    """Three cylindrical panels in a row, a quarter of a millimetre apart."""
    return [replace(moved(folded_panel(), (i * (1000.0 + GAP), 0.0, 0.0)), name=f"P{i}") for i in range(3)]


class Delivery:
    def __init__(self, folder, shapes):
        self.panels_step, self.skins_step = folder / "panels.step", folder / "skins.step"
        self.expected = [expected(shape) for shape in shapes]
        self.solids = {shape.name: build_solid(shape, THICKNESS) for shape in shapes}
        self.skins = {shape.name: build_skin(shape) for shape in shapes}
        self.write()

    def write(self):
        for path, shapes in ((self.panels_step, self.solids), (self.skins_step, self.skins)):
            write_step(path, [(name, shape, None) for name, shape in shapes.items()], title=path.stem)

    def certify(self, seams=SEAMS, helper=None):
        return certify(self.panels_step, self.skins_step, self.expected, seams, helper)
