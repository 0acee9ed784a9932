"""From a reference to fitted panels: local, two-stage and concurrent."""
