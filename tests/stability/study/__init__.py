"""The stability study: scenes, engines, measures and limits, a table that a benchmark prints and tests can read.

scene.py says what a scene is; stacks.py, structures.py and motions.py build them; engines.py plays one in Hitbox or
in pymunk; recording.py keeps its poses; overlap.py, measures.py and toppling.py read figures off them; rows.py is the
table, verdict.py what an engine makes of a row. `python -m tests.bench stability` prints it all.
"""
