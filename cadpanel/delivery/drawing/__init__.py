"""Flat patterns as drawings: what is drawn of a panel, how it is marked, DXF as it is written and read back."""
