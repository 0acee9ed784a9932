"""An assembly on top of STEP files is read as what hangs in them, each in its place."""

import numpy as np
import pytest

from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.proof.inspection import inspect
from cadpanel.brep.step.file import read_step_shapes, write_assembly, write_step
from cadpanel.brep.step.part_files import PartFile
from cadpanel.errors import DeliveryError
from tests.shapes import random_panel

FAR = (8.3e8, -2.1e8, 1000.0)


@pytest.mark.parametrize("schema", ["AP242", "AP214"])
def test_parts_are_what_their_files_hold_where_they_are_placed(tmp_path, schema):
    parts = []
    for number, (name, placed) in enumerate((("north", (0.0, 0.0, 0.0)), ("south east", FAR))):
        folder = tmp_path / name
        folder.mkdir()
        solids = [(f"{name} {place}", build_solid(random_panel(2 * number + place), 3.0), None) for place in range(2)]
        write_step(folder / "panels.step", solids, title=name, schema=schema)
        parts.append(PartFile(name=name, path=f"{name}/panels.step", placed=placed))
    write_assembly(tmp_path / "building.step", parts, title="building", schema=schema)
    found = read_step_shapes(tmp_path / "building.step")
    alone = [shape for part in parts for shape in read_step_shapes(tmp_path / part.path)]
    assert [name for name, _ in found] == [name for name, _ in alone]
    for place, ((name, there), (_, here)) in enumerate(zip(found, alone, strict=True)):
        one, other = inspect(name, here), inspect(name, there)
        assert tuple(other.placed) == parts[place // 2].placed
        assert other.valid
        assert other.volume == one.volume
        assert np.array_equal(other.vertices, one.vertices)


def test_a_path_that_readers_do_not_find_is_refused(tmp_path):
    with pytest.raises(DeliveryError, match=r"building\.step cannot be written: 'Süd/panels\.step' has other letters"):
        write_assembly(tmp_path / "building.step", [PartFile(name="Süd", path="Süd/panels.step")], title="building")
    assert list(tmp_path.iterdir()) == []
