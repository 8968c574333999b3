"""What walks by whole pixels: characters among solids, belts and lifts."""
