"""Many fits of one reference, held against each other."""
