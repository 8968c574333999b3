"""One test per defect that was found, named by what must hold."""
