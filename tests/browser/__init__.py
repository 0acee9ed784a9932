"""The page of a delivery in a real browser."""
