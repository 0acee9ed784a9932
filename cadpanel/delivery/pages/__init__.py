"""Drawings on paper: one page a panel, and an overview."""
