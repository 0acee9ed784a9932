"""Which stretch of a panel becomes its bend: asked for by the user, and taken."""
