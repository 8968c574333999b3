"""Pictures of the finished work: the menu's, and those of docs/."""
