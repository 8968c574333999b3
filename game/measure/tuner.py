"""The tuner: takes the advice by itself, as it comes, while somebody plays.

It changes the settings only where the whole interval of the runs is cheaper, at every moment that was measured: what it
decides is not taken back by noise.
"""

from collections.abc import Callable
from typing import NamedTuple

from game.measure.advice import advised, share
from game.measure.setting import Setting
from game.measure.survey import Survey


class Decision(NamedTuple):
    """What the tuner did."""

    frame: int  # of the scene
    before: Setting
    after: Setting
    share: float  # its time by that before
    refused: str  # why the scene did not take it, "": it did


class Tuner:
    """apply(setting): puts it to work, and tells why not, "" where it did. Off at first."""

    def __init__(self, survey: Survey, apply: Callable[[Setting], str]) -> None:
        self.survey, self.apply = survey, apply
        self.on = False
        self.decisions: list[Decision] = []

    def step(self, frame: int, here: Setting) -> Decision | None:
        """Take the advice that there is, once for what the scene refuses. Returns what was decided now."""
        if not self.on:
            return None
        best = advised(self.survey, here)
        if best is None or any(each.after == best and each.refused for each in self.decisions):
            return None
        decision = Decision(frame, here, best, share(self.survey, best, here), self.apply(best))
        self.decisions.append(decision)
        return decision
