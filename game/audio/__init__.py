"""What is heard: sound effects and music, or silence where there is no device."""
