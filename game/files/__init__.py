"""Files of the player: settings, scores, ghosts, own levels, and their folder."""
