"""Islands: the constraint graph, the lists of awake rows, sleeping and waking."""
