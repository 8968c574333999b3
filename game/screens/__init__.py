"""What is looked at one at a time: title, menus, play, replays, and the stack that leads from one to the next."""
