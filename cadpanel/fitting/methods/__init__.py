"""The methods that fit panels, one a file."""
