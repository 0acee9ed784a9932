"""cadpanel turns a free-form building skin into panels that a shop can make from flat sheet."""
