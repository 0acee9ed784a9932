"""The files of a delivery, one kind a file."""
