"""Sound effects, and music: harmony, notation, instruments, mixing."""
