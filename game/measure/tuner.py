"""Tuner: automatic application of the advice on settings while the player plays.

A setting is applied only if it was confirmed on the recorded run and is certainly faster (advice.is_cheaper). So noise
does not cause changes back and forth.
"""

from collections.abc import Callable
from typing import NamedTuple

from game.measure.advice import advised, share
from game.measure.setting import Setting
from game.measure.survey import Survey


class Decision(NamedTuple):
    """A decision of the tuner to change the setting, applied or refused."""

    frame: int  # of the scene
    before: Setting
    after: Setting
    share: float  # time of `after` as a share of the time of `before`
    refused: str  # reason why the scene refused it; "" if it was applied


class Tuner:
    """Automatic application of a survey's advice on settings. on: whether the tuner is active, False at first.

    apply(setting) applies a setting. It returns the reason for a refusal, or "" if the setting was applied.
    prove(setting) tests a setting on the recorded run. It returns the time as a share of the present time, or None
    while the test is running. If the advice is withdrawn, it returns a text with the reason.
    """

    def __init__(
        self, survey: Survey, apply: Callable[[Setting], str], prove: Callable[[Setting], float | str | None]
    ) -> None:
        self.survey, self.apply, self.prove = survey, apply, prove
        self.on = False
        self.decisions: list[Decision] = []

    def step(self, frame: int, here: Setting) -> Decision | None:
        """Apply the present advice if it is confirmed, unless it was refused before.

        Return the Decision, or None if no decision was made. frame: frame of the scene; here: the current setting.
        """
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
