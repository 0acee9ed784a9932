"""How a result is measured: gaps, deviations, drifts, and whether it keeps its limits."""
