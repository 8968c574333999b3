"""Kernels compile in processes of their own while a window is open: shared out, ended with the game, never headless."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import physics
from game.registry import Registry
from game.run import compilers as module
from game.run.compilers import Compilers, cores_here, jobs_of, start_worker
from game.run.kernel_work import try_claim
from game.run.warmup import pieces_of, worlds_of
from scenes import SCENES

ROOT = Path(__file__).resolve().parents[2]
jitted = pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")


def ended(process_id, seconds=20.0):
    """True as soon as there is no such process any more (a zombie counts as none)."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        try:
            state = Path(f"/proc/{process_id}/stat").read_text().rsplit(")", 1)[1].split()[0]
            if state == "Z":
                return True
        except OSError:
            return True
        time.sleep(0.05)
    return False


class Deaf:
    """A process that notes what it is told."""

    def __init__(self):
        self.told, self.alive = [], True
        self.stdin = self.stdout = self

    def __iter__(self):
        return iter(())

    def write(self, line):
        self.told.append(json.loads(line))

    def flush(self):
        pass

    close = flush

    def poll(self):
        return None if self.alive else 1

    def kill(self):
        self.alive = False

    def wait(self):
        return 1


@pytest.fixture
def pair(monkeypatch):
    """Compilers of two processes that do nothing, and these."""
    made = []
    monkeypatch.setattr(module, "start_worker", lambda: made.append(Deaf()) or made[-1])
    return Compilers(Registry({name: SCENES[name] for name in ("shooter", "lab/cradle")}), cores=2), made


def test_one_fewer_works_while_somebody_plays(pair):
    both, made = pair
    for plays, resting in ((False, 0), (True, 1), (True, 1), (False, 0)):
        both.turn(plays)
        assert sum(both.resting) == resting
    assert [order["rest"] for order in made[1].told if "rest" in order] == [True, False]
    assert not [order for order in made[0].told if "rest" in order]


def test_one_core_is_the_players(monkeypatch):
    made = []
    monkeypatch.setattr(module, "start_worker", lambda: made.append(Deaf()) or made[-1])
    one = Compilers(Registry(SCENES), cores=1)
    one.turn(True)
    assert made[0].told[0] == {"rest": True}


def test_what_is_chosen_is_the_first(pair):
    both, made = pair
    for _ in range(3):
        both.turn(True)
    scene_class = Registry(SCENES).scene_class("platformer")
    jobs = jobs_of(scene_class)
    both.first(jobs)
    for worker in made:
        assert [order["job"] for order in worker.told if order.get("first")] == json.loads(json.dumps(jobs))
        assert not next(order for order in worker.told if "job" in order)["first"]
    assert both.resting == [False, False], "behind the bar nobody plays"
    assert both.share(jobs) == 0.0
    key = json.dumps(jobs[0], sort_keys=True)
    both.progress[0, key] = (3, 12)
    assert both.share(jobs) == 0.25


def test_every_scene_is_asked_for_once(pair):
    both, made = pair
    for _ in range(9):
        both.turn(False)
    names = [order["job"]["effects"] for order in made[0].told if "job" in order]
    wanted = [Registry(SCENES).scene_class(name) for name in ("shooter", "lab/cradle")]
    assert names == [effects.names() for each in wanted for effects, _ in worlds_of(each)]
    assert made[0].told[0]["job"]["pieces"] == list(pieces_of(wanted[0]))


def test_where_nobody_is_left_the_foreground_does_it(pair):
    both, made = pair
    jobs = jobs_of(Registry(SCENES).scene_class("shooter"))
    for worker in made:
        worker.alive = False
    assert both.share(jobs) is None
    both.stop()
    assert both.share(jobs) is None and both.workers == []


def test_finished_work_ends_them_and_is_remembered(pair, monkeypatch, tmp_path):
    monkeypatch.setenv("HITBOX_CACHE_DIR", str(tmp_path))
    both, made = pair
    for _ in range(4):
        both.turn(False)
    for key in both.orders:
        both.progress[1, key] = (7, 7)
    both.turn(False)
    assert not any(worker.alive for worker in made)
    if physics.JIT:
        assert module.start_compilers(Registry(SCENES)) is None, "the next start needs none"


@jitted
@pytest.mark.parametrize("code", ["import physics", "import main; main.main(['--list'])"])
def test_none_is_started_without_a_window(code, tmp_path):
    watched = f"import subprocess, sys\nsubprocess.Popen = None\n{code}\nassert 'game.run.compilers' not in sys.modules"
    subprocess.run(
        [sys.executable, "-c", watched],
        cwd=ROOT,
        check=True,
        env={**os.environ, "HITBOX_CACHE_DIR": str(tmp_path)},
        stdout=subprocess.DEVNULL,
    )


def test_headless_runs_do_not_know_them():
    source = (ROOT / "game/run/headless.py").read_text()
    assert "compilers" not in source


@jitted
@pytest.mark.skipif(sys.platform != "linux", reason="looks at /proc")
def test_a_worker_ends_with_its_orders():
    worker = start_worker()
    assert worker is not None and not ended(worker.pid, 0.5)
    worker.stdin.close()
    assert worker.wait(30) == 0
    worker.stdout.close()


@jitted
@pytest.mark.skipif(sys.platform != "linux", reason="looks at /proc")
def test_workers_of_a_game_that_was_killed_end(tmp_path):
    game = (
        "import time; from game.registry import Registry; from game.run.compilers import Compilers; "
        "from scenes import SCENES; both = Compilers(Registry(SCENES), cores=2); both.turn(False); "
        "print(*(each.pid for each in both.workers), flush=True); time.sleep(600)"
    )
    program = subprocess.Popen(
        [sys.executable, "-c", game],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "HITBOX_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)},
    )
    line = ""
    while not line.strip() or not line.strip()[0].isdigit():
        line = program.stdout.readline()
    workers = [int(word) for word in line.split()]
    time.sleep(3.0)  # they are at work by now
    assert len(workers) == 2 and not any(ended(each, 0.1) for each in workers)
    program.send_signal(signal.SIGKILL)
    program.wait()
    program.stdout.close()
    assert all(ended(each) for each in workers)


@pytest.mark.skipif(sys.platform == "win32", reason="everybody has every claim there")
def test_only_one_process_is_at_a_kernel(tmp_path):
    path = str(tmp_path / "kernel.nbc")
    hold = (
        "import sys, time; from game.run.kernel_work import try_claim; kept = try_claim(sys.argv[1]); "
        "print(kept is not None, flush=True); time.sleep(600)"
    )
    other = subprocess.Popen(
        [sys.executable, "-c", hold, path], cwd=ROOT, stdout=subprocess.PIPE, text=True, env={**os.environ}
    )
    line = ""
    while line.strip() not in ("True", "False"):
        line = other.stdout.readline()
    assert line.strip() == "True" and try_claim(path) is None
    other.kill()
    other.wait()
    other.stdout.close()
    let_go = try_claim(path)
    assert let_go is not None, "a process that is gone holds nothing"
    let_go()
    assert cores_here() >= 1


COMPILE = """
import numba
from game.run.kernel_work import Version, claim, try_claim
from physics.jit import claims, kernel
claims.claim = claim

@kernel
def double(x):
    return 2.0 * x

version = Version(double, (numba.float64,))
own, seen = version.kernel.compile, []

def compile_and_look(types):
    seen.append(try_claim(version.path) is None)  # before it is asked for
    return own(types)

version.kernel.compile = compile_and_look
print("DONE", version.compile(), seen, version.kept, claims.claimed, try_claim(version.path) is not None)
"""


@jitted
@pytest.mark.skipif(sys.platform == "win32", reason="everybody has every claim there")
def test_nobody_else_begins_a_kernel_between_claim_and_compiling(tmp_path):
    """Two that began at once were both at the longest of the platformer: 12 s of 46 twice."""
    path = tmp_path / "one.py"
    path.write_text(COMPILE)
    run = subprocess.run(
        [sys.executable, str(path)],
        cwd=ROOT,
        env={**os.environ, "HITBOX_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.strip() == "DONE True [True] True {} True"


WORK = """
import json, sys
from game.run.compilers import Compilers, jobs_of
from game.registry import Registry
from scenes import SCENES
import time
scene_class = Registry(SCENES).scene_class("lab/filters")
two = Compilers(Registry({}), cores=2)
jobs = jobs_of(scene_class)
two.first(jobs)
while (share := two.share(jobs)) is not None and share < 1.0:
    time.sleep(0.1)
print("SHARE", share, flush=True)
two.stop()
"""
ASK = """
from game.registry import Registry
from game.run.warmup import warm_up_scene
from scenes import SCENES
from physics.jit import registry
warm_up_scene(Registry(SCENES).scene_class("lab/filters"))
print("MISSES", sum(sum(each.stats.cache_misses.values()) for each in registry))
"""


@jitted
def test_two_processes_leave_nothing_to_compile(tmp_path):
    """What they list without compiling is exactly what the game then asks for."""
    environment = {**os.environ, "HITBOX_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}

    def say(code):
        run = subprocess.run(
            [sys.executable, "-c", code], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
        )
        return run.stdout.strip().splitlines()[-1]

    assert say(WORK) == "SHARE 1.0"
    assert say(ASK) == "MISSES 0"
    assert not list(tmp_path.rglob("*.claim"))
