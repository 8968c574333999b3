"""Invariant monitor of a scene: the state of each invariant over all worlds of the scene.

A broken invariant is shown red for AFTERGLOW frames. After that, its state is again that of the latest checks.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from game.invariants.invariant import Broken
from game.invariants.watch import Watch, WatchedWorld, all_invariants

GREY, GREEN, RED = "grey", "green", "red"
AFTERGLOW = 60  # frames for which a state stays red after a break
NO_STEP = "no step was made yet"


@dataclass
class InvariantStatus:
    """State of one invariant: grey (not checked), green (holds), or red (broken now or shortly before).

    reason: why the state is grey; breaks: number of frames with a break since the scene began; last: the last Broken.
    """

    id: str
    word: str
    state: str = GREY
    reason: str = NO_STEP
    breaks: int = 0
    last: Broken | None = None
    last_frame: int = 0

    @property
    def sentence(self) -> str:
        """The state of the invariant as a sentence."""
        if self.state == RED:
            return self.last_report
        text = f"{self.id} {self.word}: " + (f"not asked: {self.reason}" if self.state == GREY else "holds")
        return f"{text}; {self.last_report}" if self.breaks else text

    @property
    def last_report(self) -> str:
        """One line about the last break of the invariant; "" if there was none."""
        return f"frame {self.last_frame}, {self.id}: {self.last.brief}" if self.last is not None else ""


class InvariantMonitor:
    """Monitor of the invariants of a scene. Call take(world) for each world, and note() after each frame.

    strict: whether pairs of concave shapes are also checked. In a strict run, the caller ends the run at the first
    break. The attribute `first` contains this break.
    """

    def __init__(self, strict: bool = False) -> None:
        self.strict = strict
        self.statuses = tuple(InvariantStatus(each.id, each.word) for each in all_invariants())
        self.first: tuple[int, Broken] | None = None  # (frame, first break)
        self.frame = 0
        self.seconds = 0.0  # time of the checks in the last frame

    def take(self, world: WatchedWorld) -> None:
        """Start to check the invariants of `world` after each of its steps."""
        world.watch = Watch(concave=self.strict)

    def note(self, frame: int, worlds: Iterable[WatchedWorld]) -> None:
        """Update the states of the invariants after a frame, from the checks of these worlds.

        frame: number of the frame.
        """
        self.frame, self.seconds = frame, 0.0
        answers = []
        for number, world in enumerate(worlds):
            if world.watch is None:
                self.take(world)
                continue
            found, seconds = world.watch.collect()
            self.seconds += seconds
            if found:
                answers.append((number, found))
        for status in self.statuses:
            self._update(status, [(number, found[status.id]) for number, found in answers])

    def _update(self, status, answers):
        for number, answer in answers:
            if isinstance(answer, Broken):
                status.last, status.last_frame = replace(answer, world=number), self.frame
                status.breaks += 1
                if self.first is None:
                    self.first = self.frame, status.last
                break
        if status.last is not None and self.frame - status.last_frame < AFTERGLOW:
            status.state = RED
        elif any(answer is None for _, answer in answers):
            status.state = GREEN
        elif answers:
            status.state, status.reason = GREY, next(answer.reason for _, answer in answers if answer is not None)
