"""The fixed step: real time goes in, whole steps of 1/60 s come out, the rest is alpha.

pygame's Clock.tick(60) really gives 62 frames a second (it counts whole milliseconds), so time is
taken from perf_counter and never assumed.
"""

from game.scene import STEP_SECONDS

LONGEST_FRAME = 0.25  # [s] a window drag or a debugger may stall us; more would spiral into catching up
WORST_LOAD = 2.0  # of one frame: a single long one does not make the next ones slow
SMOOTHING = 0.2  # of the load, per frame
SPEEDS = (1.0, 0.5, 0.25, 0.1, 0.05)  # slow motion, as fractions of real time


class FixedStep:
    """An accumulator. `advance(now)` returns how many steps are due; `alpha` is the fraction left."""

    def __init__(self, step: float = STEP_SECONDS) -> None:
        self.step = step
        self.speed = 1.0  # slow motion, for looking closely
        self.pace = 1.0  # game speed, as the player wants to be able to follow
        self.paused = False
        self.left_over = 0.0
        self.before = None
        self.requested = 0
        self.due = 0  # steps of the last frame
        self.load: float | None = None  # time that frames take, over the time that their steps stand for; a mean

    def advance(self, now: float) -> int:
        """Whole steps due at `now` [s, perf_counter]. The first call only starts the clock."""
        passed = 0.0 if self.before is None else min(max(now - self.before, 0.0), LONGEST_FRAME)
        self.before = now
        if self.paused:
            due, self.requested = self.requested, 0
            self.left_over = 0.0
            return due
        self.left_over += passed * self.speed * self.pace
        self.due = int(self.left_over / self.step)
        self.left_over -= self.due * self.step
        if self.behind and self.due > 1:
            self.due, self.left_over = 1, 0.0
        return self.due

    @property
    def behind(self) -> bool:
        """Whether this machine cannot make the steps in time. Then time slows down evenly, a step a frame, in place of
        ever more steps that are to be caught up with."""
        return self.load is not None and self.load > 1.0

    def note(self, busy: float) -> None:
        """Take note of how long [s] the steps and the picture of this frame took."""
        if not self.due:  # a picture alone tells nothing of what steps take: until one does, there is one a picture
            self.load = WORST_LOAD if self.load is None else self.load
            return
        load = min(busy / (self.step * self.due), WORST_LOAD)
        self.load = load if self.load is None else self.load + (load - self.load) * SMOOTHING

    def rest(self) -> None:
        """Time does not count until advance() is called again: another screen is in front."""
        self.before = None
        self.requested = 0

    @property
    def alpha(self) -> float:
        """How far drawing is between the step before and the last one, 0..1. Paused: the last one."""
        return 1.0 if self.paused else self.left_over / self.step

    def request_step(self) -> None:
        """One step while paused (single step)."""
        self.requested += 1

    def slower(self) -> None:
        """The next slower speed."""
        self.speed = SPEEDS[min(SPEEDS.index(self.speed) + 1, len(SPEEDS) - 1)]

    def faster(self) -> None:
        """The next faster speed, up to real time."""
        self.speed = SPEEDS[max(SPEEDS.index(self.speed) - 1, 0)]
