"""The file formats that a reference may come in, one a file; the catalogue lists them."""
