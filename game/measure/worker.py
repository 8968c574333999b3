"""`python -m game.measure.worker`: the measuring process, to which the game sends orders for measurements.

It measures the settings of a world, the collision tiers of a pair of sprites, lists of runs, and the costs of effects.

Each line of JSON on standard input is an order, which replaces the previous one. Each line of JSON on standard output
is a result. The process ends when its standard input closes, so it never outlives the program that started it.
"""

import contextlib
import json
import os
import queue
import sys
import threading
from collections.abc import Callable, Mapping
from functools import cache, partial
from random import Random
from types import MappingProxyType
from typing import Any

import numpy as np

from game.measure.effect_costs import measure_effects
from game.measure.effect_totals import choices_of, measure_starts, measure_totals
from game.measure.errors import Error, References, Verdicts
from game.measure.measured_runs import measure_runs
from game.measure.moment import Moment
from game.measure.setting import settings_around
from game.measure.tiers import measure_tiers
from game.measure.timing import RUNS
from game.measurement_requests import STEPS, Act, MeasuredRun, Recipe
from physics import PixelMask, Snapshot
from physics.jit.workers import end_all, start_module

NICE = 19  # of 0 to 19: the game has priority


def sent(error: Error) -> dict[str, Any]:
    """Return the JSON form of an error, which surveyor.error_of() reads."""
    return {**vars(error), "verdicts": None if error.verdicts is None else sent_verdicts(error.verdicts)}


def sent_verdicts(verdicts: Verdicts) -> tuple[list, list, bool]:
    """Return the JSON form of verdicts, which surveyor.verdicts_of() reads."""
    return sorted(verdicts.reported), sorted(verdicts.true), verdicts.own


class Orders:
    """The latest order that the game has sent to this measuring process.

    A thread reads the orders from standard input.
    """

    def __init__(self) -> None:
        self.latest: dict[str, Any] | None = None
        self.changed = threading.Condition()

    def listen(self) -> None:
        """Read orders until standard input closes. Then exit the process at once."""
        for line in sys.stdin:
            with self.changed:
                self.latest = json.loads(line)
                self.changed.notify_all()
        os._exit(0)

    def next(self, after: dict[str, Any] | None) -> dict[str, Any]:
        """Wait for a new order, and return it. If several have arrived, return the latest.

        after: the order that was returned last, or None.
        """
        with self.changed:
            self.changed.wait_for(lambda: self.latest is not after)
            assert self.latest is not None
            return self.latest

    def holds(self, order: dict[str, Any]) -> bool:
        """Return whether `order` is still the latest order."""
        return self.latest is order


def measure(order: dict[str, Any], report: Callable[[str], object], goes_on: Callable[[], bool]) -> None:
    """Measure every setting of a world. Each run starts from the snapshot whose file the order names.

    First, the errors and one timed run of each setting are reported. Further timed runs in random order follow while
    goes_on() is True. report(line of JSON) is called for each result.
    """
    number = order["moment"]
    moment = Moment(Snapshot.load(order["snapshot"]), order["broadphase"])
    settings = settings_around(moment.here, moment.effects)
    references = References(moment)

    def send(**found):
        report(json.dumps({"moment": number, **found}))

    send(settings=len(settings), kinds=references.kinds, here=moment.here)
    for setting in settings:
        if not goes_on():
            return
        moment.time_run(setting, 2)  # compiles missing kernels
        send(setting=setting, errors={kind: sent(error) for kind, error in references.errors(setting).items()})
        send(setting=setting, spent=moment.time_run(setting), steps=STEPS)
    chance = Random(number)
    for _ in range(RUNS - 1):
        chance.shuffle(settings)
        for setting in settings:
            if not goes_on():
                return
            send(setting=setting, spent=moment.time_run(setting), steps=STEPS)
    send(done=True)


def measure_sprites(order: dict[str, Any], report: Callable[[str], object]) -> None:
    """Measure every collision tier (kind of collision shape) for the two sprites in the .npz file that the order names.

    The file contains solid_0, origin_0, solid_1, origin_1. report(line of JSON) is called for each tier.
    """
    with np.load(order["sprites"], allow_pickle=False) as stored:
        masks = [PixelMask(stored[f"solid_{k}"], tuple(stored[f"origin_{k}"].tolist())) for k in (0, 1)]
    measure_tiers(masks[0], masks[1], lambda figures: report(json.dumps({"moment": order["moment"], "tier": figures})))
    report(json.dumps({"moment": order["moment"], "done": True}))


def measure_stored_runs(order: dict[str, Any], report: Callable[[str], object], goes_on: Callable[[], bool]) -> None:
    """Measure the runs that an order contains, while goes_on() is True. report(line of JSON) is called after each run.

    order["runs"]: for each run, the fields of a MeasuredRun as a dict. In place of a snapshot it has the name of its
    file, and in place of a Recipe or an Act, a list of its fields.
    """
    loaded = cache(Snapshot.load)  # a snapshot that several runs share is read once

    def begun(given):
        return loaded(given) if isinstance(given, str) else Recipe(*given)

    def run_of(stored):
        act = stored["act"] and Act(*stored["act"])
        return MeasuredRun(**{**stored, "act": act, "snapshots": [begun(each) for each in stored["snapshots"]]})

    measured_runs = [run_of(each) for each in order["runs"]]

    def send(**found):
        report(json.dumps({"moment": order["moment"], **found}))

    def report_run(number, spent, overlap, farthest):
        send(run=number, spent=spent, overlap=overlap, farthest=farthest)

    measure_runs(measured_runs, report_run, goes_on)
    if goes_on():
        send(done=True)


def measure_costs(order: dict[str, Any], report: Callable[[str], object], goes_on: Callable[[], bool]) -> None:
    """Measure the costs of a scene's effects: time of a step, number of kernels, and time of the first step.

    The costs are measured for each choice of effects: as declared, all effects, and the fewest possible. The kernels of
    each single effect are counted, too. If order["each"] is True, the time of each single effect is also measured. All
    runs start from the snapshot whose file is order["snapshot"].

    report(line of JSON) is called for each result. When goes_on() is False, nothing more is timed.
    """
    moment = Moment(Snapshot.load(order["snapshot"]), order["broadphase"])
    choices = choices_of(moment)

    def send(**found):
        report(json.dumps({"moment": order["moment"], **found}))

    def send_total(name, values):
        send(total=name, values=values)

    counting = start_module(f"{__package__}.kernel_counts")
    try:
        assert counting.stdin is not None and counting.stdout is not None
        asked = {
            "effects": moment.effects.names(),
            "broadphase": order["broadphase"],
            "pieces": order["pieces"],
            "choices": {name: side.effects.names() for name, side in choices.items()},
        }
        counting.stdin.write(json.dumps(asked) + "\n")
        counting.stdin.flush()
        counted: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        threading.Thread(target=_listen, args=(counting.stdout, counted), daemon=True).start()

        def send_counts(wait):
            """Report the kernel counts that have arrived. wait: True waits for all counts."""
            while wait or not counted.empty():
                line = counted.get()
                if line is None:
                    counted.put(None)
                    return
                if line.startswith("["):  # libraries may print greetings
                    name, count = json.loads(line)
                    if name in choices:
                        send_total(name, {"kernels": count})
                    else:
                        send(effect=name, kernels=count)

        def send_costs(name, *costs):
            send(effect=name, costs=costs)
            send_counts(wait=False)

        measure_totals(moment, choices, send_total, goes_on)
        send_counts(wait=False)
        if order["each"]:
            measure_effects(moment, send_costs, goes_on)
        send_counts(wait=True)
    finally:
        end_all([counting])
    measure_starts(order, choices, send_total, goes_on)
    send(done=True)


def _listen(lines, heard):
    """Put each line of `lines` into the queue `heard`, and None after the last line."""
    for line in lines:
        heard.put(line)
    heard.put(None)


Work = Callable[[dict[str, Any], Callable[[str], object], Callable[[], bool]], None]


def main(also: Mapping[str, Work] = MappingProxyType({})) -> None:
    """Execute orders until standard input closes.

    also: {key: function} for orders that contain the key. The function is called with (order, report, goes_on).
    """
    with contextlib.suppress(OSError, AttributeError):
        os.nice(NICE)
    orders, order = Orders(), None
    threading.Thread(target=orders.listen, daemon=True).start()
    while True:
        order = orders.next(order)
        try:
            report, goes_on = partial(print, flush=True), partial(orders.holds, order)
            own = next((work for key, work in also.items() if key in order), None)
            if own is not None:
                own(order, report, goes_on)
            elif "sprites" in order:
                measure_sprites(order, report)
            elif "runs" in order:
                measure_stored_runs(order, report, goes_on)
            elif "pieces" in order:
                measure_costs(order, report, goes_on)
            else:
                measure(order, report, goes_on)
        except (ValueError, OSError) as error:  # report a moment that cannot be measured, and go on
            print(json.dumps({"moment": order["moment"], "failed": str(error)}), flush=True)


if __name__ == "__main__":
    main()
