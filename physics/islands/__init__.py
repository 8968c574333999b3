"""Islands: constraint graph, lists of awake bodies, sleeping and waking."""
