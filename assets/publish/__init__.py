"""Pictures of the finished work: the pictures of the menu and of docs/."""
