"""Random programs that use the public API; each is a list of lines of Python, which are printed if it fails.

`python -m tests.fuzz --minutes N [--seed S] [--workers N]`. writing.py writes lines. running.py runs them and checks
the world by invariants.py. shrinking.py shortens a failing program as far as possible.
"""
