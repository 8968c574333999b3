"""Client of the measuring process: the game sends orders for measurements to it and receives the results."""

import contextlib
import json
import pickle
import queue
import subprocess
import tempfile
import threading
import weakref
from collections.abc import Hashable
from functools import partial
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np

from game.measure.effect_costs import EffectCost
from game.measure.effect_totals import EffectTotal
from game.measure.errors import Error, Verdicts
from game.measure.ledger import EFFECTS
from game.measure.measured_runs import RunFigures
from game.measure.rates import Rate
from game.measure.setting import Setting
from game.measure.survey import Survey
from game.measure.tiers import TierFigures
from game.measure.timing import Cost
from game.measurement_requests import MeasuredRun, RunRequest
from physics import Fit, PixelMask, Snapshot
from physics.jit.workers import end_all, start_module


class Surveyor:
    """Client of the measuring process.

    The measure methods send orders to the process, and turn() stores the results that have arrived. The process starts
    with the first order. After stop(), it starts again with the next order.

    module: name of the module that the process runs. `trouble`: the reason why nothing is measured, or "".
    """

    def __init__(self, module: str = f"{__package__}.worker") -> None:
        self.module = module
        self.survey = Survey()
        self.here: Setting | None = None  # setting of the last moment
        self.busy = False
        self.trouble = ""
        self.revision = 0  # counts the results
        # Figures of the requested sprites or runs so far, by tier or by name.
        self.figures: dict[Hashable, TierFigures | RunFigures] = {}
        self.asked: list[tuple[list[Hashable], list[MeasuredRun]]] = []  # measured runs, order by order
        self.runs: dict[Hashable, list[float]] = {}  # by name of a measured run: seconds per step of each turn
        self.latest: int | str | None = None  # identifier of the last order
        self.totals: dict[str, EffectTotal] = {}  # costs of the choices of effects, as far as measured
        self.effects: dict[str, EffectCost] = {}  # costs of effects once requested, as far as measured
        self.found: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
        self.folder: tempfile.TemporaryDirectory[str] | None = None  # folder of the files that orders name
        self.proofs: list[list[Any]] = []  # JSON forms of game.run.proven_advice.Applied, in the order of arrival
        self.process: subprocess.Popen[str] | None = None

    def measure(self, snapshot: Snapshot, broadphase: str, run: object = None) -> None:
        """Request the measurement of every setting, starting from `snapshot`.

        The results are stored in the attribute `survey`. The request replaces an unfinished earlier one.

        broadphase: name of the broad phase of the snapshot's world. run: the inputs recorded so far, or None if the run
        is not recorded. If the process runs the module game.run.run_worker, it also counts which bodies met in that
        run.
        """
        if not self._started():
            return
        self.survey.moments += 1
        number = self.latest = self.survey.moments
        order = {"moment": number, "snapshot": self._path(f"{number}.npz"), "broadphase": broadphase}
        if run is not None:
            order["run"] = self._path(f"{number}.run")

        def save():
            snapshot.save(order["snapshot"])
            if run is not None:
                _save_run(order["run"], run)

        self._hand_on_beside(order, save)

    def prove(self, run: object, setting: Setting, predicted: float) -> None:
        """Order a test of a setting on a whole recorded run. The result is appended to `proofs`.

        predicted: expected time under the setting, as a share of the present time. The process must be
        game.run.run_worker.
        """
        if not self._started():
            return
        self.latest = f"proof {self.revision}"
        order = {"moment": self.latest, "prove": [setting, predicted], "run": self._path("proof.run")}
        self._hand_on_beside(order, partial(_save_run, order["run"], run))

    def measure_sprites(self, first: PixelMask, second: PixelMask) -> None:
        """Order measurements of every collision tier (kind of collision shape) for the sprites `first` and `second`.

        The results are stored in `figures`.
        """
        if not self._started():
            return
        self.figures, self.latest = {}, "sprites"
        arrays: dict[str, Any] = {f"solid_{k}": mask.solid for k, mask in enumerate((first, second))}
        arrays |= {f"origin_{k}": np.array(tuple(mask.origin)) for k, mask in enumerate((first, second))}
        order = {"moment": self.latest, "sprites": self._path("sprites.npz")}
        _hand_on(self.process, order, partial(np.savez, order["sprites"], **arrays), self.found)

    def measure_runs(self, request: RunRequest) -> None:
        """Order those runs of a request that have not been measured often enough yet.

        The results are stored in `figures`. The order replaces an unfinished earlier one.
        """
        names = [name for name in request.names if not self.knows(name)]
        if not names or not self._started():
            return
        measured_runs = [request.make(name) for name in names]
        self.latest = f"runs {len(self.asked)}"
        self.asked.append((names, measured_runs))
        taken = (
            each for measured_run in measured_runs for each in measured_run.snapshots if isinstance(each, Snapshot)
        )
        snapshots = list({id(each): each for each in taken}.values())
        paths = {id(each): self._path(f"{self.latest} {k}.npz") for k, each in enumerate(snapshots)}
        stored = [
            measured_run._replace(snapshots=[paths.get(id(each), each) for each in measured_run.snapshots])._asdict()
            for measured_run in measured_runs
        ]
        order = {"moment": self.latest, "runs": stored}
        self._hand_on_beside(order, lambda: [each.save(paths[id(each)]) for each in snapshots])

    def measure_effects(
        self, snapshot: Snapshot, broadphase: str, pieces: tuple[str, ...] | None, each: bool = True
    ) -> None:
        """Order measurements of the costs of effects. The results are stored in `totals` and `effects`.

        The time of a step is measured, and the compiled kernels are counted, for each choice of effects (see
        effect_totals) and for each single effect. each: False omits the times of single effects.

        snapshot: state from which the steps are timed; broadphase: name of the broad phase of its world; pieces: shape
        pairs and queries that the scene uses, as in physics.warmup, None for all.
        """
        if not self._started():
            return
        declared = snapshot.facts["effects"]
        self.effects = {name: EffectCost(name, name in declared) for name in EFFECTS}
        self.latest = "effects"
        order = {
            "moment": self.latest,
            "snapshot": self._path("effects.npz"),
            "broadphase": broadphase,
            "pieces": pieces,
            "each": each,
        }
        self._hand_on_beside(order, partial(snapshot.save, order["snapshot"]))

    def knows(self, name: Hashable) -> bool:
        """Return whether the measured run with this name has been repeated often enough."""
        figures = self.figures.get(name)
        return isinstance(figures, RunFigures) and figures.sure

    def _started(self):
        """Start the measuring process if it is not running, and mark it as busy. Return whether it is running."""
        if self.process is None:
            try:
                self.process = start_module(self.module)
                self.folder = tempfile.TemporaryDirectory(prefix="hitbox-", ignore_cleanup_errors=True)
            except (OSError, ValueError) as error:
                self.stop()
                self.trouble = f"the process that measures could not be started: {error}"
                return False
            self.found = queue.SimpleQueue()  # discards the last results of an earlier process
            # The thread holds no reference to the surveyor, so that its finalizer ends a process that was not stopped.
            threading.Thread(target=_listen, args=(self.process, self.found), daemon=True).start()
            weakref.finalize(self, self.process.kill)
        self.busy = True
        return True

    def _hand_on_beside(self, order, save):
        """Start a thread that calls save() and then sends `order` to the process.

        save() writes the files that the order names. A thread is used because compressing the pixels of a level takes
        longer than a frame.
        """
        args = self.process, order, save, self.found
        threading.Thread(target=_hand_on, args=args, name="hand on", daemon=True).start()

    def _path(self, name):
        assert self.folder is not None  # there is a folder while there is a process
        return str(Path(self.folder.name) / name)

    def turn(self) -> None:
        """Store the results that have arrived since the last call. Call this once per frame."""
        with contextlib.suppress(queue.Empty):
            while True:
                self._take(self.found.get_nowait())

    def wait(self, seconds: float) -> None:
        """Store results as they arrive, until the last order is done or `seconds` have passed."""
        end = monotonic() + seconds
        with contextlib.suppress(queue.Empty):
            while self.busy:
                self._take(self.found.get(timeout=max(0.0, end - monotonic())))

    def _take(self, found):
        survey = self.survey
        self.revision += 1
        if "failed" in found:
            self.trouble, self.busy = found["failed"], False
            if "ended" in found:
                self.stop()
        elif "settings" in found:
            self.trouble = ""
            survey.planned, survey.kinds = found["settings"], tuple(found["kinds"])
            self.here = Setting(*found["here"])
        elif "tier" in found:
            figures = figures_of(found["tier"])
            self.figures[figures.tier] = figures
        elif "run" in found:
            self._take_run(**found)
        elif "effect" in found:
            known = self.effects[found["effect"]]
            if "costs" in found:
                known = known._replace(cost=Cost(*found["costs"][0]), without=Cost(*found["costs"][1]))
            self.effects[known.effect] = known._replace(kernels=found.get("kernels", known.kernels))
        elif "total" in found:
            self._take_total(found["total"], found["values"])
        elif "encounters" in found:
            survey.encounters = {tier: verdicts_of(each) for tier, each in found["encounters"].items()}
        elif "applied" in found:
            self.proofs.append(found["applied"])
        elif "done" in found:
            self.busy = self.busy and found["moment"] != self.latest
        else:
            dot = survey.dot(Setting(*found["setting"]))
            if "errors" in found:
                dot.erred(found["moment"], {kind: error_of(each) for kind, each in found["errors"].items()})
            else:
                dot.steps = found["steps"]
                dot.took(found["moment"], found["spent"])

    def _take_total(self, name, values):
        if "time" in values:
            values["time"] = Cost(*values["time"])
        self.totals[name] = self.totals.get(name, EffectTotal(0))._replace(**values)

    def _take_run(self, moment, run, spent, overlap, farthest):
        names, measured_runs = self.asked[int(moment.split()[1])]
        name, measured_run = names[run], measured_runs[run]
        seconds = self.runs.setdefault(name, [])
        seconds.append(spent)
        steps = measured_run.steps * len(measured_run.snapshots)
        self.figures[name] = RunFigures(Cost.of(seconds, steps), overlap, farthest)

    def stop(self) -> None:
        """End the measuring process. The results received so far remain available."""
        process, self.process = self.process, None
        folder, self.folder = self.folder, None
        self.busy = False
        if process is not None:
            end_all([process])
        if folder is not None:
            folder.cleanup()


def _hand_on(process, order, save, found):
    """Call save(), which writes the files that `order` names, then send the order to the measuring process `process`.

    If save() fails while the process is running, a report of the failure is put into the queue `found`, like a result.
    If the process has ended, nothing is done, because the thread that reads its results reports the end.
    """
    try:
        save()
    except (OSError, ValueError) as error:
        if process.poll() is None:
            found.put({"moment": order["moment"], "failed": str(error)})
        return
    with contextlib.suppress(OSError, ValueError):
        process.stdin.write(json.dumps(order) + "\n")
        process.stdin.flush()


def _listen(process, found):
    with contextlib.suppress(ValueError):  # ending the process closes this stream
        for line in process.stdout:
            with contextlib.suppress(ValueError):
                found.put(json.loads(line))
    found.put({"ended": True, "failed": "the process that measures has ended"})


def figures_of(values: list[Any]) -> TierFigures:
    """Return the TierFigures that the measuring process sent as JSON. values: the fields in order."""
    tier, shapes, hit, miss, wrong, missed, build, fit = values
    costs, rates = (Cost(*hit), Cost(*miss)), (Rate(*wrong), Rate(*missed))
    return TierFigures(tier, shapes, *costs, *rates, Cost(*build), Fit(*fit))


def error_of(values: dict[str, Any]) -> Error:
    """Return the Error that the measuring process sent. values: its JSON form (see worker.sent)."""
    verdicts = values["verdicts"]
    return Error(**{**values, "verdicts": None if verdicts is None else verdicts_of(verdicts)})


def verdicts_of(values: list[Any]) -> Verdicts:
    """Return the Verdicts that the measuring process sent. values: their JSON form (see worker.sent_verdicts)."""
    reported, true, own = values
    return Verdicts(_pairs(reported), _pairs(true), own)


def _save_run(path, run):
    Path(path).write_bytes(pickle.dumps(run))


def _pairs(lists):
    return frozenset((first, second) for first, second in lists)
