"""Files of the player: settings, high scores, ghosts and own levels, and the folder that contains them."""
