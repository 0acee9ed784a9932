"""What a panel must keep to whatever it costs, one limit a file."""
