"""Terms that hold single panels to rules: near to points, alike in radius, or each other's mirror image."""
