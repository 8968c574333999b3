"""Pixels of masks as bits of 64-bit words: rotation, overlap, connected pieces, carving (removal of pixels)."""
