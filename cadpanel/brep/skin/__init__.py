"""The faces chosen for cutting, as surfaces that hang together: strips, rings, lips, cross sections."""
