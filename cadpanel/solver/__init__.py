"""Least squares on sparse blocks, with bounds and with vectors held within distances; knows nothing of panels.

blocks (who is coupled with whom, and how their normal equations are factorised: as a band, or by dissection and
multifrontal), bounds (steps within them)
-> levenberg_marquardt (each connected component with its own damping)
-> central_path, barrier, interior_point (vectors within distances instead of weights; `hold` says which)
-> giving_way (who gives way, and by how much, where not everything can be held).

Panels in a strip give a block-tridiagonal matrix, grids a sparse one; both are factorised directly, so a strip's time
grows in proportion to its panels.
"""
