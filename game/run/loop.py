"""Fixed time step: real time is converted into whole steps of 1/60 s. The remaining fraction of a step is called alpha.

Time is read from perf_counter. pygame's Clock.tick(60) counts whole milliseconds, and thus gives 62 frames per second.
"""

from game.scene import STEP_SECONDS

LONGEST_FRAME = 0.25  # [s] limit of a stall (window drag, debugger), so that its steps need not be made up for
WORST_LOAD = 2.0  # limit of a frame's load, so that a single long frame does not slow the next ones
SMOOTHING = 0.2  # weight of the last frame in the mean load
SPEEDS = (1.0, 0.5, 0.25, 0.1, 0.05)  # slow motion, as fractions of real time


class FixedStep:
    """Accumulator of real time.

    advance(now) returns the number of due steps. alpha is the remaining fraction of a step.
    """

    def __init__(self, step: float = STEP_SECONDS) -> None:
        self.step = step
        self.speed = 1.0  # slow motion, for looking closely
        self.game_speed = 1.0  # game speed that the player chose
        self.paused = False
        self.accumulator = 0.0
        self.before = None
        self.requested = 0
        self.due = 0  # steps of the last frame
        self.load: float | None = None  # mean ratio of the time that frames take to the time of their steps

    def advance(self, now: float) -> int:
        """Return the number of steps that are due at `now` [s, perf_counter]. The first call only starts the clock."""
        passed = 0.0 if self.before is None else min(max(now - self.before, 0.0), LONGEST_FRAME)
        self.before = now
        if self.paused:
            due, self.requested = self.requested, 0
            self.accumulator = 0.0
            return due
        self.accumulator += passed * self.speed * self.game_speed
        self.due = int(self.accumulator / self.step)
        self.accumulator -= self.due * self.step
        if self.behind and self.due > 1:
            self.due, self.accumulator = 1, 0.0
        return self.due

    @property
    def behind(self) -> bool:
        """Whether the machine is too slow to make the steps in time.

        If it is, the game slows down to one step per frame, so that steps do not pile up.
        """
        return self.load is not None and self.load > 1.0

    def note(self, busy: float) -> None:
        """Record the time [s] that the steps and the picture of this frame took."""
        if not self.due:  # a frame without steps does not measure their time; until one does, make one step per frame
            self.load = WORST_LOAD if self.load is None else self.load
            return
        load = min(busy / (self.step * self.due), WORST_LOAD)
        self.load = load if self.load is None else self.load + (load - self.load) * SMOOTHING

    def rest(self) -> None:
        """Stop counting time until the next advance(). This is called when another screen is shown."""
        self.before = None
        self.requested = 0

    @property
    def alpha(self) -> float:
        """Position between the previous step (0) and the last step (1) for interpolation in drawing; 1 while paused."""
        return 1.0 if self.paused else self.accumulator / self.step

    def request_step(self) -> None:
        """Request a single step while the clock is paused. The next advance() then returns 1."""
        self.requested += 1

    def slower(self) -> None:
        """Select the next slower speed."""
        self.speed = SPEEDS[min(SPEEDS.index(self.speed) + 1, len(SPEEDS) - 1)]

    def faster(self) -> None:
        """Select the next faster speed, up to real time."""
        self.speed = SPEEDS[max(SPEEDS.index(self.speed) - 1, 0)]
