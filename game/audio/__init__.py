"""Audio: sound effects and music. Without a sound device, the program is silent."""
