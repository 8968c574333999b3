"""The kinds of joints."""
