"""The objective, one term a file."""
