"""The schedule of a delivery: its rows, how they are written, and whether they are what the report's panels make."""
