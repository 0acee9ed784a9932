"""Atomic fits: the plane, the cylinder or the cone nearest to given samples, by orthogonal least squares.

clouds (samples made ready) -> flat_starts, axis_starts (where to begin) -> orthogonal (one minimum from one start)
-> race (the best minimum of all starts) -> result. Many sets of samples at once; a single set is a batch of one.
"""
