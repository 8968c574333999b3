"""Random programs that use the public API; each is a list of lines of Python, which are printed if it fails.

`python -m tests.fuzz --minutes N [--seed S] [--workers N] [--effect E]`. writing.py and joint_lines.py write lines.
running.py runs them and checks the world by invariants.py and joint_invariants.py. shrinking.py shortens a failing
program as far as possible.
"""
