"""Audio: sound effects and music, or silence without a device."""
