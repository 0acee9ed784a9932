"""Developable surfaces between two curves, the rails. Lengths in mm, angles in radians; nothing here knows the kernel.

A ruling joins a(t) on one rail with b(s) on the other; r = b - a. The surface's normal at its two ends is a' x r and
b' x r. Where both are parallel along every ruling, the surface is developable; the angle between them is the warp:

    (a' x r) x (b' x r) = r det(a', b', r),    so that    sin warp = |r| det(a', b', r) / (|a' x r| |b' x r|).

So a surface without warp is a curve in the (t, s) plane on which det(a', b', r) = 0, both t and s rising. Its
derivatives need nothing but a'' and b'': det(a'', b', r) by t, and det(a', b'', r) by s.

`pairing` finds the best of all pairings of points of both rails, `settling` moves it onto det = 0, `pieces` turns it
into splines, `kinds` says where these are a plane, a cylinder or a cone, `flat` unrolls them.
"""
