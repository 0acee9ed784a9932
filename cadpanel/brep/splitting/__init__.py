"""Faces split by edges, curves or faces, with proof that nothing was lost."""
