"""Panels in build123d: named children, a stiffener pocket in one of them, and mass and centre of gravity of all.

python examples/build123d_interop.py [REFERENCE.step] [OUT]
"""

import sys
from pathlib import Path

import build123d as bd

import cadpanel as cp

source = Path(sys.argv[1] if len(sys.argv) > 1 else "fixtures/kai_tak_nw.step")
out = Path(sys.argv[2] if len(sys.argv) > 2 else "build/example_build123d")
out.mkdir(parents=True, exist_ok=True)

ALUMINIUM = 2.7e-6  # kg/mm3

result = cp.fit(cp.read(source))

# A Compound with one child a panel, under the panel's name.
facade = cp.to_build123d(result, thickness=3.0)
for panel in facade.children:
    cones = panel.faces().filter_by(bd.GeomType.CONE)
    centre = panel.center(bd.CenterOf.MASS)
    print(
        f"{panel.label}: {panel.volume * ALUMINIUM:.1f} kg, {len(cones)} conical faces, "
        f"hangs at ({centre.X:.0f}, {centre.Y:.0f}, {centre.Z:.0f})"
    )

# One panel is a Part, ready for build123d's own operations: here a slot of 300 x 40 mm in its first flange.
shape = result.shapes[0]
assert isinstance(shape, cp.PanelShape)  # a chain of patches; flat panels with other than four corners are none
part = cp.to_build123d(shape, thickness=3.0)
corners = shape.corners()[:, :2].reshape(-1, 3)
flange = bd.Plane(origin=tuple(corners.mean(axis=0)), x_dir=tuple(shape.directions[0]), z_dir=tuple(shape.normals[0]))
slotted = part - flange * bd.Box(300.0, 40.0, 20.0)
print(f"{part.label}: the slot took away {part.volume - slotted.volume:.0f} mm3")
bd.export_step(slotted, str(out / f"{shape.name}_slotted.step"))
