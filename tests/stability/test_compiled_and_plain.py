"""Compiled kernels and plain Python give identical digests after every step of one scene with many bodies."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from physics import JIT

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = """
import sys
import numpy as np
from physics import *
from physics import JIT
kind, steps = sys.argv[1], int(sys.argv[2])
rng = np.random.default_rng(5)
effects = Effects(response=True, gravity=True, drag=True, rotation=True, friction=True, restitution=True,
                  continuous=True, sensors=True, one_way=True) if kind != "detection" else Effects(rotation=True)
strategy = {"hash": SpatialHashGrid, "tree": DynamicTree, "sweep": SweepAndPrune}.get(sys.argv[3], BruteForce)
world = World(effects, strategy(), "blocking" if kind == "blocking" else None,
              drag=0.2 if effects.drag else 0.0)
slopes = np.zeros((2, 16, 2)); slopes[0, 4] = (0, 1); slopes[0, 5] = (1, .5); slopes[0, 6] = (.5, 0)
solid = np.zeros((2, 16), bool); solid[1] = True
one_way = np.zeros((2, 16), bool); one_way[0, 10:12] = effects.one_way
world.add_body(TileGrid(solid, 16, one_way=one_way, slopes=slopes), position=(0, 90), kind="static")
masks = [PixelMask(rng.random((h, w)) < 0.7) for w, h in ((9, 7), (33, 5), (12, 12))]
for k in range(21):
    shape = (Circle(5.0, (1, 0)), Polygon.box(9, 6), masks[k % 3], Bounds(Polygon.box(6, 6)))[k % 4]
    world.add_body(shape, position=tuple(rng.uniform(10, 240, 2) * (1, .35)), velocity=tuple(rng.normal(0, 500, 2)),
                   angle=float(rng.uniform(0, 6)), angular_velocity=float(rng.normal(0, 3)),
                   sensor=kind != "detection" and k % 8 == 0, material=Material(restitution=.5, friction=.4))
hero = Character(world, Polygon.box(8, 12), (40, 60)) if kind != "detection" else None
for step in range(steps):
    if hero: hero.move(.8, 1.9)
    world.step()
    hit = world.ray_cast((-10, 40 + step), (300, 7))
    print(world.digest(), hit and (hit.shape, hit.fraction.hex()), len(world.events.begin))
print("JIT" if JIT else "plain", file=sys.stderr)
"""

PILE = """
import sys
import numpy as np
from physics import *
from physics import JIT
solver, substeps = sys.argv[1], sys.argv[2]
rng = np.random.default_rng(7)
effects = Effects(response=True, stacking=True, gravity=True, drag=True, rotation=True, friction=True,
                  restitution=True, conveyor=True)
world = World(effects, solver=solver, gravity=(0, 10), pixels_per_meter=1.0, drag=0.1,
              substeps=substeps if substeps == "auto" else int(substeps))
world.add_body(Polygon.box(60, 1), position=(0, .5), kind="static", material=Material(friction=.6, surface_speed=.3))
world.add_body(Polygon.box(2, .4), position=(-8, -.3), kind="kinematic", velocity=(.5, 0), angular_velocity=.2)
plank = world.add_body(Polygon.box(30, .4), position=(0, -.3), material=Material(friction=.5))
for k in range(75):  # more than there are colours: some contacts of the plank have none
    world.add_body(Polygon.box(.3, .3), position=(-14.5 + .39 * k, -.64), material=Material(friction=.5))
for k in range(24):
    shape = (Circle(.3), Polygon.box(.6, .4), Polygon([(-.3, -.2), (.4, -.2), (0, .4)], radius=.05))[k % 3]
    world.add_body(shape, position=tuple(rng.uniform(-3, 3, 2) - (0, 4)), angle=float(rng.uniform(0, 3)),
                   material=Material(friction=float(k % 2), restitution=.4 * (k % 3), rolling_resistance=.02))
for step in range(30):
    world.step()
    print(world.digest(), len(world.contacts))
print("JIT" if JIT else "plain", file=sys.stderr)
"""


def run(kind, broadphase, plain):
    return output_of(plain, SCRIPT, kind, "40", broadphase)


def output_of(plain, script, *words):
    """Run a script in a separate process and return the lines that it prints. plain: True disables the compiler."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_DISABLE_JIT": "1" if plain else "0"}
    found = subprocess.run(
        [sys.executable, "-c", script, *words], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300
    )
    assert found.returncode == 0, found.stderr
    assert found.stderr.strip().splitlines()[-1] == ("plain" if plain else "JIT")
    return found.stdout.splitlines()


@pytest.mark.skipif(not JIT, reason="nothing to compare with")
@pytest.mark.parametrize("kind, broadphase", [("response", "hash"), ("blocking", "tree"), ("detection", "sweep")])
def test_compiled_and_plain_runs_give_the_same_bits(kind, broadphase):
    compiled, plain = run(kind, broadphase, False), run(kind, broadphase, True)
    assert len(compiled) == 40 and compiled == plain


@pytest.mark.skipif(not JIT, reason="nothing to compare with")
@pytest.mark.parametrize("solver, substeps", [("soft_step", "4"), ("soft_step", "auto"), ("sequential_impulse", "1")])
def test_piles_compiled_in_lanes_are_those_of_one_row_after_the_other(solver, substeps):
    compiled, plain = output_of(False, PILE, solver, substeps), output_of(True, PILE, solver, substeps)
    assert len(compiled) == 30 and int(compiled[-1].split()[-1]) > 150
    assert compiled == plain
