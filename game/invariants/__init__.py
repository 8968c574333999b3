"""The invariants U1 to U11, which hold after every step of every world.

Their checks only read the tables of a world.
"""
