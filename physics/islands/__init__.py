"""Islands: the graph of bodies and constraints, what is awake, sleep."""
