"""Faces as arrays: their patches, borders, areas, samples and closest points."""
