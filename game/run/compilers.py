"""Processes that compile kernels while menus are shown or somebody plays: started, told what is first, ended.

Nothing depends on them: what they have not finished is compiled in the foreground, as it is where they cannot run.
"""

import contextlib
import json
import os
import subprocess
import threading
from collections.abc import Iterator
from hashlib import blake2b
from pathlib import Path
from typing import Any

import physics
from game.errors import UsageError
from game.processes import ROOT, end_all, start_module
from game.registry import Registry
from game.run.warmup import pieces_of, strategy_of, worlds_of
from game.scene import Scene
from physics.jit.folders import cache_home, source_stamp

MOST = 8  # processes: each takes 150 MB, and no scene has kernels for more
Job = dict[str, Any]  # what physics.warmup takes, as JSON can hold it


def jobs_of(scene_class: type[Scene], broadphase: str | None = None, solver: str | None = None) -> list[Job]:
    """What warm_up_scene would compile."""
    return [
        {
            "effects": effects.names(),
            "broadphase": strategy_of(scene_class, broadphase),
            "solver": name,
            "pieces": pieces_of(scene_class),
        }
        for effects, name in worlds_of(scene_class, solver)
    ]


class Compilers:
    """One process per core while only menus are shown, one fewer while somebody plays."""

    def __init__(self, registry: Registry, cores: int | None = None) -> None:
        self.scenes = self._all_scenes(registry)
        self.orders: dict[str, bool] = {}  # every job that was ever asked for
        self.progress: dict[tuple[int, str], tuple[int, int]] = {}  # (process, job) -> kernels (kept, of so many)
        self.resting: list[bool] = []
        self.all_known = False  # every scene's jobs are given
        self.workers: list[subprocess.Popen[str]] = []
        for number in range(min(cores_here() if cores is None else cores, MOST)):
            worker = start_worker()
            if worker is None:
                break
            self.workers.append(worker)
            self.resting.append(False)
            threading.Thread(target=self._listen, args=(number, worker), daemon=True).start()

    def _all_scenes(self, registry) -> Iterator[type[Scene]]:
        """One class after the other, imported when it is asked for."""
        for name in registry.names:
            with contextlib.suppress(UsageError):
                yield registry.scene_class(name)

    def _listen(self, number, worker):
        for line in worker.stdout:
            with contextlib.suppress(ValueError):
                job, done, of = json.loads(line)
                self.progress[number, job] = (done, of)

    def turn(self, plays: bool) -> None:
        """Once per turn of the program's loop: the next scene's jobs; plays: one core is left to the game."""
        self._rest(plays)
        if not self.all_known:
            scene_class = next(self.scenes, None)
            if scene_class is None:
                self.all_known = True
            else:
                self._give(jobs_of(scene_class), first=False)
        elif self.finished:
            mark_finished()
            self.stop()

    @property
    def finished(self) -> bool:
        """True when every job is done."""
        return bool(self.workers) and self.all_known and all(self._share(job) >= 1.0 for job in self.orders)

    def _rest(self, plays):
        for number in range(len(self.workers)):
            wanted = plays and number == len(self.workers) - 1
            if wanted != self.resting[number]:
                self.resting[number] = wanted
                self._say(number, {"rest": wanted})

    def first(self, jobs: list[Job]) -> None:
        """These before all others, by all processes."""
        self._rest(False)
        self._give(jobs, first=True)

    def _give(self, jobs, first):
        for job in reversed(jobs) if first else jobs:
            key = json.dumps(job, sort_keys=True)
            if first or key not in self.orders:
                self.orders[key] = True
                for number in range(len(self.workers)):
                    self._say(number, {"job": job, "first": first})

    def _say(self, number, order):
        worker = self.workers[number]
        with contextlib.suppress(OSError, ValueError):
            assert worker.stdin is not None
            worker.stdin.write(json.dumps(order) + "\n")
            worker.stdin.flush()

    def share(self, jobs: list[Job]) -> float | None:
        """How much of these is compiled, 0..1; None where nobody is at work any more."""
        if not any(worker.poll() is None for worker in self.workers):
            return None
        return min((self._share(json.dumps(job, sort_keys=True)) for job in jobs), default=1.0)

    def _share(self, key):
        told = [
            self.progress[number, key]
            for number, worker in enumerate(self.workers)
            if (number, key) in self.progress and worker.poll() is None
        ]
        return max((done / of if of else 1.0 for done, of in told), default=0.0)

    def stop(self) -> None:
        """End them all; what they have compiled stays."""
        workers, self.workers, self.resting = self.workers, [], []
        end_all(workers)


def cores_here() -> int:
    """How many cores this program may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return max(1, len(affinity(0)) if affinity else os.cpu_count() or 1)


def start_worker() -> "subprocess.Popen[str] | None":
    """One process, of low priority, deaf to Ctrl-C in the terminal; None where none can be started."""
    try:
        return start_module("game.run.compile_worker", HITBOX_LISTING="1")
    except (OSError, ValueError):
        return None


def start_compilers(registry: Registry) -> Compilers | None:
    """Compilers for what is not compiled yet; None where nothing is, or all was finished by an earlier start."""
    if not physics.JIT or _mark().exists():
        return None
    return Compilers(registry)


def _mark() -> Path:
    """A file that says: all scenes of these sources are compiled."""
    digest = blake2b(source_stamp(Path(physics.__file__)).encode(), digest_size=8)
    for path in sorted((ROOT / "scenes").rglob("*.py")):
        digest.update(path.read_bytes())
    return cache_home() / f"all-{digest.hexdigest()}"


def mark_finished() -> None:
    """Remember for later starts that everything is compiled."""
    with contextlib.suppress(OSError):
        mark = _mark()
        mark.parent.mkdir(parents=True, exist_ok=True)
        for old in mark.parent.glob("all-*"):
            old.unlink(missing_ok=True)
        mark.touch()
