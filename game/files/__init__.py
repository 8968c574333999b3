"""What a player keeps: settings, scores, recordings and best runs, and the folder they are in."""
