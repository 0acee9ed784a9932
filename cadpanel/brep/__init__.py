"""The only place that imports the CAD kernel: reading, cutting, building, writing STEP, and reading back.

Downwards from what other layers call: read and survey (what a file holds), server (the same in the second interpreter)
-> cutting, one way a file -> curves -> skin -> files, one format a file, and splitting -> faces, building -> kernel and
isolation. proof reads a delivery back.

What the kernel is known to do, and what is done about it here:

- its offsets and sewing leave splines, and tolerances of 1e-4 mm: topology is built directly instead, vertex by vertex,
  with parameter curves within 1e-11 mm;
- `BRepCheck_Analyzer` in its default mode passes parameter curves that are off by 8e-5 mm: the exact mode is used;
- a cone is given by its place and radius AT THE PANEL, never at its apex;
- at map-grid coordinates its checks fail: models are moved near the origin first;
- its splitter drops and leaves faces without a word: what was cut is counted, and areas are added up;
- it crashes, or never ends, over damaged files: reading and cutting run in a second interpreter (isolation).
"""
