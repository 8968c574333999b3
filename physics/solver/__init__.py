"""Solvers: from contacts to impulses, velocities and poses."""
