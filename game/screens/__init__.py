"""Screens: title, menus, play and replays, and the stack that switches between them."""
