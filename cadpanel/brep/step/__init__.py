"""The STEP files that leave the house, written as text."""
