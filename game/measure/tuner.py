"""Tuner: applies the advice on settings automatically while the player plays.

A setting is applied only if it has proved itself on the recorded run, and is faster over the whole interval of its runs
(advice.is_cheaper). So noise does not undo decisions.
"""

from collections.abc import Callable
from typing import NamedTuple

from game.measure.advice import advised, share
from game.measure.setting import Setting
from game.measure.survey import Survey


class Decision(NamedTuple):
    """A change of settings by the tuner."""

    frame: int  # of the scene
    before: Setting
    after: Setting
    share: float  # time of `after` as a share of the time of `before`
    refused: str  # reason why the scene refused it; "" if it was applied


class Tuner:
    """Automatic use of a survey's advice on settings. on: whether it is in use, False at first.

    apply(setting) applies a setting. It returns the reason for a refusal, or "" if the setting was applied.
    prove(setting) tries a setting on the recorded run. It returns the time as a share of the present time, a text with
    the reason why the advice is withdrawn, or None while it is being tried.
    """

    def __init__(
        self, survey: Survey, apply: Callable[[Setting], str], prove: Callable[[Setting], float | str | None]
    ) -> None:
        self.survey, self.apply, self.prove = survey, apply, prove
        self.on = False
        self.decisions: list[Decision] = []

    def step(self, frame: int, here: Setting) -> Decision | None:
        """Apply the present advice, unless it was refused before. Return the decision, None if there is none."""
        if not self.on:
            return None
        best = advised(self.survey, here)
        if best is None or any(each.after == best and each.refused for each in self.decisions):
            return None
        proof = self.prove(best)
        if proof is None:
            return None
        if isinstance(proof, str):
            decision = Decision(frame, here, best, share(self.survey, best, here), proof)
        else:
            decision = Decision(frame, here, best, proof, self.apply(best))
        self.decisions.append(decision)
        return decision
