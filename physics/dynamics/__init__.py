"""How bodies move, what is awake, and what hangs together."""
