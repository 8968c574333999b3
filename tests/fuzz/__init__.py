"""Random programs over the public API, each a list of lines of Python: what is run is what is printed when it fails.

`python -m tests.fuzz --minutes N [--seed S] [--workers N]`. writing.py writes lines, running.py runs them and looks at
the world with what invariants.py knows, shrinking.py makes a program that fails as short as it can be.
"""
