"""The tables of a world: dtypes, each field with its unit."""
