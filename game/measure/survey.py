"""Survey of a scene's settings: their measured costs and errors, collected run by run.

Each setting is drawn as a dot in a plot.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from game.drawing.number_text import count_text
from game.measure.errors import VISIBLE, Error, Verdicts, exact_tier
from game.measure.pareto_front import TIE, cheaper, pareto_front
from game.measure.setting import Setting
from game.measure.timing import RUNS, Cost
from game.measurement_requests import STEPS

LEAST_HITS = 20  # hits that boxes must have reported before their rate of false hits is stated


@dataclass
class Dot:
    """Measurements of one setting, drawn as a dot in the plot of cost and error.

    Runs start from several snapshots, which are numbered. spent: {number of a snapshot: seconds per step of each run}.
    errors: {number of a snapshot: {kind: Error}}.

    Only finished snapshots count, which have at least RUNS runs. A snapshot that is being measured changes nothing.
    Values pooled over the snapshots are cached, because the plot reads each several times per frame.
    """

    setting: Setting
    spent: dict[int, list[float]] = field(default_factory=dict)
    errors: dict[int, dict[str, Error]] = field(default_factory=dict)
    steps: int = 0  # of one run
    _known: dict[Any, Any] = field(default_factory=dict)  # cached results: "cost", and ("error", kind)

    def took(self, moment: int, seconds: float) -> None:
        """Add the result of one timed run.

        moment: number of the snapshot from which the run started; seconds: mean time of its steps [s].
        """
        self.spent.setdefault(moment, []).append(seconds)
        self._known.clear()

    def erred(self, moment: int, errors: dict[str, Error]) -> None:
        """Set the errors of the runs from a snapshot. moment: number of the snapshot; errors: {kind: Error}."""
        self.errors[moment] = errors
        self._known.clear()

    @property
    def cost(self) -> Cost | None:
        """Time per step [s], averaged over the finished snapshots, as a Cost; None if no snapshot is finished."""
        if "cost" not in self._known:
            self._known["cost"] = self._pooled_cost()
        return self._known["cost"]

    def error(self, kind: str) -> Error | None:
        """Return the Error of the kind `kind`, pooled over the finished snapshots; None if unknown."""
        if ("error", kind) not in self._known:
            self._known["error", kind] = self._pooled_error(kind)
        return self._known["error", kind]

    def _pooled_cost(self):
        costs = [Cost.of(self.spent[moment], self.steps) for moment in self.finished]
        if not costs:
            return None
        n = len(costs)
        least, middle, upper = (sum(each[place] for each in costs) / n for place in range(3))
        return Cost(least, middle, upper, sum(cost.runs for cost in costs), self.steps)

    @property
    def finished(self) -> list[int]:
        """The numbers of the snapshots from which the setting has at least RUNS runs."""
        return [moment for moment, runs in self.spent.items() if len(runs) >= RUNS]

    def _pooled_error(self, kind):
        found = [self.errors[moment] for moment in self.finished if kind in self.errors.get(moment, ())]
        found = [errors[kind] for errors in found]
        if not found:
            return None
        failures = sum((Counter(each.failures) for each in found), Counter())
        floor, steps = max(each.floor for each in found), min(each.steps for each in found)
        verdicts = [each.verdicts for each in found if each.verdicts is not None]
        if verdicts:
            reported = frozenset().union(*(each.reported for each in verdicts))
            true = frozenset().union(*(each.true for each in verdicts))
            return Error.of(Verdicts(reported, true, all(each.own for each in verdicts)), steps, failures)
        return Error(sum(each.value for each in found) / len(found), floor, steps, failures)


class Survey:
    """Measurements of one scene, and conclusions from them.

    dots: a Dot for each setting, in the order of their first result.
    """

    def __init__(self) -> None:
        self.dots: dict[Setting, Dot] = {}
        self.kinds: tuple[str, ...] = ()
        self.moments = 0
        self.planned = 0  # settings that are being measured
        # Encounters in the whole recorded run, by tier, which replace those at the moments. {}: no run was recorded.
        self.encounters: dict[str, Verdicts] = {}

    @property
    def first(self) -> Setting:
        """The setting that was measured first, which is the setting of the running scene."""
        return next(iter(self.dots))

    def dot(self, setting: Setting) -> Dot:
        """Return the Dot of a setting. If there is none, a new one is added."""
        return self.dots.setdefault(setting, Dot(setting))

    def error(self, setting: Setting, kind: str) -> Error | None:
        """Return the Error of the kind `kind` of a measured setting; None if it is unknown.

        An error in pixels is pooled over all finished snapshots. So is an error in wrong answers, unless the encounters
        of the whole recorded run are known. Then those are used instead.
        """
        error = self.dots[setting].error(kind)
        verdicts = self.encounters.get(setting.tier or "") if setting.narrowphase else None
        if error is None or error.verdicts is None or verdicts is None:
            return error
        return Error.of(verdicts, error.steps, error.failures)

    def known(self, kind: str) -> dict[Setting, tuple[Cost, Error]]:
        """Return {setting: (Cost, Error)} of all settings that have a cost and an error of the kind `kind`.

        A setting has both once its first snapshot is finished.
        """
        found = {}
        for setting, dot in self.dots.items():
            cost, error = dot.cost, self.error(setting, kind)
            if cost is not None and error is not None:
                found[setting] = cost, error
        return found

    def pareto_front(self, kind: str) -> list[Setting]:
        """Return the settings on the Pareto front of cost and error, cheapest first. kind: kind of error.

        Errors below their floor count as 0.
        """
        return pareto_front({s: (cost.median, reported_error(error)) for s, (cost, error) in self.known(kind).items()})

    def progress(self) -> str:
        """Return a line of text on what is measured: the number of settings, or the number of runs before."""
        finished = [len(dot.finished) for dot in self.dots.values()]
        measured = sum(count > 0 for count in finished)
        if measured < max(self.planned, 1):
            runs = sum(min(len(runs), RUNS) for dot in self.dots.values() for runs in dot.spent.values())
            return f"measuring, {runs} of {max(self.planned, len(self.dots)) * RUNS} runs"
        moments = f"{count_text(max(finished), 'moment')} of {STEPS} steps"
        return f"{count_text(measured, 'setting')} measured, {RUNS} runs each from {moments}"

    def finding(self, kind: str, here: Setting, proven: Setting | None = None) -> str:
        """Return one sentence that compares the setting `here` with the others by cost and by the error `kind`.

        Return "" if too few settings are measured. Two errors count as different only if their intervals do not
        overlap. proven: the cheaper setting that was tested on the whole recorded run, None for none. Only this setting
        is reported as cheaper.
        """
        known = self.known(kind)
        if here not in known or len(known) < 2:
            return ""
        if kind == "verdict" and self.hits_seen() < LEAST_HITS:
            return f"no finding yet: {self.hits_seen()} of {LEAST_HITS} hits seen"
        cost, error = known[here]
        least, most = error.interval
        sound = {s: (c, e) for s, (c, e) in known.items() if is_sound(e)}
        as_good = {s: c for s, (c, e) in sound.items() if e.interval[1] <= (1.0 + TIE) * most}
        best = min(as_good, key=lambda s: as_good[s].median, default=here)
        if best != here and cheaper(as_good[best][:2], cost[:2]):
            if best != proven:
                return "nothing as exact has proved cheaper over a whole run"
            share = as_good[best].median / cost.median
            return f"{best.label(here)}: as exact in {share:.2f} x the time"
        exacter = {s: (c, e) for s, (c, e) in sound.items() if e.interval[1] < (1.0 - TIE) * least}
        better = {s: e for s, (c, e) in exacter.items() if not cheaper(cost[:2], c[:2])}
        if better:
            best = min(better, key=lambda s: reported_error(better[s]))
            return f"{best.label(here)}: {shown(better[best])} instead of {shown(error)}, and no dearer"
        if exacter and reported_error(error) > VISIBLE:
            best = min(exacter, key=lambda s: exacter[s][0].median)
            price = exacter[best][0].median / cost.median
            return f"here {shown(error)}; {best.label(here)} has {shown(known[best][1])} for {price:.2f} x the time"
        return f"nothing as exact ({shown(error)}) is cheaper by more than the noise"

    def hits_seen(self) -> int:
        """Return the number of encounters from which rates of wrong answers are known.

        In a scene with collision tiers, these are the hits that boxes reported, at the moments or in the whole recorded
        run. Otherwise it is the greatest number that one setting has.
        """
        if "aabb" in self.encounters:
            return self.encounters["aabb"].wrong.total
        verdicts = {s: e.verdicts for s, (_, e) in self.known("verdict").items() if e.verdicts is not None}
        if self.has_tiers:
            return max((each.wrong.total for s, each in verdicts.items() if s.tier == "aabb"), default=0)
        return max((each.either.total for each in verdicts.values()), default=LEAST_HITS)

    @property
    def has_tiers(self) -> bool:
        """Whether collision tiers are measured."""
        return bool(self.dots) and self.first.tier is not None

    def can_judge_tiers(self) -> bool:
        """Return whether LEAST_HITS hits were seen, which judging collision tiers needs. True without tiers."""
        return not self.has_tiers or self.hits_seen() >= LEAST_HITS

    def boxes_and_pixels(self) -> str:
        """Return a sentence on the rate of false hits of boxes, and on the time that pixels cost.

        Return "" for a scene without collision tiers. Before boxes have reported LEAST_HITS encounters, the sentence
        reports the progress of the measurement.
        """
        known = self.known("verdict")
        tiers = {setting.tier: setting for setting in known if self._is_tier_alone(setting)}
        boxes, pixels = tiers.get("aabb"), tiers.get(exact_tier(self.first.tier or "")) if self.dots else None
        if boxes is None or pixels is None:
            return ""
        (cost, error), (exact, _) = known[boxes], known[pixels]
        wrong = error.wrong
        if wrong is None or not self.can_judge_tiers():
            return f"Boxes and pixels: measuring, {self.hits_seen()} of {LEAST_HITS} hits by boxes."
        low, high = (round(100 * each) for each in wrong.interval)
        apart = cheaper(cost[:2], exact[:2]) or cheaper(exact[:2], cost[:2])
        price = f"{exact.median / cost.median:.2f} x the time" if apart else "the same time"
        false = f"{100 * wrong.share:.0f} of 100 hits are false ({low} to {high})"
        return f"Boxes: {false}. Pixels: none, for {price}."

    def _is_tier_alone(self, setting):
        """Return whether a setting differs from the first measured setting at most in its collision tier."""
        return set(setting.differs(self.first)) <= {"tier"}


def own_sentence(hits: Mapping[str, int], tier: str | None) -> str:
    """Return a sentence on the player's own hits: how many hits of the bounding box are false.

    The bounding box contains the collision shapes of every tier. Therefore a hit of the box is false if the player's
    shape (the hull) is not hit. hits: counts of both, as in Scene.own_hits; tier: collision tier of the hull, or None.
    Return "" without counts, or if the tier of the hull is not exact.
    """
    boxes, hull = hits.get("box", 0), hits.get("hull", 0)
    if not boxes or tier not in ("pixels", "mask"):
        return ""
    return f"You, as counted in the picture: {boxes - hull} of {boxes} hits by your box are false."


def reported_error(error: Error) -> float:
    """Return the value of an Error, or 0 if it is not above its floor, the uncertainty of its reference."""
    return error.value if error.above_floor else 0.0


def shown(error: Error) -> str:
    """Return an Error in words: the number of wrong answers among all encounters, or pixels."""
    if error.verdicts is not None:
        rate = error.verdicts.either
        return f"{rate.count} of {rate.total} wrong" if rate.total else "no hit yet"
    if error.above_floor:
        return f"{error.value:.2g} px"
    return f"less than {error.floor:.2g} px" if error.floor else "0 px"


def is_sound(error: Error) -> bool:
    """Return whether the runs that gave this error had no failures."""
    return not any(error.failures.values())
