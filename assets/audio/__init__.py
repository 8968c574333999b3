"""The sound effects, and the music: harmony, notation, instruments, mixing."""
