"""The total cost of a scene's effects for three choices: as declared, every effect, and the fewest possible.

The fewest possible effects include the declared effects that the world needs. Four figures are measured for each
choice: the time of a step, the number of kernels, the time of the first step in a new process, and the bytes of the
tables.
"""

import json
from collections.abc import Callable, Mapping
from random import Random
from typing import Any, NamedTuple

import numpy as np

from game.drawing.bar_table import BarRow
from game.drawing.colors import GOLD, GREEN, RED
from game.measure.effect_costs import Side, can_be, world_under
from game.measure.ledger import EFFECTS, NEUTRAL
from game.measure.moment import STEPS, Moment
from game.measure.timing import RUNS, UNSURE, UNSURE_CELL, Cost, seconds_a_step
from physics import Effects, World
from physics.jit.workers import end_all, start_module

DECLARED, EVERYTHING, NOTHING = NAMES = "declared", "everything", "nothing"
STARTS = 3  # new processes per choice: the first may compile, and the least time counts
FIELDS = {"time": "us/step", "kernels": "kernels", "start": "start ms", "bytes": "kB"}  # field -> unit as shown
COLORS = {DECLARED: GOLD, EVERYTHING: RED, NOTHING: GREEN}
SCALES = {"time": 1e6, "kernels": 1.0, "start": 1e3, "bytes": 1e-3}  # from the stored unit to the one shown


class EffectTotal(NamedTuple):
    """Costs of one choice of effects. A field is None if it is not measured yet.

    effects: number of effects; time: time of a step [s], a Cost; kernels: number of kernels that a world with these
    effects can call. start: least time of building the world and making its first step in a new process [s]; bytes:
    size of the world's arrays.
    """

    effects: int
    time: Cost | None = None
    kernels: int | None = None
    start: float | None = None
    bytes: int | None = None

    def value(self, field: str) -> float | None:
        """Return the value of the field `field` (one of FIELDS) as a number; None if it is not known yet.

        The value of "time" is the least time of a step [s].
        """
        if field == "time":
            return self.time.least if self.time is not None and self.time.runs >= RUNS else None
        return getattr(self, field)


def choices_of(moment: Moment) -> dict[str, Side]:
    """Return {name: Side} of the choices of effects: as declared, all effects, and the fewest possible.

    The names are those in NAMES. A choice is omitted if it is not valid in the state of the snapshot `moment`. Effects
    that the scene does not declare have neutral settings, so that they do nothing.
    """
    declared = moment.effects
    added = tuple(name for name in EFFECTS if not getattr(declared, name) and name in NEUTRAL)
    fewest = declared
    for name in reversed(declared.names()):
        less = fewest.without(name) if getattr(fewest, name) else fewest
        if can_be(moment, Side(less)):
            fewest = less
    every = Side(Effects(**dict.fromkeys(EFFECTS, True)), added)
    found = {DECLARED: Side(declared), EVERYTHING: every, NOTHING: Side(fewest)}
    return {name: side for name, side in found.items() if can_be(moment, side)}


def measure_totals(
    moment: Moment,
    sides: Mapping[str, Side],
    report: Callable[[str, dict[str, Any]], object],
    goes_on: Callable[[], bool],
    seed: int = 0,
) -> None:
    """Time a step under each choice of effects. Also count the bytes of the world's arrays for each choice.

    The steps are timed in several rounds, each in random order. sides: result of choices_of(moment). report(name,
    {field of EffectTotal: value}) is called with the bytes first, and with the times after each round. The function
    returns early when goes_on() is False. seed: seed of the random order.
    """
    chance = Random(seed)
    spent: dict[str, list[float]] = {name: [] for name in sides}
    for name, side in sides.items():
        world = world_under(moment, side)
        for _ in range(2):  # compiles missing kernels, and lets the tables grow
            world.step()
        report(name, {"effects": len(side.effects.names()), "bytes": bytes_of(world)})
    order = list(sides)
    for _ in range(RUNS):
        chance.shuffle(order)
        for name in order:
            if not goes_on():
                return
            spent[name].append(seconds_a_step(world_under(moment, sides[name]).step, STEPS))
        for name in sides:
            report(name, {"time": Cost.of(spent[name], STEPS)})


def measure_starts(
    order: Mapping[str, Any],
    sides: Mapping[str, Side],
    report: Callable[[str, dict[str, Any]], object],
    goes_on: Callable[[], bool],
) -> None:
    """Measure how long a new process takes to build a world and to make its first step, for each choice of effects.

    order: {"snapshot": file, "broadphase": name}; sides: result of choices_of() for that snapshot. report(name,
    {"start": seconds}) is called for each choice. The first process of a choice is not counted, because it may have to
    compile kernels. The function returns early when goes_on() is False.
    """
    for name, side in sides.items():
        asked = json.dumps([order["snapshot"], order["broadphase"], side.effects.names(), side.idle])
        found = []
        for turn in range(STARTS):
            if not goes_on():
                return
            process = start_module(f"{__package__}.first_step")
            try:
                line, _ = process.communicate(asked + "\n")
            finally:
                end_all([process])
            if turn:
                found.append(float(line.split()[-1]))  # libraries may print greetings
        report(name, {"start": min(found)})


def bytes_of(root: object) -> int:
    """Return the total size [bytes] of the arrays that `root` (usually a world) refers to.

    Each memory block counts once.
    """
    blocks: dict[int, int] = {}
    seen: set[int] = set()
    todo: list[Any] = [root]
    while todo:
        one = todo.pop()
        if id(one) in seen or isinstance(one, (str, bytes, type, int, float)):
            continue
        seen.add(id(one))
        if isinstance(one, np.ndarray):
            while isinstance(one.base, np.ndarray):
                one = one.base
            blocks[id(one)] = one.nbytes
        elif isinstance(one, dict):
            todo.extend(one.values())
        elif isinstance(one, (list, tuple, set, frozenset)):
            todo.extend(one)
        elif type(one).__module__.split(".")[0] == World.__module__.split(".")[0]:
            todo.extend(vars(one).values() if hasattr(one, "__dict__") else ())
            todo.extend(getattr(one, name) for name in _slots(type(one)) if hasattr(one, name))
    return sum(blocks.values())


def _slots(kind):
    """Return the names of all slots of the class `kind` and its base classes."""
    return [name for each in kind.__mro__ for name in getattr(each, "__slots__", ()) if name != "__dict__"]


def bars_of(totals: Mapping[str, EffectTotal]) -> list[BarRow]:
    """Return the rows of a table of bars. There is a row for each choice of effects, and a column for each of FIELDS.

    The text of a time is UNSURE_CELL if its difference from that of the declared choice is less than the noise of both.
    The text of a missing value is "...".
    """
    declared = totals.get(DECLARED, EffectTotal(0))
    rows = []
    for name in NAMES:
        total = totals.get(name, EffectTotal(0))
        cells = [(total.value(field), _text(total, declared, field)) for field in FIELDS]
        rows.append(BarRow(name, COLORS[name], cells))
    return rows


def _text(total, declared, field):
    value, time, other = total.value(field), total.time, declared.time
    if value is None:
        return "..."
    if field == "time" and total is not declared and other is not None:
        noise = sum(each.median - each.least for each in (time, other))
        if abs(time.least - other.least) <= noise:
            return UNSURE_CELL
    return f"{SCALES[field] * value:,.0f}"


def _ratio(seconds, others):
    """Return others / seconds, of the numbers that the table of bars shows: whole microseconds, if these are not 0."""
    shown = [round(SCALES["time"] * each) for each in (seconds, others)]
    return shown[1] / shown[0] if shown[0] else others / seconds


def sentence_of(totals: Mapping[str, EffectTotal]) -> str:
    """Return a sentence on the time of declaring all effects; "" if the times are not measured yet.

    All effects are compared with the declared ones. If the scene declares all, these are compared with the fewest
    possible. The sentence gives the ratio of the least times, as the table of bars shows them. Of a difference within
    the noise it says that it cannot be told apart.
    """
    declared, every, none = (totals.get(name, EffectTotal(0)) for name in NAMES)
    every, other = (every, declared) if declared.effects < every.effects else (declared, none)
    times = other.value("time"), every.value("time")
    if times[0] is None or times[1] is None:
        return ""
    less = other.effects or "none"
    if _text(every, other, "time") == UNSURE_CELL:
        return f"Declaring all {every.effects} effects: the time {UNSURE} from that of {less}."
    return f"Declaring all {every.effects} effects takes {_ratio(*times):.1f} x the time of {less}."
