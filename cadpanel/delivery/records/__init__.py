"""What a delivery says of itself in numbers: the report, the comparison, and how they are made and checked."""
