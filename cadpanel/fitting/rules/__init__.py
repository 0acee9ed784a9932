"""Rules for single panels and seams: what is asked of them beyond what counts for all.

A rule is asked for by names (`rule.Rule`), and posed for the panels of one reference (`rule.Posed`): what it holds in
the fit, what it makes of the radii afterwards, and what was measured of it. A new rule is one file and one line in
`catalogue`.

Rules on radii are held twice. First panels that are to be alike are held together while everything is solved, so that
their common radius is the best one. Then it is fixed at one value (the best, or the nearest tool), and all the rest is
solved again: equal is equal to the last digit, and not to within a tolerance.
"""
