"""What a player keeps: settings, scores, ghosts, levels of their own, and the folder that all of it is in."""
