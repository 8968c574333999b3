"""The lander: a ship over a moon. Both shapes are exact pixel masks, and shells carve craters into the moon."""
