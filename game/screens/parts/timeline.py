"""Control of rewinding. Holding Backspace moves back. While the game is frozen, a bar shows the last ten seconds."""

from collections.abc import Callable

import pygame

from game.drawing.canvas import SMALL, TEXT
from game.drawing.colors import DUSK, FOG, GOLD, INK, PAPER, SKY, SLATE
from game.drawing.presenter import Frame
from game.input.devices import DeviceSource
from game.run.rewind import STEPS, Rewind

SPEEDS = ((1.0, 1.0), (2.5, 2.0), (60.0, 4.0))  # (held for less than [s], multiple of the playing speed)
REPEAT = 0.35  # [s] before a held arrow repeats
MANY = 10  # steps of an arrow key with Shift
LEAST_WIDTH = 360  # [text px] that the bar needs
BAR_HEIGHT = 24  # [text px]
MOST_CUT = 12  # [text px] height of text lines above the bar that are hidden if the bar covers a part of them
KEYS_LINE = "\u2190 \u2192 a step   Shift ten   Backspace runs back   P plays on from here"
BACK_KEY = pygame.K_BACKSPACE
WAYS = {pygame.K_LEFT: -1, pygame.K_RIGHT: 1}
PAD_WAYS = {"dpad left": -1, "dpad right": 1}
PAD_RUNS = {"left shoulder": -1, "right shoulder": 1}


class Timeline:
    """Control of a Rewind. feed() processes events, and turn() moves to the chosen step.

    went() is called after each move.
    """

    def __init__(self, rewind: Rewind, went: Callable[[], None] = lambda: None) -> None:
        self.rewind, self.went = rewind, went
        self.control: object = None  # the held key or button
        self.way, self.since, self.before, self.owed = 0, 0.0, 0.0, 0.0
        self.asked: int | None = None  # a step chosen by mouse or tap
        self.dragging = False
        self.bar = pygame.Rect(0, 0, 0, 0)  # of the last picture

    @property
    def runs(self) -> bool:
        """Whether Backspace is held to move back. The game then makes no steps."""
        return self.control == BACK_KEY

    def let_go(self) -> None:
        """Forget all held keys, and the step chosen with the mouse or a key."""
        self.control, self.dragging, self.asked = None, False, None

    def feed(self, event: pygame.event.Event, devices: DeviceSource, frozen: bool, now: float) -> bool:
        """Process an event. Return whether the event was used.

        devices: source that translates pad events into button names; frozen: whether the game is frozen; now: time of
        the last turn() [s].
        """
        button = devices.button_of(event)
        if event.type == pygame.KEYUP:
            return self._release(event.key)
        if button is not None:
            return frozen and self._pad(button, now)
        if event.type == pygame.KEYDOWN and event.key == BACK_KEY:
            self._hold(BACK_KEY, -1, 0.0, now)
        elif frozen and event.type == pygame.KEYDOWN and event.key in WAYS:
            steps = MANY if getattr(event, "mod", 0) & pygame.KMOD_SHIFT else 1
            self._tap(event.key, WAYS[event.key] * steps, now)
        elif frozen and event.type == pygame.MOUSEBUTTONDOWN and event.button == 1 and self._hit(event.pos):
            self.dragging = True
            self._point(event.pos)
        elif self.dragging and event.type == pygame.MOUSEMOTION:
            self._point(event.pos)
        elif self.dragging and event.type == pygame.MOUSEBUTTONUP and event.button == 1:
            self.dragging = False
        else:
            return False
        return True

    def _pad(self, button, now):
        _, name, down = button
        if not down:
            return self._release(name)
        if name in PAD_RUNS:
            self._hold(name, PAD_RUNS[name], 0.0, now)
        elif name in PAD_WAYS:
            self._tap(name, PAD_WAYS[name], now)
        return name in PAD_RUNS or name in PAD_WAYS

    def _hold(self, control, way, delay, now):
        if self.control != control:
            self.control, self.way, self.owed = control, way, 0.0
            self.since = self.before = now + delay

    def _tap(self, control, steps, now):
        self._hold(control, steps, REPEAT, now)
        self.asked = (self.rewind.position if self.asked is None else self.asked) + steps

    def _release(self, control):
        if self.control != control:
            return False
        self.control = None
        return True

    def _hit(self, position):
        return self.bar.inflate(0, self.bar.height).collidepoint(position)

    def _point(self, position):
        share = (position[0] - self.bar.x) / max(self.bar.width, 1)
        self.asked = self.rewind.end - round((1.0 - max(0.0, min(1.0, share))) * STEPS)

    def go(self, steps: int) -> None:
        """Move forward by `steps` steps, or back if the number is negative."""
        before = self.rewind.position
        self.rewind.seek(before + steps)
        if self.rewind.position != before:
            self.went()

    def turn(self, now: float, frozen: bool) -> bool:
        """Move to the step chosen with keys or mouse, at `now` [s]. Return whether Backspace is held to move back.

        Keys and mouse have effect only while the game is frozen, Backspace always. While Backspace is held, the game
        must make no steps.
        """
        if not frozen and not self.runs:
            self.let_go()
        goal = self._goal(now)
        if goal is not None:
            self.go(goal - self.rewind.position)
        return self.runs

    def _goal(self, now):
        goal, self.asked = self.asked, None
        if self.control is not None and now > self.before:
            held = now - self.since
            speed = next((times for seconds, times in SPEEDS if held < seconds), SPEEDS[-1][1])
            self.owed += (now - self.before) * 60.0 * (speed if abs(self.way) == 1 else 1.0)
            self.before = now
            whole = int(self.owed)
            self.owed -= whole
            if whole:
                goal = (self.rewind.position if goal is None else goal) + self.way * whole
        return goal

    def reserve(self, frame: Frame) -> None:
        """Reserve the rectangle of the bar, so that other text avoids it."""
        frame.reserve(self._rect(frame))

    def _rect(self, frame):
        high = BAR_HEIGHT * frame.scale_for(LEAST_WIDTH)
        area = frame.area.clip(frame.rect)
        return pygame.Rect(area.x, area.bottom - high, area.width, high)

    def draw(self, frame: Frame) -> None:
        """Draw the bar of the last ten seconds, with the reachable part, the key frames and the current step."""
        scale, rect, rewind = frame.scale_for(LEAST_WIDTH), self._rect(frame), self.rewind
        covered = [box for box, _ in frame.boxes if rect.colliderect(box)]
        top = min([rect.y, *(box.y - scale for box in covered if rect.y - box.y < MOST_CUT * scale)])
        frame.surface.fill(INK, (rect.x, top, rect.width, rect.bottom - top))  # a line of text is hidden as a whole
        frame.boxes[:] = [each for each in frame.boxes if not rect.colliderect(each[0])]
        y = rect.y + 4 * scale
        earliest = frame.text(f"-{STEPS / 60:.0f} s", rect.x + 4 * scale, y, FOG, TEXT, scale)
        back = (rewind.end - rewind.position) / 60.0
        widest = frame.measure("-10.00 s", TEXT, scale)[0]
        text = f"-{back:.2f} s" if back else "now"
        frame.text(text, rect.right - 4 * scale, y, GOLD if back else PAPER, TEXT, scale, "right")
        left, right = earliest.right + 6 * scale, rect.right - 10 * scale - widest
        self.bar = pygame.Rect(left, rect.y + 3 * scale, right - left, 10 * scale)
        self._draw_bar(frame.surface, scale)
        if frame.measure(KEYS_LINE, SMALL, scale)[0] < rect.width - 8 * scale:
            frame.text(KEYS_LINE, rect.centerx, rect.bottom - 8 * scale, FOG, SMALL, scale, "center")

    def _x(self, step):
        return self.bar.x + self.bar.width * (step - self.rewind.end + STEPS) // STEPS

    def _draw_bar(self, surface, scale):
        rewind, bar = self.rewind, self.bar
        y, high = bar.centery - scale, 2 * scale
        surface.fill(DUSK, (bar.x, y, bar.width, high))
        start, here = self._x(rewind.start), self._x(rewind.position)
        surface.fill(SLATE, (start, y, bar.right - start, high))
        surface.fill(SKY, (start, y, here - start, high))
        for stretch in rewind.stretches:
            if stretch.start >= rewind.start:
                surface.fill(SLATE, (self._x(stretch.start), y - scale, scale, high + 2 * scale))
        surface.fill(PAPER, (here - scale, bar.y + scale, 3 * scale, bar.height - 2 * scale))
