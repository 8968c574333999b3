"""The physics from outside: public names only."""
