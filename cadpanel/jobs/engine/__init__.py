"""Where tasks are worked off: in this process, or by the workers of a cluster."""
