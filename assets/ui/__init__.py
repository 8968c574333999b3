"""The logo, window frames, icons and fonts."""
