"""`python -m tests.run_scenes`: every scene from the command line; one digest whatever is changed around it.

Twice, under every broad phase, drawn and not, recorded and replayed, compiled and plain. `--plain` is for an
environment without numba: 120 frames of each scene and nothing else.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

ROOT = Path(__file__).resolve().parent.parent
LONG = {"shooter": 3600, "platformer": 3600}
FRAMES, SHORT = 600, 120
FEW = 100  # bodies without compiled kernels, where a scene lets one choose


def run(*arguments, plain=False):
    """main.py's JSON object. A failure of it is shown and ends this run."""
    environment = dict(os.environ, **({"NUMBA_DISABLE_JIT": "1"} if plain else {}))
    done = subprocess.run(
        [sys.executable, "main.py", "--headless", "--json", *map(str, arguments)],
        cwd=ROOT,
        text=True,
        capture_output=True,
        env=environment,
    )
    if done.returncode:
        sys.exit(f"main.py {' '.join(map(str, arguments))}\nexit {done.returncode}\n{done.stdout}\n{done.stderr}")
    return json.loads(done.stdout.splitlines()[-1])


def names():
    done = subprocess.run(
        [sys.executable, "main.py", "--list", "--json"], cwd=ROOT, text=True, capture_output=True, check=True
    )
    return [scene["name"] for scene in json.loads(done.stdout)]


def compare(name, what, found, wanted):
    if found["digest"] != wanted["digest"]:
        sys.exit(f"{name}: {what} gives digest {found['digest']}, not {wanted['digest']}")


def check_scene(name, folder):
    frames = LONG.get(name, FRAMES)
    base = ("--scene", name, "--seed", 1, "--bot", "--frames", frames)
    recording = folder / "recording.json"
    first = run(*base, "--record", recording)
    assert first["check"]["ok"], first["check"]
    compare(name, "a second run", run(*base), first)
    compare(name, "its recording", run("--scene", name, "--replay", recording, "--frames", frames), first)
    for strategy in ("brute", "sweep", "hash", "tree"):
        compare(name, f"broad phase {strategy}", run(*base, "--broadphase", strategy), first)
    drawn = run(*base, "--overlay", "all", "--strict")
    compare(name, "drawing with every overlay", drawn, first)
    short = ("--scene", name, "--seed", 1, "--bot", "--frames", SHORT // 2)
    compare(name, "running without compiled kernels", run(*short, plain=True), run(*short))
    print(
        f"{name:18} ok: {frames} frames, digest {first['digest']}, drawn frame p99 {drawn['frame_ms']['p99']:.1f} ms",
        flush=True,
    )


def run_plain(name):
    """120 frames of a scene in this process, with few bodies; returns a line for the log."""
    sys.path.insert(0, str(ROOT))
    from game.registry import Registry
    from game.run.headless import start_dummy_display
    from game.run.session import Session
    from game.run.sources import BotSource
    from scenes import SCENES

    start_dummy_display()
    scene = Registry(SCENES).scene_class(name)(seed=1)
    if "bodies" in scene.values:
        scene.change("slider:bodies", FEW)
    session = Session(scene, BotSource())
    started = perf_counter()
    for _ in range(SHORT):
        session.step()
    bodies = sum(len(world.bodies) for world in scene.worlds)
    return f"{name:18} ok: {SHORT} frames, {bodies} bodies at the end, {1e3 * (perf_counter() - started) / SHORT:.1f} ms a step"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plain", action="store_true", help="120 frames of each scene, once")
    options = parser.parse_args()
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    scenes = names()
    for name in scenes:
        if options.plain:
            print(run_plain(name), flush=True)
        else:
            with tempfile.TemporaryDirectory() as folder:
                check_scene(name, Path(folder))
    print(f"{len(scenes)} passed, 0 failed")


if __name__ == "__main__":
    main()
