"""Measurements of a run, summed over the scene's worlds: times of stages and frames, counters, events.

The module also checks the scene's goals.
"""

from collections.abc import Iterable
from typing import Any

from game.run.digest import scene_digest
from game.run.histogram import Histogram
from game.run.ignored_effects import ignored_effects
from game.scene import Scene

Check = dict[str, Any]  # ok, failures, pending

EVENTS = ("begin", "persist", "end", "hits")


class RunReport:
    """Measurements of a run, added step by step.

    Times are in seconds in the object, and in milliseconds in to_json().
    """

    def __init__(self) -> None:
        self.steps = 0
        self.frames = Histogram()  # update, and drawing where there was any; the last one is still open
        self.last = None  # [s] duration of the last frame, to which drawing time may still be added
        self.updates = Histogram()  # update alone
        self.stages = {}  # name -> Histogram of the times per step
        self.counters = {}
        self.events = dict.fromkeys(EVENTS, 0)
        self.quarantined = 0

    def note_step(self, scene: Scene, seconds: float) -> None:
        """Add the measurements of the last step of all worlds. seconds: duration of the scene's step."""
        self.steps += 1
        self._close_frame()
        self.last = seconds
        self.updates.add(seconds)
        step_stages = {}
        for world in scene.worlds:
            for name, spent in world.profile.stages.items():
                step_stages[name] = step_stages.get(name, 0.0) + spent
            for name, count in world.profile.counters.items():
                self.counters[name] = self.counters.get(name, 0) + int(count)
            for name in EVENTS:
                self.events[name] += len(getattr(world.events, name))
            self.quarantined += len(world.events.quarantined)
        for name, spent in step_stages.items():
            self.stages.setdefault(name, Histogram()).add(spent)

    def note_drawing(self, seconds: float) -> None:
        """Add the time of drawing to the frame of the last step. seconds: duration of the drawing."""
        if self.last is not None:
            self.last += seconds

    def _close_frame(self):
        if self.last is not None:
            self.frames.add(self.last)
            self.last = None

    def strict_failures(self) -> list[str]:
        """Return texts about the failures that --strict reports at the end of a run.

        The failures are disabled bodies, and iterations that reached their cap.
        """
        failures = []
        if self.quarantined:
            failures.append(f"{self.quarantined} bodies were quarantined")
        if self.counters.get("cap_hits"):
            failures.append(f"{self.counters['cap_hits']} cap hits")
        return failures

    def to_json(self, scene: Scene, check: Check) -> dict[str, Any]:
        """Return the object that --json prints, as a dict. check: result of judge() or not_judged()."""
        self._close_frame()
        return {
            "scene": scene.name,
            "frames": self.steps,
            "seed": scene.seed,
            "effects": scene.effects.names(),
            "broadphase": scene.broadphase,
            "solver": solver_name(scene),
            "ignored_effects": ignored_effects(scene),
            "tier": scene.tier,
            "digest": scene_digest(scene),
            "check": check,
            "counters": self.counters,
            "stages_ms": {name: summary(spent, ("mean", "p99")) for name, spent in self.stages.items()},
            "frame_ms": summary(self.frames, ("mean", "p50", "p99")),
            "events": self.events,
        }

    def profile_lines(self) -> list[str]:
        """Return the table that --profile prints, as lines of text."""
        self._close_frame()
        lines = [f"{'':24}{'mean':>9}{'p50':>9}{'p99':>9}{'max':>9}  ms"]
        rows = {"frame": self.frames, "  update": self.updates}
        rows |= {f"    {name}": spent for name, spent in self.stages.items()}
        for name, spent in rows.items():
            found = summary(spent, ("mean", "p50", "p99", "max"))
            lines.append(f"{name:24}" + "".join(f"{value:9.3f}" for value in found.values()))
        lines.append(
            "per step: "
            + ", ".join(f"{name} {total / max(self.steps, 1):.1f}" for name, total in self.counters.items() if total)
        )
        return lines


def solver_name(scene: Scene) -> str | None:
    """Return the name of the solver in use: that of the first world, or the scene's choice if there is no world yet.

    Return None if there is no world and the scene leaves the choice to World.
    """
    return scene.worlds[0].solver if scene.worlds else scene.solver


def summary(times: Histogram, wanted: Iterable[str]) -> dict[str, float]:
    """Return statistics of durations in milliseconds, {name: value}. All are 0 if nothing was measured.

    wanted: names of the statistics: mean, p50, p99, max.
    """
    found = {"mean": times.mean, "p50": times.quantile(0.5), "p99": times.quantile(0.99), "max": times.largest}
    return {name: round(1000.0 * found[name], 4) for name in wanted}


def judge(scene: Scene, frames: int, extra: Iterable[str] = ()) -> Check:
    """Check the scene's goals after `frames` frames, and return {ok, failures, pending}. extra: further failures.

    An unmet goal that is due later counts as pending, not as failed.
    """
    failures, pending = list(extra), []
    for goal in scene.check():
        if goal.met:
            continue
        line = goal.text
        if goal.due > frames:
            pending.append(f"{line} (due {goal.due})")
        else:
            failures.append(f"{line} (was due {goal.due})")
    return {"ok": not failures, "failures": failures, "pending": pending}


def not_judged(scene: Scene, extra: Iterable[str] = ()) -> Check:
    """Return {ok, failures, pending} for a run that was not played by a bot. All goals are pending.

    extra: failures of --strict.
    """
    return {"ok": not extra, "failures": list(extra), "pending": [goal.name for goal in scene.check()]}
