"""The invariants U1 to U11, which must hold after every step of every world.

The checks of the invariants read a world's tables and do not change them.
"""
