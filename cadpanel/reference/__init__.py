"""What is to be approximated: sampled faces, outlines and neighbours, as arrays only."""
