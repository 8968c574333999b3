"""Zones that detect bodies: at rest, moving, thin. Is every entry reported, with one exit, at any speed?

In short: some saucers are faster than the zones are wide. Beside each zone are its entries, its exits, and the entries
computed by geometry.

What to see: saucers cross a field, a drifting field and a beam of one pixel, some of them faster than the zones are
wide. Below, a fast scanner runs over resting mines. Beside each zone are its entries and exits, and the number computed
by geometry.

Why it matters: Goals, alarms and pick-ups depend on one event each; a missed or doubled event breaks a level.

To try: watch the beam while the fastest saucer passes: after no step is the saucer inside it.

Source: Box2D's sensor events; swept as in Catto, Continuous Collision, GDC 2013.
"""

from math import pi, sin

import numpy as np
import pygame

from game.drawing.canvas import SMALL, whole
from game.drawing.colors import FOG, GREEN, INK, NIGHT, ORANGE, PAPER, PINK, RED, SKY, SLATE, YELLOW, faded
from game.drawing.headline import ENOUGH, Headline
from game.drawing.rotated import RotatedPicture
from game.drawing.sprites import load_atlas, load_backdrop
from game.input.inputs import InputFrame
from game.scene import FAIR, Goal, Scene, Slider
from physics import Circle, Effects, Filter, Polygon
from scenes.lab.yard import HEAD

ZONES = {  # name: (width, height) [px], middle at the start, colour
    "field": ((64.0, 118.0), (92.0, 94.0), SKY),
    "drifter": ((44.0, 56.0), (214.0, 94.0), GREEN),
    "beam": ((1.0, 118.0), (318.0, 94.0), YELLOW),
    "scanner": ((2.0, 62.0), (60.0, 213.0), PINK),
}
HIGH = pygame.Rect(4, 30, 400, 128)  # where saucers fly
LOW = pygame.Rect(4, 176, 400, 74)  # where mines rest
SIDE_X = 412
SAUCER, MINE = 12.0, 7.0  # [px] radii
EVERY = 26  # steps between saucers
DRIFT = (34.0, 150.0)  # [px] amplitude of the drifting field, and its steps per round
SCAN = (60.0, 348.0)  # [px] range of the scanner
REST = 8  # steps of rest of the scanner at each end
MINES = tuple((96.0 + 36.0 * i, 195.0 + 36.0 * (i % 2)) for i in range(7))
CLEAR = 0.25  # [px] crossings this close to a graze are not counted
NEAR = 2.0  # [px] distance at which a crossing is over
SAMPLE = 0.125  # [px] of relative motion between two samples of the slow reference
GLOW = 14  # steps for which a zone or a body lights up
SHIP, ZONE = 1, 2  # filter bits


class Sensors(Scene):
    """Scene with one world: zones, which are sensor bodies, and bodies that cross them."""

    name = "lab/sensors"
    title = "Sensors"
    question = FAIR
    about = "Zones count who enters and leaves, however fast or thin; geometry checks every count."
    effects = Effects(narrowphase=False, sensors=True, continuous=True)  # sensors test shapes by themselves
    pieces = ("circles", "boxes", "capsules")
    features = ("sensor zones: still, moving, thin, fast", "entries found between the steps", "each begin with its end")
    sliders = (
        Slider("speed", 60, 9000, 2400, "px/s", step=60),
        Slider("scanner", 300, 6000, 2400, "px/s", step=100),
        Slider("events", 0, 1, 0, choices=("of poses", "swept")),  # those that the title line is about
    )
    actions = (("X", "events"), ("left right", "speed"), ("up down", "scanner"))
    filter_names = {SHIP: "ship", ZONE: "zone"}
    head = HEAD
    legend_at = (8, 252)
    broadphase = "brute"
    draggable = True

    def build(self):
        """Build the zones and the mines. Saucers are added over time by update()."""
        self.add_world()
        self.sky = load_backdrop("sky_dusk")
        planes, effects = load_atlas("planes"), load_atlas("effects")
        self.saucer, self.mine = planes.animation("saucer"), RotatedPicture(effects["bullet_orange_0"])
        self.zones, self.zone_of = {}, {}
        for name, (size, middle, _) in ZONES.items():
            kind = "static" if name in ("field", "beam") else "kinematic"
            body = self.world.add_body(
                Polygon.box(*size),
                position=middle,
                kind=kind,
                sensor=True,
                continuous="swept",
                filter=Filter(ZONE, SHIP),
            )
            self.zones[name], self.zone_of[body.id] = body, name
        self.mines = [
            self.world.add_body(Circle(MINE), position=place, filter=Filter(SHIP, ZONE)).id for place in MINES
        ]
        self.flying = {}  # body id -> speed
        self.inside = {}  # (zone, body id) -> entries without exit
        self.entered, self.left = dict.fromkeys(ZONES, 0), dict.fromkeys(ZONES, 0)
        self.due = dict.fromkeys(ZONES, 0)  # entries by geometry
        self.missed, self.false = dict.fromkeys(ZONES, 0), dict.fromkeys(ZONES, 0)
        self.unseen = dict.fromkeys(ZONES, 0)  # entries without a step at whose end the shapes overlap
        self.stood = set()  # (zone, body id) that overlapped at the end of a step of the current crossing
        self.unpaired = 0  # a second begin without an end, or an end without a begin
        self.fastest = 0.0  # [px] greatest motion per step of a detected body
        self.met = {}  # (zone, body id) -> (certain, possible) in the current crossing
        self.glow = dict.fromkeys(ZONES, 0)
        self.lit = {}  # body id -> remaining steps of its glow
        self.trails = []  # [x0, x1, y, age]
        self.way, self.rest = 1, 0

    def update(self, inputs):
        """Process keys, add saucers, move the zones, make one step, and compare the events with geometry."""
        for slider, back, forth, notch in (("speed", "left", "right", 300), ("scanner", "down", "up", 300)):
            turn = inputs.pressed(forth) - inputs.pressed(back)
            if turn:
                self.change_slider(slider, self.values[slider] + turn * notch)
        if inputs.pressed("bomb"):
            self.change_slider("events", 1 - self.values["events"])
        if self.frame % EVERY == 0:
            self._launch()
        self._steer()
        before = self._places()
        self.world.step()
        self._take_events()
        self._compare(before, self._places())
        self._land()
        self._fade(before)

    def _launch(self):
        speed = self.values["speed"] * self.random.uniform(0.25, 1.0)
        y = self.random.uniform(HIGH.top + 14.0, HIGH.bottom - 14.0)
        x = -20.0 - self.random.uniform(0.0, speed / 60)  # to vary the times of entry
        body = self.world.add_body(
            Circle(SAUCER), position=(x, y), velocity=(speed, 0.0), filter=Filter(SHIP, ZONE), continuous="swept"
        )
        self.flying[body.id] = speed

    def _steer(self):
        """Set the velocities with which the moving zones reach their next positions in this step."""
        (_, middle, _), body = ZONES["drifter"], self.zones["drifter"]
        y = middle[1] + DRIFT[0] * sin(2.0 * pi * (self.frame + 1) / DRIFT[1])
        body.velocity = (0.0, (y - body.position[1]) * 60)
        body = self.zones["scanner"]
        x = body.position[0] + self.way * self.values["scanner"] / 60 * (self.rest == 0)
        self.rest = max(0, self.rest - 1)
        if not SCAN[0] <= x <= SCAN[1]:
            # A rest between two runs: contacts in two successive steps count once.
            self.way, self.rest = (1 if x < SCAN[0] else -1), REST
            x = min(max(x, SCAN[0]), SCAN[1])
        body.velocity = ((x - body.position[0]) * 60, 0.0)

    def _places(self):
        bodies = self.world.bodies
        return dict(
            zip(bodies["id"].tolist(), zip(bodies["x"].tolist(), bodies["y"].tolist(), strict=True), strict=True)
        )

    def _take_events(self):
        """Count the sensor events of the step, and check that each entry is followed by one exit.

        Exits are counted first, because a body may leave a zone and return within a step.
        """
        for events, tally, change in (
            (self.world.events.sensor_end, self.left, -1),
            (self.world.events.sensor_begin, self.entered, 1),
        ):
            for row in events:
                a, b = int(row["body_a"]), int(row["body_b"])
                zone, other = (a, b) if a in self.zone_of else (b, a)
                name = self.zone_of[zone]
                tally[name] += 1
                key = (name, other)
                self.inside[key] = self.inside.get(key, 0) + change
                self.unpaired += self.inside[key] not in (0, 1)
                if self.inside[key] == 0:
                    del self.inside[key]
                if change > 0:
                    self.glow[name] = self.lit[other] = GLOW
                    self.fastest = max(self.fastest, self.flying.get(other, self.values["scanner"]) / 60)
                    surely, perhaps, _ = self.met.get(key, (False, False, False))
                    self.met[key] = (surely, perhaps, True)
                    self.play("blip", 60.0, 0.12)

    def _compare(self, before, after):
        """Compute by geometry which bodies met which zones in this step.

        After a crossing has ended, compare it with the sensor events. before, after: {body id: (x, y) [px]} at the
        start and at the end of the step.
        """
        for name, zone in self.zones.items():
            half = np.array(ZONES[name][0]) / 2.0
            for identity in [*self.flying, *self.mines]:
                if identity not in before:
                    continue
                radius = SAUCER if identity in self.flying else MINE
                gap = least_gap(before[identity], after[identity], before[zone.id], after[zone.id], half) - radius
                key = (name, identity)
                surely, perhaps, seen = self.met.get(key, (False, False, False))
                if gap < NEAR:
                    self.met[key] = (surely or gap < -CLEAR, perhaps or gap < CLEAR, seen)
                end = least_gap(after[identity], after[identity], after[zone.id], after[zone.id], half) - radius
                if end < 0.0:
                    self.stood.add(key)
                if key in self.met and end > NEAR:
                    self._close(key)

    def _close(self, key):
        surely, perhaps, seen = self.met.pop(key)
        name = key[0]
        self.due[name] += surely
        self.missed[name] += surely and not seen
        self.unseen[name] += surely and key not in self.stood
        self.stood.discard(key)
        self.false[name] += seen and not perhaps

    def _land(self):
        for identity in list(self.flying):
            body = self.world.body(identity)
            if body.position[0] > 430.0:
                del self.flying[identity]
                self.world.remove_body(body)

    def _fade(self, before):
        self.glow = {name: max(0, steps - 1) for name, steps in self.glow.items()}
        self.lit = {identity: steps - 1 for identity, steps in self.lit.items() if steps > 1}
        self.trails = [[x0, x1, y, age + 1] for x0, x1, y, age in self.trails if age < GLOW]
        for identity in self.flying:
            x, y = self.world.body(identity).position
            self.trails.append([before.get(identity, (x, y))[0], x, y, 0])

    def draw(self, canvas, alpha):
        """Draw both areas with their zones and bodies, and the counts beside them.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        for rect, title in (
            (HIGH, "saucers through standing and drifting zones, and a beam of 1 px"),
            (LOW, "a fast thin scanner over resting mines"),
        ):
            canvas.surface.blit(self.sky, rect, (30, 30, *rect.size))
            canvas.text(title, rect.x + 2, rect.y - 8, FOG, SMALL)
        canvas.surface.set_clip(HIGH.union(LOW))
        self._draw_trails(canvas)
        self._draw_bodies(canvas, alpha)
        canvas.surface.set_clip(None)
        for name in ZONES:
            self._draw_zone(canvas, name, alpha)
        for rect in (HIGH, LOW):
            pygame.draw.rect(canvas.surface, SLATE, rect, 1)
        self._draw_tally(canvas)

    def _draw_trails(self, canvas):
        for x0, x1, y, age in self.trails:
            color = faded(ORANGE, 0.3 + 0.65 * age / GLOW)
            if x0 < HIGH.right:
                pygame.draw.line(
                    canvas.surface, color, (whole(x0), whole(y)), (min(whole(x1), HIGH.right - 1), whole(y))
                )

    def _draw_bodies(self, canvas, alpha):
        bodies = self.world.bodies
        image = self.saucer.at(self.frame / 60)
        mine = self.mine.at(self.frame * 0.03)
        mines = set(self.mines)
        for row in bodies[bodies["kind"] == 2]:
            identity = int(row["id"])
            x = row["previous_x"] + (row["x"] - row["previous_x"]) * alpha
            y = row["previous_y"] + (row["y"] - row["previous_y"]) * alpha
            if x < HIGH.right + 12:
                canvas.sprite(mine if identity in mines else image, x, y)
                if identity in self.lit:
                    radius = int(MINE if identity in mines else SAUCER) + 2
                    pygame.draw.circle(
                        canvas.surface, faded(PAPER, 1.0 - self.lit[identity] / GLOW), (whole(x), whole(y)), radius, 1
                    )

    def _draw_zone(self, canvas, name, alpha):
        (width, height), _, color = ZONES[name]
        row = self.world.bodies[self.world.rows([self.zones[name].id])[0]]
        x = row["previous_x"] + (row["x"] - row["previous_x"]) * alpha
        y = row["previous_y"] + (row["y"] - row["previous_y"]) * alpha
        rect = pygame.Rect(0, 0, max(1, round(width)), round(height))
        rect.center = (whole(x), whole(y))
        glow = self.glow[name] / GLOW
        if width > 4.0:
            shade = pygame.Surface(rect.size, pygame.SRCALPHA)
            shade.fill((*color, round(46 + 90 * glow)))
            for stripe in range(-rect.height, rect.width, 10):
                pygame.draw.line(
                    shade,
                    (*color, 90),
                    (stripe + self.frame // 3 % 10, rect.height),
                    (stripe + self.frame // 3 % 10 + rect.height, 0),
                )
            canvas.surface.blit(shade, rect)
            pygame.draw.rect(canvas.surface, color, rect, 1)
        else:
            halo = pygame.Surface((rect.width + 6, rect.height), pygame.SRCALPHA)
            for inset, strength in ((0, 24), (1, 44), (2, 80)):
                halo.fill((*color, round(strength * (1.0 + glow))), (inset, 0, rect.width + 6 - 2 * inset, rect.height))
            canvas.surface.blit(halo, (rect.x - 3, rect.y))
            canvas.surface.fill(faded(color, 0.0) if glow == 0.0 else PAPER, rect)
            for end in (rect.top, rect.bottom - 3):
                canvas.surface.fill(INK, (rect.x - 3, end - 1, rect.width + 6, 5))
                canvas.surface.fill(color, (rect.x - 2, end, rect.width + 4, 3))

    def _draw_tally(self, canvas):
        y = 26
        for name, (_, _, color) in ZONES.items():
            wrong = self.missed[name] + self.false[name]
            canvas.surface.fill(color, (SIDE_X, y, 2, 46))
            canvas.text(name, SIDE_X + 6, y, color, SMALL)
            inside = sum(1 for zone, _ in self.inside if zone == name)
            for line, (label, value) in enumerate(
                (
                    ("in", self.entered[name]),
                    ("out", self.left[name]),
                    ("inside", inside),
                    ("geometry", self.due[name]),
                    ("wrong", wrong),
                )
            ):
                top = y + 9 + line * 8
                hue = PAPER if line < 4 else GREEN if wrong == 0 else RED
                canvas.text(label, SIDE_X + 6, top, FOG, SMALL)
                canvas.text(f"{value}", 474, top, hue, SMALL, align="right")
            y += 56
        canvas.text("unpaired", SIDE_X + 6, y, FOG, SMALL)
        canvas.text(f"{self.unpaired}", 474, y, GREEN if self.unpaired == 0 else RED, SMALL, align="right")

    def check(self):
        """Return the scene's goals, a list of Goal.

        Every entry is reported once and followed by one exit, and no false entry is reported.
        """
        missed, false = sum(self.missed.values()), sum(self.false.values())
        balance = all(
            self.entered[name] - self.left[name] == sum(1 for zone, _ in self.inside if zone == name) for name in ZONES
        )
        return [
            Goal(
                "no entry is missed",
                600,
                min(self.due.values()) >= 5 and missed == 0,
                f"{missed} of {sum(self.due.values())}",
            ),
            Goal("none is made up", 600, false == 0, f"{false}"),
            Goal(
                "each begin has its end",
                600,
                self.unpaired == 0 and balance,
                f"{self.unpaired} unpaired, "
                f"{sum(self.entered.values())} in, {sum(self.left.values())} out, {len(self.inside)} inside",
            ),
            Goal(
                "what moves further than a zone is wide is seen",
                600,
                self.fastest > ZONES["field"][0][0],
                f"{self.fastest:.0f} px in a step",
            ),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        swept = int(self.values["events"])
        due, unseen = sum(self.due.values()), sum((self.missed if swept else self.unseen).values())
        step = max(self.values["speed"], self.values["scanner"]) / 60
        sentence = f"At {step:.0f} px a step, entries fall between two steps; sweeping finds them."
        unit = ("entries unseen where bodies stand", "entries unseen along the swept way")[swept]
        number, mend = f"{unseen} of {due}", ("X: swept", "X: not swept")[swept]
        headline = Headline(sentence, mend, number, unit, due, ENOUGH, "entries", not unseen)
        return headline.asks(f"At {step:.0f} px a step, {('do', 'swept, do')[swept]} entries fall between two steps?")

    def finding(self):
        """Return a sentence with the numbers of missed and false entries, and the greatest motion of a detected body
        in a step.
        """
        due, missed, false = (sum(each.values()) for each in (self.due, self.missed, self.false))
        if not due:
            return "not yet: something has to cross a zone"
        sentence = f"of {due:,} entries by geometry {missed:,} were missed and {false:,} made up"
        return f"{sentence}, with {self.fastest:.0f} px in a step through zones down to 1 px"

    def bot(self):
        """Return the bot's input for the next step.

        The bot waits, then raises the speeds of the saucers and of the scanner.
        """
        faster = 200 <= self.frame < 250 and self.frame % 4 == 0
        tap = "right" if faster else "up" if self.frame in (320, 330) else ""
        return InputFrame(frozenset((tap,))) if tap else frozenset()

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the counts. The worlds are hashed separately."""
        tallies = (self.entered, self.left, self.due, self.missed, self.false)
        return (
            self.frame,
            *self.values.values(),
            self.unpaired,
            self.way,
            self.rest,
            self.fastest,
            *(value for tally in tallies for value in tally.values()),
        )


def least_gap(start, end, zone_start, zone_end, half):
    """Return the least distance [px] between a moving point and a moving box during a step; 0 if they overlap.

    start, end: positions of the point; zone_start, zone_end: positions of the box's centre; half: half the width and
    half the height of the box [px]. Both move on straight lines. The motion is sampled every SAMPLE px.
    """
    x = np.array([start[0] - zone_start[0], end[0] - zone_end[0]])
    y = np.array([start[1] - zone_start[1], end[1] - zone_end[1]])
    reach = max(
        min(abs(x[0]), abs(x[1])) - half[0] if x[0] * x[1] > 0 else 0.0,
        min(abs(y[0]), abs(y[1])) - half[1] if y[0] * y[1] > 0 else 0.0,
    )
    if reach > 2.0 * SAUCER:
        return reach  # far away in this whole step: no sampling needed
    count = int(max(abs(x[1] - x[0]), abs(y[1] - y[0])) / SAMPLE) + 2
    share = np.linspace(0.0, 1.0, count)
    dx = np.maximum(np.abs(x[0] + (x[1] - x[0]) * share) - half[0], 0.0)
    dy = np.maximum(np.abs(y[0] + (y[1] - y[0]) * share) - half[1], 0.0)
    return float(np.sqrt((dx * dx + dy * dy).min()))
