"""Screens: title, menus, play, replays, and the stack that leads from one to the next."""
