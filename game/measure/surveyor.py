"""The process that measures, seen from the game: it is handed moments and fills a Survey."""

import contextlib
import json
import os
import queue
import subprocess
import sys
import tempfile
import threading
import weakref
from pathlib import Path
from typing import Any

import numpy as np

from game.measure.errors import Error
from game.measure.rates import Rate
from game.measure.setting import Setting
from game.measure.survey import Survey
from game.measure.tiers import TierFigures
from game.measure.timing import Cost
from game.measure.worker import setting_of
from physics import PixelMask, Snapshot

ROOT = Path(__file__).resolve().parents[2]


class Surveyor:
    """measure() hands on a moment, turn() takes what was found since into `survey`. `trouble`: why nothing is."""

    def __init__(self, survey: Survey | None = None) -> None:
        self.survey = survey or Survey()
        self.here: Setting | None = None  # under which the last moment was taken
        self.busy = False
        self.trouble = ""
        self.revision = 0  # counts what was found
        self.tiers: dict[str, TierFigures] = {}  # of the sprites that were asked for, as far as they are known
        self.found: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
        self.folder = tempfile.TemporaryDirectory(prefix="hitbox-")
        self.process: subprocess.Popen[str] | None = None

    def measure(self, snapshot: Snapshot, broadphase: str) -> None:
        """Measure this moment too, instead of the one before if that is not done."""
        if self.process is None and not self._start():
            return
        self.survey.moments += 1
        self.busy = True
        number = self.survey.moments
        # Packing the pixels of a level takes longer than a frame.
        threading.Thread(target=self._hand_on, args=(snapshot, broadphase, number), daemon=True).start()

    def measure_sprites(self, first: PixelMask, second: PixelMask) -> None:
        """Measure every tier of two sprites: `tiers`."""
        if self.process is None and not self._start():
            return
        self.tiers, self.busy = {}, True
        path = Path(self.folder.name) / "sprites.npz"
        arrays: dict[str, Any] = {f"solid_{k}": mask.solid for k, mask in enumerate((first, second))}
        arrays |= {f"origin_{k}": np.array(tuple(mask.origin)) for k, mask in enumerate((first, second))}
        try:
            np.savez(path, **arrays)
            self._say({"moment": None, "sprites": str(path)})
        except (OSError, ValueError) as error:
            self.trouble, self.busy = str(error), False

    def _start(self):
        path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
        options: dict[str, Any] = {"start_new_session": True}
        if sys.platform == "win32":
            options = {"creationflags": subprocess.BELOW_NORMAL_PRIORITY_CLASS | subprocess.CREATE_NEW_PROCESS_GROUP}
        try:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "game.measure.worker"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                env={**os.environ, "PYTHONPATH": path},
                **options,
            )
        except (OSError, ValueError) as error:
            self.trouble = f"the process that measures could not be started: {error}"
            return False
        # Neither holds the surveyor: whoever forgets to stop it leaves no process behind.
        threading.Thread(target=_listen, args=(self.process, self.found), daemon=True).start()
        weakref.finalize(self, self.process.kill)
        return True

    def _hand_on(self, snapshot, broadphase, number):
        path = Path(self.folder.name) / f"{number}.npz"
        order = {"moment": number, "snapshot": str(path), "broadphase": broadphase}
        try:
            snapshot.save(path)
            self._say(order)
        except (OSError, ValueError) as error:
            self.found.put({"moment": number, "failed": str(error)})

    def _say(self, order):
        process = self.process
        if process is None or process.stdin is None:
            raise OSError("the process that measures has ended")
        process.stdin.write(json.dumps(order) + "\n")
        process.stdin.flush()

    def turn(self) -> None:
        """Take what was found since the last turn; once per picture."""
        with contextlib.suppress(queue.Empty):
            while True:
                self._take(self.found.get_nowait())

    def wait(self, seconds: float) -> None:
        """Take what is found until the moment is done, for so long at most."""
        with contextlib.suppress(queue.Empty):
            while self.busy:
                self._take(self.found.get(timeout=seconds))

    def _take(self, found):
        survey = self.survey
        self.revision += 1
        if "failed" in found:
            self.trouble, self.busy = found["failed"], False
            if "ended" in found:
                self.process = None
        elif "settings" in found:
            self.trouble = ""
            survey.planned, survey.kinds = found["settings"], tuple(found["kinds"])
            self.here = setting_of(found["here"])
        elif "tier" in found:
            figures = figures_of(found["tier"])
            self.tiers[figures.tier] = figures
        elif "done" in found:
            self.busy = self.busy and found["moment"] not in (survey.moments, None)
        else:
            dot = survey.dot(setting_of(found["setting"]))
            if "errors" in found:
                dot.errors[found["moment"]] = {kind: error_of(each) for kind, each in found["errors"].items()}
            else:
                dot.steps = found["steps"]
                dot.spent.setdefault(found["moment"], []).append(found["spent"])

    def stop(self) -> None:
        """End the process; what was found stays."""
        process, self.process = self.process, None
        self.busy = False
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                with contextlib.suppress(OSError):
                    if pipe is not None:
                        pipe.close()
        self.folder.cleanup()


def _listen(process, found):
    for line in process.stdout:
        with contextlib.suppress(ValueError):
            found.put(json.loads(line))
    found.put({"ended": True, "failed": "the process that measures has ended"})


def figures_of(values: list[Any]) -> TierFigures:
    """A TierFigures from what JSON made of it."""
    tier, shapes, hit, miss, wrong, missed = values
    return TierFigures(tier, shapes, Cost(*hit), Cost(*miss), Rate(*wrong), Rate(*missed))


def error_of(values: dict[str, Any]) -> Error:
    """An Error from what JSON made of it."""
    wrong, missed = (None if values[name] is None else Rate(*values[name]) for name in ("wrong", "missed"))
    return Error(values["value"], values["floor"], values["steps"], values["failures"], wrong, missed)
