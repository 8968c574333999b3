"""What goes wrong on purpose, and what it gets: see table.py."""
