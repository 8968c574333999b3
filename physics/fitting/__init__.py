"""Simple shapes around pixels: arrays in, arrays out."""
