"""Belts that run level, upwards and downwards: do all bodies on them reach the belt's speed?

In short: above, belts carry crates by their surface speed. Below, the same belts without the effect carry nothing.

What to see: above, the surfaces of the belts carry boxes, a hexagon, a capsule and a wheel with rolling resistance.
Below, the same belts are in a world without the effect "conveyor", and the same crates stay where they fall. Change the
speed.

Why it matters: A belt moves other bodies and does not move itself; simple imitations jitter on slopes.

To try: set the speed below zero; which bodies stay on the slopes?

Source: Box2D's tangent speed: friction works towards a speed along the surface, not towards rest.
"""

from math import cos, hypot, pi, sin

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import GOLD, GREEN, INK, NIGHT, PAPER, RED, SLATE, faded
from game.drawing.headline import Headline
from game.drawing.number_text import count_text, share_text
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas, load_backdrop
from game.input.inputs import InputFrame
from game.scene import STANDS, Goal, Scene, Slider
from physics import Capsule, Circle, Effects, Material, Polygon
from scenes.lab.pieces import piece
from scenes.lab.yard import HEAD

BELT_RADIUS = 6.0  # [px] of a belt's rollers
BELTS = {  # from, to: centres of the rollers in a view [px]
    "level": ((42.0, 84.0), (140.0, 84.0)),
    "up": ((153.0, 84.0), (253.0, 66.0)),
    "top": ((266.0, 66.0), (346.0, 66.0)),
    "down": ((359.0, 66.0), (443.0, 81.0)),
}
LABEL_AT = {"level": (91, 94), "up": (211, 88), "top": (306, 77), "down": (394, 88)}
STILL_X = (50.0, 72.0, 98.0, 123.0, 300.0)  # [px] place of each kind in the world without the effect
GRIP = Material(friction=0.5)
BRAKED = Material(friction=0.5, rolling_resistance=0.6)  # more than the slope: it is carried, not rolling
KINDS = {  # name: (shape, colours, material)
    "box": (Polygon.box(16, 16), "wood", GRIP),
    "hexagon": (Polygon(((10, 0), (6, 7), (-6, 7), (-10, 0), (-6, -7), (6, -7))), "violet", GRIP),
    "capsule": (Capsule((-7, 0), (7, 0), 6.0), "teal", GRIP),
    "rounded": (Polygon(Polygon.box(12, 6).points, radius=4.0), "coral", GRIP),
    "wheel": (Circle(8.0), "gold", BRAKED),
}
DROP = (58.0, 63.0)  # [px] where crates appear
APART = 84.0  # [px] between crates on the belt
OUT_X = 462.0  # [px] where they leave
WINDOW = (0.70, 0.86)  # of a belt's length: where a crate's speed is measured
SETTLE = 60  # steps after a change of speed without measurements
SLOWED, SLOWED_AT = 60, 90  # [px/s] speed that the bot sets first, and the frame
ALLOWED = 0.02  # of the belt's speed
VIEWS = ((4, 30, 472, 108), (4, 154, 472, 108))
TITLES = ("conveyor declared", "not declared: the same belts, the same crates")
DUST = ((250, 230, 190), (190, 150, 120), (110, 90, 100))


class Conveyor(Scene):
    """Scene with two worlds: one with the effect `conveyor`, one without it."""

    name = "lab/conveyor"
    title = "Conveyor"
    question = STANDS
    about = "Belts carry crates of every shape up, along and down; without the effect the same crates lie still."
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, conveyor=True)
    pieces = ("boxes", "circles", "capsules", "queries")
    solver = "sequential_impulse"  # there are no piles: four fifths of the time of the soft steps
    features = (
        "surface speed, in the friction of every contact",
        "rolling resistance brakes a wheel",
        "the same world without the effect",
    )
    sliders = (Slider("speed", 20, 120, 120, "px/s", step=10),)
    actions = (("left right", "speed"),)
    overlays = ()
    draggable = True
    head = HEAD
    legend_at = (8, 34)

    def build(self):
        """Build the belts in both worlds. Crates are added over time by update()."""
        self.add_world()
        self.add_world(effects=self.effects.with_(conveyor=False))
        self.cameras = [Camera(view) for view in VIEWS]
        self.sky = load_backdrop("sky_dusk")
        self.things = load_atlas("things")
        pictures = {kind: piece(shape, ramp) for kind, (shape, ramp, _) in KINDS.items()}
        pictures["box"] = self.things["crate"]
        self.casts = [Cast(pictures) for _ in self.worlds]
        self.kinds = [{} for _ in self.worlds]  # body id -> kind
        self.dropped = [0 for _ in self.worlds]
        self.belts = [{} for _ in self.worlds]
        self.way = 0.0  # [px] motion of the belts, for drawing only
        self.changed = -SETTLE
        self.taken = dict.fromkeys(BELTS, 0)
        self.worst = dict.fromkeys(BELTS, 0.0)  # greatest error since the last change of speed
        self.last = {}  # belt -> speed of the last crate there since the last change of speed
        self.seen = {kind: set() for kind in KINDS}  # belts on which it was measured
        self.inside = {}  # (body id, belt) -> last speed in the window
        self.delivered = 0
        self.strayed = 0.0
        self.fallen = {}  # body id of the world without the effect -> its place of rest
        self._lay_belts()

    def _lay_belts(self):
        material = Material(friction=0.5, surface_speed=float(self.values["speed"]))
        for world, belts in zip(self.worlds, self.belts, strict=True):
            for name, (start, end) in BELTS.items():
                if name in belts:
                    world.remove_body(belts[name])
                belts[name] = world.add_body(Capsule(start, end, BELT_RADIUS), kind="static", material=material)

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, and rebuild the belts if the value changed.

        SETTLE steps after a change, the measurements start again.
        """
        before = self.values[name]
        super().change_slider(name, value)
        if self.values[name] != before:
            self.changed = self.frame
            self.inside.clear()
            self.last.clear()
            self.worst = dict.fromkeys(BELTS, 0.0)
            self._lay_belts()

    def update(self, inputs):
        """Process keys, add crates, make one step, then measure speeds."""
        turn = inputs.pressed("right") - inputs.pressed("left")
        if turn:
            self.change_slider("speed", self.values["speed"] + 10 * turn)
        for index in range(len(self.worlds)):
            self._drop(index)
        for world in self.worlds:
            world.step()
        self.way += self.values["speed"] / 60
        self._measure()
        self._rest()
        self._collect()

    def _drop(self, index):
        """Add the next crate to the world `worlds[index]` if it is due and no other crate is at its
        starting position.
        """
        world = self.worlds[index]
        every = max(1, round(APART / self.values["speed"] * 60))
        if self.frame % every or (index == 1 and self.dropped[1] >= len(KINDS)):
            return
        # Without the effect each crate falls to its own place.
        x = DROP[0] if index == 0 else STILL_X[self.dropped[1]]
        found = world.query_aabb((x - 12, DROP[1] - 14), (x + 12, DROP[1] + 14))
        if index == 0 and any(body.kind == "dynamic" for body in found):
            return
        kind = tuple(KINDS)[self.dropped[index] % len(KINDS)]
        shape, _, material = KINDS[kind]
        y = DROP[1] if x < BELTS["level"][1][0] else BELTS["top"][0][1] - 20.0
        body = world.add_body(shape, position=(x, y), material=material)
        self.casts[index].add(body, kind)
        self.kinds[index][body.id] = kind
        self.dropped[index] += 1

    def _measure(self):
        """Record the speed of each crate that has just left the measuring window of a belt, a stretch near the belt's
        end.
        """
        world, speed = self.world, float(self.values["speed"])
        if self.frame - self.changed < SETTLE:
            return
        held = self.drag.held
        for identity, kind in self.kinds[0].items():
            if identity == held:
                continue
            body = world.body(identity)
            for name, (start, end) in BELTS.items():
                along, aside, _ = on_belt(body.center, start, end)
                tx, ty = direction(start, end)
                key = (identity, name)
                if WINDOW[0] < along < WINDOW[1] and -24.0 < aside < 0.0:
                    self.inside[key] = body.velocity[0] * tx + body.velocity[1] * ty
                elif key in self.inside:
                    found = self.inside.pop(key)
                    self.taken[name] += 1
                    self.last[name] = found
                    self.worst[name] = max(self.worst[name], abs(found - speed) / speed)
                    self.seen[kind].add(name)

    def _rest(self):
        """Update the greatest distance that a crate has moved in the world without the effect.

        The distance of a crate counts from its position one second after it was added.
        """
        for identity in self.kinds[1]:
            x, y = self.worlds[1].body(identity).position
            age, start = self.fallen.get(identity, (0, None))
            if start is None and age >= 60:
                start = (x, y)
            self.fallen[identity] = (age + 1, start)
            if start is not None and not self.drag.holds:
                self.strayed = max(self.strayed, hypot(x - start[0], y - start[1]))

    def _collect(self):
        """Remove the crates that have passed the end of the last belt or have fallen, and count those that have
        passed.
        """
        for index, world in enumerate(self.worlds):
            for identity in list(self.kinds[index]):
                body = world.body(identity)
                x, y = body.position
                if x < OUT_X and y < 130.0:
                    continue
                del self.kinds[index][identity]
                world.remove_body(body)
                if index == 0 and x >= OUT_X:
                    self.delivered += 1
                    self.particles.burst(
                        x,
                        min(y, 92.0),
                        16,
                        DUST,
                        speed=(20, 90),
                        life=(0.2, 0.5),
                        angle=-pi / 2,
                        spread=2.6,
                        gravity=140.0,
                    )
                    self.play("coin", x, 0.25)

    def views(self):
        """Return a list of (world, camera), one for the picture of each world."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw both views with their belts and crates, and the measurements.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        for index, camera in enumerate(self.cameras):
            self._draw_hall(canvas, index, camera, alpha)
        self.particles.draw(canvas, self.cameras[0], alpha)

    def _draw_hall(self, canvas, index, camera, alpha):
        view, running = camera.viewport, index == 0
        canvas.surface.blit(self.sky, view, (0, 60, *view.size))
        floor = pygame.Rect(view.x, view.bottom - 8, view.width, 8)
        canvas.surface.fill((38, 32, 54), floor)
        canvas.surface.fill((70, 60, 88), (floor.x, floor.y, floor.width, 1))
        canvas.text(TITLES[index], view.x + 2, view.y - 8, GREEN if running else RED, SMALL)
        canvas.surface.set_clip(view)
        for start, end in BELTS.values():
            draw_belt(canvas.surface, view, start, end, self.way if running else 0.0, running)
        chute = pygame.Rect(view.x + round(DROP[0]) - 13, view.y, 26, 52)
        if running:
            canvas.surface.fill((52, 44, 72), chute)
            pygame.draw.rect(canvas.surface, INK, chute, 1)
            canvas.surface.fill(GOLD, (chute.x, chute.bottom - 3, chute.width, 1))
        canvas.surface.set_clip(None)
        self.casts[index].draw(canvas, camera, self.worlds[index], alpha)
        pygame.draw.rect(canvas.surface, SLATE, view, 1)
        if running:
            for name, (x, y) in LABEL_AT.items():
                found, speed = self.last.get(name), float(self.values["speed"])
                color = PAPER if found is None or abs(found - speed) <= ALLOWED * speed else RED
                text = name if found is None else f"{name} {found:.1f}"
                canvas.text(text, view.x + x, view.y + y, color, SMALL, align="center", outline=True)
        else:
            canvas.text(
                f"moved by {self.strayed:.2f} px", view.x + 92, view.y + 98, PAPER, SMALL, align="center", outline=True
            )

    def check(self):
        """Return the scene's goals, a list of Goal.

        All shapes reach the speed of every belt; without the effect nothing moves.
        """
        worst = max(self.worst.values())
        everywhere = all(len(belts) == len(BELTS) for belts in self.seen.values())
        return [
            Goal(
                "crates have the belt's speed within 2 %",
                600,
                min(self.taken.values()) > 0 and worst <= ALLOWED,
                f"off by {worst:.2%} at most, {sum(self.taken.values())} taken",
            ),
            Goal(
                "each shape was measured on each belt",
                1100,
                everywhere,
                ", ".join(f"{kind} {len(belts)}" for kind, belts in self.seen.items()),
            ),
            Goal(
                "without the effect they lie still",
                600,
                len(self.fallen) == len(KINDS) and self.strayed < 1.0,
                f"{len(self.fallen)} crates moved {self.strayed:.3f} px",
            ),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        speed = float(self.values["speed"])
        belt = max(self.worst, key=lambda name: self.worst[name])
        good = len(self.last) < len(BELTS) or self.worst[belt] <= ALLOWED
        sentence = f"At {speed:.0f} px/s crates do not reach the speed of every belt."
        number, unit = f"{100 * self.worst[belt]:.1f} %", f"off at most, on the belt {belt}"
        headline = Headline(sentence, "left: slower", number, unit, len(self.last), len(BELTS), "belts", good)
        return headline.asks(f"Do crates reach the {speed:.0f} px/s of every belt?")

    def finding(self):
        """Return a sentence with the error of the crates' speed, as a percentage of the belt's speed.

        The last crate on each belt is measured, and the greatest error of all belts is given. The sentence also gives
        the distance that crates have moved in the world without the effect.
        """
        if not self.last:
            return "not yet: a crate has to come to the end of a belt that runs as it does now"
        speed = float(self.values["speed"])
        off = max(abs(found - speed) for found in self.last.values()) / speed
        on = f"on {len(self.last)} of {count_text(len(BELTS), 'belt')} at {speed:.0f} px/s"
        sentence = f"{on} the last crate was {share_text(off)} off that at most"
        lies = sum(start is not None for _, start in self.fallen.values())
        return (
            f"{sentence}; without the effect {count_text(lies, 'crate')} moved {self.strayed:.2f} px"
            if lies
            else sentence
        )

    def bot(self):
        """Return the bot's input for the next step. The bot halves the speed, waits, then raises it."""
        changes = (("slider:speed", SLOWED),) if self.frame == SLOWED_AT else ()
        return InputFrame(frozenset(("right",)) if self.frame in (420, 424) else frozenset(), changes=changes)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the measurements."""
        return (
            self.frame,
            self.values["speed"],
            *self.dropped,
            self.delivered,
            *self.taken.values(),
            *self.worst.values(),
            self.strayed,
        )


def direction(start, end):
    """Return the unit vector along a belt from `start` to `end`."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = hypot(dx, dy)
    return dx / length, dy / length


def on_belt(point, start, end):
    """Return (along, aside, length) of a point relative to a belt from `start` to `end`.

    along: position along the belt, 0 at `start`, 1 at `end`; aside: distance from the belt's line [px], negative above
    it; length: length of the belt [px].
    """
    tx, ty = direction(start, end)
    length = hypot(end[0] - start[0], end[1] - start[1])
    dx, dy = point[0] - start[0], point[1] - start[1]
    return (dx * tx + dy * ty) / length, dy * tx - dx * ty, length


def draw_belt(surface, view, start, end, way, running):
    """Draw a belt around two rollers, with ribs that show its motion.

    start, end: centres of the rollers in the view [px]; way: distance that the belt has moved [px]; running: whether
    the belt is drawn bright (True) or dim.
    """
    (ax, ay), (bx, by) = ((p[0] + view.x, p[1] + view.y) for p in (start, end))
    tx, ty = direction(start, end)
    length = hypot(bx - ax, by - ay)
    rubber, rib = ((64, 58, 84), (150, 140, 170)) if running else ((48, 44, 62), (84, 80, 100))
    for radius, color in ((BELT_RADIUS, INK), (BELT_RADIUS - 1, rubber), (BELT_RADIUS - 3, (30, 26, 44))):
        corners = [
            (ax + ty * radius, ay - tx * radius),
            (bx + ty * radius, by - tx * radius),
            (bx - ty * radius, by + tx * radius),
            (ax - ty * radius, ay + tx * radius),
        ]
        pygame.draw.polygon(surface, color, corners)
        for x, y in ((ax, ay), (bx, by)):
            pygame.draw.circle(surface, color, (x, y), radius)
    for side in (1.0, -1.0):
        first = (way * side) % 8.0
        for i in range(int((length - first) // 8.0) + 1):
            along = first + 8.0 * i
            for out in (BELT_RADIUS - 1, BELT_RADIUS - 2):
                x, y = ax + tx * along + side * ty * out, ay + ty * along - side * tx * out
                surface.set_at((round(x), round(y)), rib)
    turn = way / BELT_RADIUS
    for x, y in ((ax, ay), (bx, by)):
        pygame.draw.circle(surface, rib if running else faded(rib, 0.4), (x, y), 3)
        pygame.draw.circle(surface, INK, (x, y), 3, 1)
        surface.set_at((round(x + 2 * cos(turn)), round(y + 2 * sin(turn))), INK)
