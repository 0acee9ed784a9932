"""The schedule of a delivery: its rows, how they are written."""
