"""Tests that inject faults, and their expected results; table.py lists them."""
