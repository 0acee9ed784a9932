"""Where every panel's fit begins, told by the reference alone."""
