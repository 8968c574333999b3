"""Solvers, which compute impulses from contacts and joints, and update the velocities and poses of bodies."""
