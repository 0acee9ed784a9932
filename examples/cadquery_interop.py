"""Panels in cadquery: drill a row of rivet holes along one flange, and export what comes out.

python examples/cadquery_interop.py [REFERENCE.step] [OUT]
"""

import sys
from pathlib import Path

import cadquery as cq

import cadpanel as cp

source = Path(sys.argv[1] if len(sys.argv) > 1 else "fixtures/kai_tak_nw.step")
out = Path(sys.argv[2] if len(sys.argv) > 2 else "build/example_cadquery")
out.mkdir(parents=True, exist_ok=True)

result = cp.fit(cp.read(source))

# All panels on one Workplane: selectors, .vals() and exporters work on them as on any other solids.
panels = cp.to_cadquery(result, thickness=3.0)
print(f"{panels.size()} solids, {panels.faces('%CONE').size()} conical faces")

# One panel: the first ruling is the long free edge of its first flange; holes go in 60 mm from it, every 200 mm.
shape = result.shapes[0]
assert isinstance(shape, cp.PanelShape)  # a chain of patches; flat panels with other than four corners are none
start, end = shape.corners()[:, 0]
inward = shape.binormals()[0]
normal = cq.Vector(*shape.normals[0].tolist())
panel = cp.to_cadquery(shape, thickness=3.0)
length = float(((end - start) ** 2).sum() ** 0.5)
stations = [(200.0 * i + 100.0) / length for i in range(int(length // 200.0))]
for station in stations:
    centre = cq.Vector(*(start + station * (end - start) + 60.0 * inward).tolist())
    drill = cq.Solid.makeCylinder(4.0, 20.0, centre - normal * 10.0, normal)
    panel = panel.cut(cq.Workplane(drill))

before, after = cp.to_cadquery(shape).val().Volume(), panel.val().Volume()
print(f"{shape.name}: {len(stations)} holes took away {before - after:.0f} mm3 of {before:.0f} mm3")
panel.export(str(out / f"{shape.name}_drilled.step"))
