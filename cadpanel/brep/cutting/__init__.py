"""The ways to cut a surface into panels, one a file."""
