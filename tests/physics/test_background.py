"""compile_in_background() never makes the program wait, whatever happens to the processes that compile.

The digests stay the same.
"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

import physics
import physics.background
from physics.jit import kernels, tiers, workers
from physics.jit.workers import ATTEMPTS, DEATHS, Task, Workers

ROOT = Path(physics.__file__).resolve().parents[1]
jitted = pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
linux = pytest.mark.skipif(sys.platform != "linux", reason="looks at /proc")

ANSWERS = """
import os, sys, time
sys.path.insert(0, ROOT)
from physics.jit.workers import decoded, encoded
for line in sys.stdin:
    order = decoded(line)
    if order == "die":
        os._exit(1)
    if order == "hang":
        time.sleep(600)
    if order == "pid":
        order = os.getpid()
    print(encoded(order), flush=True)
"""


@pytest.fixture
def pool(tmp_path, monkeypatch):
    """Yield a function make(count, module), which starts `Workers`: `count` processes that run the tasks of a module.

    The tasks of the default module answer, end their process or never return.
    """
    (tmp_path / "answering.py").write_text(ANSWERS.replace("ROOT", repr(str(ROOT))))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    made = []

    def make(count=2, module="answering"):
        made.append(Workers(module, count))
        return made[-1]

    yield make
    for each in made:
        each.stop()


def tasks(orders, found, urgency=lambda number: 0.0):
    return [
        Task(order, lambda n=n: urgency(n), lambda answer, order=order: found.append((order, answer)))
        for n, order in enumerate(orders)
    ]


@pytest.mark.parametrize("count", [1, 2, 3])
def test_each_task_is_answered_once(pool, count):
    found, pool = [], pool(count)
    pool.add(tasks(range(20), found))
    assert pool.wait(60.0) and sorted(found) == [(n, n) for n in range(20)]


def test_the_most_urgent_task_goes_first_whenever_it_was_given(pool):
    found, pool, urgent = [], pool(1), {}
    gate = threading.Event()
    pool.limit = 0
    pool.add(tasks(range(9), found, lambda n: urgent.get(n, n)))
    urgent[3] = 100.0
    pool.limit = 1
    assert pool.wait(60.0) and not gate.is_set()
    assert [order for order, _ in found] == [3, 8, 7, 6, 5, 4, 2, 1, 0]


@pytest.mark.parametrize("place", range(4))
def test_a_task_that_kills_its_process_fails_alone(pool, place):
    found, pool = [], pool(2)
    orders = [*range(6)]
    orders.insert(place, "die")
    pool.add(tasks(orders, found))
    assert pool.wait(60.0)
    assert dict(found) == {**{n: n for n in range(6)}, "die": None} and pool.alive


def test_a_task_that_hangs_is_ended(pool, monkeypatch):
    monkeypatch.setattr(workers, "HUNG", 10.0)
    found, pool = [], pool(2)
    pool.add(tasks([1, "hang", 2, 3], found))
    assert pool.wait(60.0)
    assert dict(found) == {1: 1, 2: 2, 3: 3, "hang": None}


@pytest.mark.parametrize("module", ["no_such_module", "this"])
def test_where_no_process_works_all_tasks_fail_and_few_are_started(pool, module, monkeypatch):
    started = []
    begin = workers.start_module
    monkeypatch.setattr(workers, "start_module", lambda *given, **more: started.append(1) or begin(*given, **more))
    found, pool = [], pool(2, module)
    pool.add(tasks(range(30), found))
    assert pool.wait(60.0)
    assert sorted(order for order, _ in found) == [*range(30)] and {answer for _, answer in found} == {None}
    assert not pool.alive and len(started) <= DEATHS + 2 <= ATTEMPTS * 30


def test_where_no_process_can_be_started_all_tasks_fail(pool, monkeypatch):
    def fail(*given, **more):
        raise OSError("no more processes")

    monkeypatch.setattr(workers, "start_module", fail)
    found, pool = [], pool(2)
    pool.add(tasks(range(9), found))
    assert pool.wait(60.0) and len(found) == 9 and not pool.alive


def test_a_frozen_program_starts_none(monkeypatch):
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    assert not Workers("answering").alive


@linux
def test_processes_end_with_the_pool(pool):
    found, pool = [], pool(2)
    pool.add(tasks(["pid"] * 8, found))
    assert pool.wait(60.0)
    pool.stop()
    for _, number in found:
        assert not Path(f"/proc/{number}").exists()


@pytest.mark.parametrize("given", [-1, 1.5, "two", True])
def test_a_wrong_number_of_workers_is_refused(given):
    with pytest.raises(ValueError, match=f"workers must be .* \\(got {given!r}\\)"):
        physics.compile_in_background(given)
    assert not tiers.background


# --- what is compiled first --------------------------------------------------------------------------------------


class Asked:
    """A stand-in for the process pool, which only stores its tasks.

    `first()` returns the task that a process would take next.
    """

    count, alive, left = 1, True, 0

    def __init__(self):
        self.tasks, self.limit = [], 1

    def add(self, tasks):
        self.tasks += tasks

    def first(self):
        task = max(self.tasks, key=lambda each: each.urgency())
        self.tasks.remove(task)
        return task

    def stop(self):
        pass


def small(x):
    return x + 1.0


def large(x):
    for _ in range(3):
        x = x * x + 1.0 / (x + 2.0) - x * 3.0 + (x - 1.0) * (x + 4.0) / (x * x + 5.0)
        x = x * x + 1.0 / (x + 2.0) - x * 3.0 + (x - 1.0) * (x + 4.0) / (x * x + 5.0)
        x = x * x + 1.0 / (x + 2.0) - x * 3.0 + (x - 1.0) * (x + 4.0) / (x * x + 5.0)
    return x


def calling(called):
    def calls(x):
        return called(x) * 2.0

    return calls


@pytest.fixture
def ordered(monkeypatch):
    """Yield order(seconds, function), which asks a Background to compile a kernel; no thread or process is started."""
    monkeypatch.setattr(physics.background, "JIT", False)
    monkeypatch.setattr(physics.background, "Workers", lambda *given: Asked())
    background = physics.background.Background(1)
    before = len(kernels.registry)

    def order(seconds, function, keys=()):
        kernel = function if isinstance(function, kernels.Kernel) else kernels.Part(function)
        kernel.seconds = seconds
        background._order_early(kernel, keys)
        return kernel

    order.pool, order.background = background.workers, background
    yield order
    del kernels.registry[before:]


@pytest.mark.parametrize("share", [1.5, 2.0, 10.0])
def test_of_two_kernels_of_one_length_that_with_more_time_is_first(ordered, share):
    less, more = ordered(0.1, small), ordered(0.1 * share, small)
    asked = [ordered.pool.first().order for _ in range(2)]
    assert [each[1] for each in asked] == [tiers.spec_of(more), tiers.spec_of(less)]


@pytest.mark.parametrize("share, first", [(0.8, "small"), (1.0, "small"), (1.2, "small"), (100.0, "large")])
def test_a_short_kernel_goes_before_a_long_one_unless_that_takes_more_of_the_time_for_its_length(ordered, share, first):
    ordered(0.1, small)
    ordered(0.1 * share, large)
    assert ordered.pool.first().order[1][1] == first


def test_what_a_kernel_calls_counts_until_another_has_had_it_compiled(ordered):
    part = kernels.Part(large)
    outer, other = ordered(0.1, calling(part)), ordered(0.08, small)
    assert [ordered.background._urgency([(each, ())]) for each in (outer, other)] == sorted(
        ordered.background._urgency([(each, ())]) for each in (outer, other)
    )
    ordered.background._compiled.add(part)
    assert ordered.pool.first().order[1][1].endswith("calls")


def test_a_kernel_that_cannot_be_compiled_stays_plain_and_is_told(ordered):
    kernel = ordered(0.1, small)
    ordered.pool.first().done(None)
    assert ordered.background.failed == [kernel.__qualname__]


# --- a whole program ---------------------------------------------------------------------------------------------

PROGRAM = """
import json, os, signal, sys, time
import physics
from physics import Polygon, World
background = physics.compile_in_background(*json.loads(sys.argv[1])) if sys.argv[1] != "null" else None
assert background is None or background is physics.compile_in_background()
world = World()
world.add_body(Polygon.box(400, 20), position=(0, 100), kind="static")
for number in range(5):
    world.add_body(Polygon.box(20, 20), position=(0.3 * number, 80 - 21 * number))
digests, until = [], time.monotonic() + float(sys.argv[2])
while len(digests) < 200:
    world.step()
    digests.append(world.digest())
taken = None if background is None else background.share
while background is not None and background.share < 1.0 and time.monotonic() < until:
    world.step()
    time.sleep(0.01)
    if len(sys.argv) > 3:
        for process in list(background.workers._processes.values()):
            process.send_signal(int(sys.argv[3]))
from physics.jit import kernels as totals
print(json.dumps([digests, totals.compiled, taken, None if background is None else background.share]))
"""


def program(cache, *arguments, **environment):
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT), "HITBOX_CACHE_DIR": str(cache), **environment},
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def compiled_digests():
    return program(os.environ.get("HITBOX_CACHE_DIR", ""), "null", 0)[0]


@jitted
@pytest.mark.parametrize("given", ["[]", "[2]"])
def test_a_script_without_a_guard_goes_on_plain_and_is_compiled(tmp_path, compiled_digests, given):
    """A script without a main guard runs in plain Python at first and is compiled in the background.

    The folder of compiled kernels is empty at its start. After 200 steps the first run waits until kernels arrive.
    """
    digests, compiled, taken, _ = program(tmp_path / "kernels", given, 15)
    assert digests == compiled_digests and compiled == 0 and taken < 1.0
    again, compiled, taken, share = program(tmp_path / "kernels", given, 0)
    assert again == compiled_digests and compiled == 0


@jitted
def test_from_a_warm_cache_no_process_is_started(compiled_digests):
    digests, compiled, _, share = program(os.environ.get("HITBOX_CACHE_DIR", ""), "[]", 20)
    assert digests == compiled_digests and compiled == 0 and share == 1.0


@jitted
@linux
def test_whoever_kills_its_workers_again_and_again_does_not_stop_it(tmp_path, compiled_digests):
    digests, _, _, _ = program(tmp_path / "kernels", "[2]", 4, int(signal.SIGKILL))
    assert digests == compiled_digests


@jitted
@linux
def test_workers_of_a_killed_program_end(tmp_path):
    code = (
        "import physics, time\nbackground = physics.compile_in_background(2)\nworld = physics.World()\n"
        "world.add_body(physics.Circle(4))\nworld.step()\n"
        "while len(background.workers._processes) < 2:\n    time.sleep(0.05)\n"
        "print(*(each.pid for each in background.workers._processes.values()), flush=True)\ntime.sleep(600)\n"
    )
    environment = {**os.environ, "HITBOX_CACHE_DIR": str(tmp_path / "kernels"), "PYTHONPATH": str(ROOT)}
    running = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=environment)
    assert running.stdout is not None
    numbers = [int(each) for each in running.stdout.readline().split()]
    assert len(numbers) == 2
    running.kill()
    running.wait()
    running.stdout.close()
    until = time.monotonic() + 30.0
    while any(alive(each) for each in numbers) and time.monotonic() < until:
        time.sleep(0.1)
    assert not any(alive(each) for each in numbers)


def alive(number):
    """Return whether the process with this id runs; a zombie does not. Linux only."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.skipif(sys.platform == "win32", reason="there are no sessions")
def test_a_process_beside_the_program_lies_in_its_session_and_is_deaf_to_its_terminal():
    """A worker process is in the program's session but in its own process group, so it gets no signals of the terminal.

    In a session of its own, Linux would give it as much CPU time as the program, whatever its priority.
    """
    process = workers.start_module("physics.compile_worker")
    try:
        assert os.getsid(process.pid) == os.getsid(0) and os.getpgid(process.pid) == process.pid != os.getpgid(0)
    finally:
        workers.end_all([process])


@jitted
def test_what_was_compiled_and_cannot_be_loaded_is_told_and_no_longer_waited_for(ordered, monkeypatch):
    """A compiled kernel that cannot be loaded, for instance on a full disk, is reported as failed and no longer
    awaited.
    """
    kernel = ordered(0.1, small)
    monkeypatch.setattr(tiers, "wanted", {(kernel, ()): None})
    monkeypatch.setattr(tiers, "load", id)
    monkeypatch.setattr("physics.jit.compiling.load", lambda *given: None)
    ordered.pool.first().done("a name")
    assert ordered.background.failed == [kernel.__qualname__] and not tiers.wanted
