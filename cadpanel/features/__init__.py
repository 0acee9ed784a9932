"""Shape features as chains of rulings, and the catalogue of those that have a name."""
