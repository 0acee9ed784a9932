"""Curves that are drawn near a surface, and how they come onto it."""
