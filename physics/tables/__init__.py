"""Tables of a world: NumPy dtypes of their rows, each field with its unit."""
