"""From a reference to fitted panels.

settings -> start (where every panel's fit begins, from the turning of the reference's normals alone) -> problem (panels
in their own frames, terms, who is coupled with whom) -> methods, one a file:

- local: each panel alone;
- two_stage: the industry's way, panels fitted alone and then moved about;
- weighted: the paper's objective (3), squares of gap and deviation weighed against each other;
- concurrent: fit and gaps in one optimization, the smallest deviation at which all limits hold.

-> measures, one definition for every report, test and benchmark -> run (which also gives panels another feature where
that is asked for) -> result.

The problem is non-convex in general. With mitred cuts it behaved: on four lips, 8 shaken starts each, all reached the
same minimum. What remains at closed seams is a trade between deviation and drift along the strip, which nobody sees;
drift across free edges, which people see, has a limit of its own.
"""
