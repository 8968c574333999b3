"""The stability study: scenes, engines, measures and limits, in a table that a benchmark prints and tests check.

scene.py defines a scene; stacks.py, structures.py and motions.py build scenes; engines.py simulates one in Hitbox or
pymunk; recording.py stores its poses; overlap.py, measures.py and toppling.py compute figures; rows.py is the table;
verdict.py compares an engine with a row. `python -m tests.bench stability` prints the results.
"""
