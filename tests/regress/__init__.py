"""Regression tests, one file for each defect that was found, named after the correct behaviour."""
