"""Machine: base class of the machines of lab/joints. A machine is built on a floor in a world of its own.

The floor is at y = 0, and the view reaches from x = -240 to 240 and up to y = -194. Lengths are in pixels, 32 to the
metre.
"""

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.colors import GOLD, INK, PAPER, RED
from game.drawing.presenter import Frame, Lens
from game.measure.moment import FREE, LENGTH, PINNED, widest_gap
from physics import Body, Joint, Material, Polygon, World, debug

METER = 32.0  # [px]
GRAVITY = 9.8 * METER  # [px/s2] of a world by default
HALF, HIGH = 240.0, 194.0  # [px] of the view, from the middle and above the floor
FLOOR_DEPTH = 64.0
WEAK = 1.0  # [mass px/s2, and px2/s2] of smash(): far below any weight here
APART = 0.5  # [px] from which the gap of a pin is drawn red
WOOD, STEEL, TEAL, CORAL, VIOLET, GOLDEN = "wood", "steel", "teal", "coral", "violet", "gold"  # names of RAMPS


class Machine:
    """A machine of bodies and joints in a world.

    paints: {body id: name of its colours}; broken: number of joints that have broken; worst: greatest separation of a
    joint [px] before any joint was dragged or broken; recent: greatest separation in the last step [px]; steps: number
    of steps so far.
    """

    name: ClassVar[str]
    seen: ClassVar[str]  # one line: what it is, and what moves it
    starts: ClassVar[str]  # what its motor does
    breaks: ClassVar[str]  # what the key for breaking does
    needs_motor: ClassVar[bool] = True  # whether the motor runs from the start

    def __init__(self, world: World) -> None:
        self.world = world
        self.paints: dict[int, str] = {}
        self.grounds: list[int] = []  # ids of the static bodies
        self.weak: list[Joint] = []  # joints that smash() breaks
        self.steps = self.broken = 0
        self.worst = self.recent = 0.0
        self.running = self.disturbed = False
        self.add_floor()
        self.build()
        if self.needs_motor:
            self.run(True)

    def build(self) -> None:
        """Add the machine's bodies and joints to its world."""
        raise TypeError(f"{type(self).__name__} must define build")

    def drive(self) -> None:
        """Set the motors: on if `running` is True, otherwise off or braking. Called by run() and control()."""

    def control(self) -> None:
        """Apply forces or change motors before each step. Most machines do nothing."""

    def measure(self) -> None:
        """Update the machine's own figures after each step. Most machines have none."""

    def figure(self) -> str:
        """Return the machine's own figure as short text, or "" if it has none."""
        return ""

    def figures(self) -> Sequence[float]:
        """Return the numbers that measure() has recorded, for the state of the scene."""
        return ()

    @classmethod
    def goals(cls, iterative: Sequence[float] | None, direct: Sequence[float] | None) -> list[tuple[str, bool, str]]:
        """Return the machine's goals, a list of (name, whether it is met, detail).

        iterative, direct: results (widest gap [px], joints broken, *figures()) with each joint solver, None before it
        has run.
        """
        raise TypeError(f"{cls.__name__} must define goals")

    def handle(self) -> tuple[float, float]:
        """Return the world point (x, y) [px] at which the bot drags the machine."""
        raise TypeError(f"{type(self).__name__} must define handle")

    def draw_behind(self, canvas: Canvas, camera: Camera, alpha: float) -> None:
        """Draw parts of the machine that are behind its bodies on the canvas. Most machines draw nothing.

        alpha: position (0..1) between the last two steps.
        """

    def draw(self, canvas: Canvas, camera: Camera, alpha: float) -> None:
        """Draw parts of the machine that are in front of its bodies on the canvas. Most machines draw nothing.

        alpha: position (0..1) between the last two steps.
        """

    def draw_on_frame(self, frame: Frame, lens: Lens) -> None:
        """Draw the rods, ropes and pins at window resolution, at the poses of the last step.

        A pin is a dot at each of a joint's two anchors. If the anchors are more than APART apart, a red line joins
        them. lens: transform of world points to frame points.
        """
        width = max(1, frame.scale - 1)
        rows = debug.joints(self.world)
        starts = np.column_stack(lens.points(rows["ax"], rows["ay"])).tolist()
        ends = np.column_stack(lens.points(rows["bx"], rows["by"])).tolist()
        for start, end, hold, coordinate, gap in zip(
            starts, ends, rows["hold"].tolist(), rows["coordinate"].tolist(), self.world.joints["separation"].tolist(),
            strict=True,
        ):  # fmt: skip
            if hold == FREE and coordinate == LENGTH:
                pygame.draw.line(frame.surface, INK, start, end, width + 2)
                pygame.draw.line(frame.surface, PAPER, start, end, width)
            elif hold == PINNED:
                for place in (start, end):
                    pygame.draw.circle(frame.surface, INK, place, 2.0 * frame.scale)
                if gap > APART:
                    pygame.draw.line(frame.surface, RED, start, end, 2 * frame.scale)
                for place in (start, end):
                    pygame.draw.circle(frame.surface, RED if gap > APART else GOLD, place, 1.2 * frame.scale)

    def run(self, on: bool) -> None:
        """Start the motors if `on` is True, otherwise stop them."""
        self.running = on
        self.drive()

    def smash(self) -> None:
        """Lower the breaking force of the weak joints to WEAK, so that they break under their load."""
        self.disturbed = True
        for joint in self.weak:
            if self.holds(joint):
                joint.breaks = (WEAK, WEAK)

    def holds(self, joint: Joint) -> bool:
        """Return whether a joint is still in the world."""
        return bool((self.world.joints["id"] == joint.id).any())

    def step(self) -> None:
        """Make one step of the machine's world, and measure it."""
        self.control()
        self.world.step()
        self.note()

    def note(self) -> None:
        """Measure the last step: count broken joints, and update the gaps and the machine's own figures.

        A caller that steps the world itself calls control() before the step and note() after it.
        """
        self.steps += 1
        self.broken += len(self.world.events.broken)
        self.recent = widest_gap(self.world)
        if not self.disturbed and not self.broken:
            self.worst = max(self.worst, self.recent)
        self.measure()

    def add_floor(self) -> None:
        """Add the floor, and two walls outside the view."""
        rough = Material(friction=0.9)
        floor = Polygon.box(4 * HALF, FLOOR_DEPTH)
        self.grounds.append(self.world.add_body(floor, position=(0, FLOOR_DEPTH / 2), kind="static", material=rough).id)
        for side in (-1, 1):
            self.fixed(Polygon.box(FLOOR_DEPTH, 3 * HIGH), side * (HALF + FLOOR_DEPTH / 2), -1.5 * HIGH + 20)

    def add(self, shape: Any, x: float, y: float, paint: str, **more: Any) -> Body:
        """Add a body with a shape at (x, y) [px], drawn in the colours `paint`, and return it.

        more: further arguments of World.add_body.
        """
        body = self.world.add_body(shape, position=(x, y), **more)
        self.paints[body.id] = paint
        return body

    def fixed(self, shape: Any, x: float, y: float, **more: Any) -> Body:
        """Add a static body with a shape at (x, y) [px], and return it. It is drawn as earth with grass on it.

        more: further arguments of World.add_body.
        """
        body = self.world.add_body(shape, position=(x, y), kind="static", **more)
        self.grounds.append(body.id)
        return body
