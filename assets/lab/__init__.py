"""Bodies of the lab's scenes."""
