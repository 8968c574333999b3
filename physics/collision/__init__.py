"""Narrow phase: computes the contacts of the candidate pairs that the broad phase has found."""
