"""After a scene's warm-up no kernel is left to compile, so no player waits during a game.

Each scene runs in its own process, because another scene's kernels would hide those that this warm-up lacks.
"""

import json
import os
import subprocess
import sys

import pytest

import physics
from scenes import SCENES

FRAMES = {"lander": 3000}  # by when the first shells have burst
# What the bot does not live to see, by the scene's name.
MORE = {
    "shooter": """
from tests.scenes.shooter_stages import struck_down
for tier in scene_class.tiers:
    sky, _ = struck_down(tier=tier)
    for identity in sky.scene.wreckage.pieces:
        sky.scene.world.body(identity).move_to((60, 60))
    saucer = sky.enemy("saucer", 60, 60)
    sky.step(3)
    assert saucer.health < saucer.full, tier
""",
    "platformer": """
from tests.scenes.test_platformer_blasting import Cave
cave = Cave()
cave.blow()
cave.run("left", 60)
for piece in cave.scene.things.rubble:
    piece.body.move_to((cave.wall.left + 20.0, cave.floor - 20.0))
cave.run("", 30)
bridge = cave.scene.things.bridges[0]
cave.scene.things.crates[0].body.move_to((bridge.left + 64.0, bridge.top - 20.0))
cave.scene.hero.place((bridge.left + 30.0, bridge.top - 20.0))
cave.run("", 60)
""",
}
PLAY = """
import json, sys
from game.run.headless import start_dummy_display
start_dummy_display()
from game.run.sources import BotSource
from game.registry import Registry
from game.run.session import Session
from game.run.warmup import warm_up_scene
from physics import jit
from scenes import SCENES

def versions():
    return {f"{each.py_func.__module__}.{each.py_func.__qualname__}": len(each.signatures) for each in jit.registry}

scene_class = Registry(SCENES).scene_class(sys.argv[1])
warm_up_scene(scene_class)
session = Session(scene_class(1), BotSource())
before = versions()
for _ in range(int(sys.argv[2])):
    session.step()
exec(sys.argv[3])
print(json.dumps([name for name, count in versions().items() if count > before.get(name, 0)]))
"""


@pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
@pytest.mark.parametrize("name", SCENES)
def test_nothing_is_compiled_in_the_middle_of_a_game(name):
    run = subprocess.run(
        [sys.executable, "-c", PLAY, name, str(FRAMES.get(name, 400)), MORE.get(name, "")],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"},
    )
    late = json.loads(run.stdout.splitlines()[-1])
    assert not late, f"{name}: its warm-up leaves out {', '.join(late)}"


EVERYTHING = """
import json, sys
from game.run.headless import start_dummy_display
start_dummy_display()
from game.registry import Registry
from game.run.session import Session
from game.run.sources import BotSource
from physics import BROADPHASES
from physics.jit import kernels as totals
from scenes import SCENES

scene_class = Registry(SCENES).scene_class(sys.argv[1])
chosen = [{}]
chosen += [{"solver": name} for name in scene_class.valid_solvers()]
chosen += [{"broadphase": name} for name in BROADPHASES if scene_class.switches_broadphase]
chosen += [{"tier": name} for name in scene_class.tiers]
for settings in chosen:
    session = Session(scene_class(1, **settings), BotSource())
    for _ in range(40):
        session.step()
print(json.dumps([len(chosen), totals.compiled, totals.loaded]))
"""


@pytest.mark.nightly
@pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
@pytest.mark.parametrize("name", SCENES)
def test_a_second_process_compiles_nothing(name):
    """After one process has compiled the kernels, a second one compiles nothing.

    Both use every solver, tier and broad phase that the scene offers. They have different hash seeds, because the order
    of sets must not matter.
    """
    found = []
    for seed in ("3", "4"):
        run = subprocess.run(
            [sys.executable, "-c", EVERYTHING, name],
            capture_output=True,
            text=True,
            check=True,
            env={**os.environ, "SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy", "PYTHONHASHSEED": seed},
        )
        found.append(json.loads(run.stdout.splitlines()[-1]))
    settings, compiled, loaded = found[1]
    assert settings >= 1 and compiled == 0 and loaded > 0


@pytest.mark.nightly
@pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
@pytest.mark.parametrize("command", [["main.py", "--report", "FOLDER", "--quick"], ["-m", "tests.bench", "--quick"]])
def test_a_second_report_and_a_second_benchmark_compile_nothing(command, tmp_path):
    """A report or a benchmark that runs a second time compiles nothing in any process: the cache is unchanged."""
    from physics.jit.store import store

    pytest.importorskip("pymunk")  # both run it beside the physics
    kept = []
    for number in range(2):
        arguments = [each.replace("FOLDER", str(tmp_path / str(number))) for each in command]
        subprocess.run([sys.executable, *arguments], capture_output=True, check=True)
        kept.append({path.name for path in store().folder.glob("*.kernel")})
    assert kept[0] == kept[1] and kept[0]
