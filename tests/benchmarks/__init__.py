"""Comparisons as commands; not tests, and nothing here asserts a time."""
