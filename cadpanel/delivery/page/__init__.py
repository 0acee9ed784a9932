"""The page on which a delivery is looked at: what there is to see, and how it is written into one file."""
