"""The Python API from start to end: read a reference, fit it, look at the numbers, take a solid, deliver.

python examples/api_start_to_end.py [REFERENCE.step] [OUT]
"""

import sys
from pathlib import Path

import numpy as np

import cadpanel as cp

source = Path(sys.argv[1] if len(sys.argv) > 1 else "fixtures/kai_tak_nw.step")
out = Path(sys.argv[2] if len(sys.argv) > 2 else "build/example_api")

# Each product in the file is one panel; which panels meet is found by their geometry.
reference = cp.read(source)
print(f"{len(reference.panels)} panels, {len(reference.seams)} seams")

# The smallest deviation at which no gap is wider than 2 mm. Other settings: see cp.FitSettings.
result = cp.fit(reference, gap_tolerance=2.0)
if not result.tolerance_met:
    print(result.shortfall())

# Measures are arrays over panels and seams, in the order of the reference; millimetres and radians.
measures = result.measures
for seam, gaps, kink in zip(reference.seams, measures.corner_gaps, measures.kink, strict=True):
    first, second = (reference.panels[i].name for i in seam.panels)
    print(f"{first} - {second}: corner gaps {np.round(gaps, 3)} mm, kink {np.degrees(kink):.2f} degrees")
print(f"RMS deviation {measures.overall_rms:.2f} mm; each panel alone would have {result.local.overall_rms:.2f} mm")

# A panel is rulings with patches between them, cut by a plane at either end.
panel = result.shapes[0]
cone = next(patch for patch in panel.patches if isinstance(patch, cp.ConePatch))
print(f"{panel.name}: radius {cone.radius:.1f} mm, half angle {np.degrees(cone.half_angle):.3f} degrees")
print(f"corners, mm:\n{np.round(panel.corners(), 1)}")

# One sheet as the kernel's own shape (OCP.TopoDS.TopoDS_Solid), if that is all you want.
solid = cp.build_solid(panel, 3.0)
print(f"{panel.name} is a {type(solid).__name__}")

# All sheets, all skins and the report, with the proof that the files hold what they promise.
report = cp.deliver(result, out, thickness=3.0, overwrite=True)
print(f"{report.certificate.solids} solids in '{out}', tangent to {report.certificate.max_tangency_error:.1e} rad")
assert cp.verify(out).holds
