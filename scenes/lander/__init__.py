"""The lander: a ship over a moon. The shapes of both are exact pixel masks, and shells carve craters into the moon."""
