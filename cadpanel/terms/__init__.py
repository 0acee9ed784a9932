"""The objective, one term a file, and the limits that a panel keeps to whatever it costs, one a file in `limits`.

- deviation: distances of the reference's samples to the patch under them, weighted by area (the paper's regression);
- corner_gap, arc_gap, edge_gap: neighbours at their seams. Between corners an arc's points are held by their distances
  from the two surfaces whose intersection the other arc is, its cone and its cut plane;
- limits: drift of corners from the drawing, along the strip and across free edges; least radius; least flange width.

Minimising corner gaps alone lets flanges shrink or slide along the building until corners touch: gap 0.1 mm, corners
1.4 m from where they belong. So deviation, gap and drift are always held, and reported, together.

Lengths are counted in a panel's length inside, angles in radians; derivatives are exact (see `features` and
`geometry.frames`): a twist for each number, carried along the walk.
"""
