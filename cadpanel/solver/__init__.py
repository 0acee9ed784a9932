"""Least squares on sparse blocks, with bounds and with vectors held within distances; knows nothing of panels.

blocks (who is coupled with whom, and how their normal equations are factorised) -> levenberg_marquardt (each connected
component with its own damping) -> tolerance_weights, constrained (vectors within tolerances instead of weights).

Panels in a strip give a block-tridiagonal matrix, grids a sparse one; both are factorised directly, so a strip's time
grows in proportion to its panels.
"""
