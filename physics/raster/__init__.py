"""Pixels as 64-bit words: bits, turning, overlap."""
