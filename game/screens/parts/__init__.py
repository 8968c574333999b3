"""Parts of screens: lists of rows, the panel, lines of text, cards and backgrounds."""
