"""Kinds of joints, as dataclasses with the arguments of World.add_joint."""
