"""Generator of docs/reference.md from docstrings, signatures and tables: `python -m tests.reference`; `--check`
compares.
"""
