"""Parts of screens: lists of rows, the panel, lines, cards and backgrounds."""
