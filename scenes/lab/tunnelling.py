"""The same shots in four lanes: tested at their poses, along a ray, by a sweep, by time of impact. Which miss?

In short: a fast ball is before the plate in one step, beyond it in the next. The red number counts missed shots.

What to see: a fast ball is on one side of a thin plate in one step and beyond it in the next. The ray of its centre
finds the plate, but misses it if the ball only grazes the edge. The sweep finds both, as long as nothing rotates: a
spinning rod reaches the plate with an end that was elsewhere when the step began. For bullets, the target is a second
bullet.

Why it matters: Each sweep misses the shots that it does not model. The lanes show which ones, and what each costs.

To try: raise the speed or thin the plate, press Space for rods, and see which lane misses first.

Source: Mirtich 1996 (conservative advancement); Catto, Continuous Collision, GDC 2013.
"""

from math import ceil, cos, pi, sin
from random import Random

import pygame

from game.drawing.canvas import SMALL, TEXT
from game.drawing.colors import FOG, GREEN, INK, NIGHT, ORANGE, PAPER, RED, SKY, SLATE, WHITE, faded
from game.drawing.headline import ENOUGH, Headline
from game.drawing.sprites import load_atlas, load_backdrop
from game.input.inputs import InputFrame
from game.measurement_requests import STEPS, MeasuredRun, RunRequest
from game.scene import FAIR, Goal, Scene, Slider
from physics import BROADPHASES, Effects, World
from scenes.lab.costs import cost_text
from scenes.lab.shots import (
    BULLET_RADIUS,
    END_X,
    GUN_X,
    PLATE_HALF,
    PLATE_X,
    RADIUS,
    ROD_HALF,
    SHOTS,
    aim,
    flights,
    raise_plate,
    shoot,
    steps_of_flight,
)
from scenes.lab.yard import HEAD

LANES = ("off", "ray", "swept", "toi")
WORDS = {"off": "Unswept", "ray": "Ray-cast", "swept": "Swept", "toi": "Timed"}
TITLES = {
    "off": "off: only where it stands",
    "ray": "ray: along the centre's path",
    "swept": "swept: the whole shape, not turning",
    "toi": "toi: time of impact, turning too",
}
BULLET_TITLES = {"off": "off", "ray": "ray", "swept": "swept", "toi": "toi, bullet against bullet"}
COLORS = {"off": RED, "ray": ORANGE, "swept": SKY, "toi": GREEN}
LANE_TOP, LANE_HEIGHT = 20, 62
EVERY = 7  # steps between shots
CLEAR = 0.75  # [px] shots this close to touching are not counted
GLOW_STEPS = 14  # steps for which a mark of a hit stays
SPARKS = ((255, 255, 230), (255, 214, 90), (255, 148, 40), (140, 40, 52))
COUNT_X = 392


class Tunnelling(Scene):
    """Scene with one world of four lanes. In each lane a gun fires at a plate, or two guns fire at each other.

    The lanes differ in the argument `continuous` of the shots.
    """

    name = "lab/tunnelling"
    title = "Tunnelling"
    question = FAIR
    about = "Fast balls, spinning rods and bullets: off, ray, swept and time of impact, every missed hit counted."
    effects = Effects(response=True, rotation=True, stacking=True, continuous=True)
    pieces = ("circles", "boxes", "capsules")
    features = (
        "ray approximation, swept shapes, time of impact with rotation",
        "bullets against bullets",
        "missed hits counted against geometry",
    )
    sliders = (
        Slider("speed", 300, 12000, 3600, "px/s", step=100),
        Slider("plate", 1, 16, 3, "px", step=1),
        Slider("shots", 0, 2, 0, choices=SHOTS),
        Slider("lane", 0, len(LANES) - 1, 0, choices=LANES),  # the one that the title line is about
    )
    actions = (("X", "lane"), ("left right", "speed"), ("up down", "plate"), ("Space", "balls, rods, bullets"))
    broadphase = "sweep"
    draggable = True
    head = HEAD
    legend_at = (392, 226)

    def build(self):
        """Build the four lanes with their plates."""
        self.add_world()
        self.sky = load_backdrop("sky_dusk")
        self.gun = pygame.transform.rotate(load_atlas("planes")["player"], -90)
        self.gun_back = pygame.transform.flip(self.gun, True, False)
        self.trials = []  # per shot: lane, body ids, must hit, must pass
        self.of_body = {}  # body id -> its trial
        self.spent = {}  # body id -> colour: shots that have hit, visible for one more step
        self.trails = []  # [lane, what, pose before, pose, age], for drawing only
        self.marks = []  # [lane, x, y, colour, age], for drawing only
        keys = [(kind, lane) for kind in SHOTS for lane in LANES]
        self.fired, self.due = dict.fromkeys(keys, 0), dict.fromkeys(keys, 0)  # due: must hit, by geometry
        self.hit, self.missed = dict.fromkeys(keys, 0), dict.fromkeys(keys, 0)
        self.false = dict.fromkeys(keys, 0)  # hits of shots that must pass
        self.plates = {}
        self._raise_plates()

    @property
    def kind(self):
        """Kind of the shots, one of SHOTS."""
        return SHOTS[int(self.values["shots"])]

    def _raise_plates(self):
        for plate in self.plates.values():
            self.world.remove_body(plate)
        self.plates = {}
        if self.kind != "bullets":
            self.plates = {lane: raise_plate(self.world, self.values["plate"], middle(lane)) for lane in LANES}

    def change_slider(self, name, value):
        """Set the slider `name` to `value`.

        A change of the plate or of the kind of shots removes all shots in flight, and builds the plates again.
        """
        super().change_slider(name, value)
        if name in ("plate", "shots"):
            self.world.remove_bodies([*self.of_body, *self.spent])
            self.spent.clear()
            self.trials.clear()
            self.of_body.clear()
            self._raise_plates()

    def update(self, inputs):
        """Process keys, fire, make one step, and count the shots that hit or missed."""
        for slider, back, forth, notch in (("speed", "left", "right", 300), ("plate", "down", "up", 1)):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(slider, self.values[slider] + way * notch)
        if inputs.pressed("bomb"):
            self.change_slider("lane", (int(self.values["lane"]) + 1) % len(LANES))
        if inputs.pressed("fire"):
            self.change_slider("shots", (int(self.values["shots"]) + 1) % len(SHOTS))
        self.world.remove_bodies(list(self.spent))
        self.spent.clear()
        if self.frame % EVERY == 0:
            self._fire()
        before = {body: self._pose(body) for body in self.of_body}
        self.world.step()
        self._age()
        self._count_hits()
        self._count_passed(before)

    def _pose(self, identity):
        body = self.world.body(identity)
        return (*body.position, body.angle)

    def _fire(self):
        """Fire the same shot in every lane."""
        kind = self.kind
        shots, gap = aim(kind, float(self.values["speed"]), float(self.values["plate"]), self.random)
        for lane in LANES:
            bodies = shoot(self.world, shots, kind, lane, middle(lane))
            trial = {"lane": lane, "bodies": [body.id for body in bodies], "must": gap < -CLEAR, "passes": gap > CLEAR}
            self.of_body |= dict.fromkeys(trial["bodies"], trial)
            self.trials.append(trial)
            self.fired[kind, lane] += 1
            self.due[kind, lane] += trial["must"]

    def measured(self):
        """Return a RunRequest: one run for each lane, timed by the measuring process during the game.

        A run contains one shot at a time, from the gun to the end of the lane, and enough shots for about 60 steps.
        """
        speed, plate = float(self.values["speed"]), float(self.values["plate"])
        steps = steps_of_flight(speed)

        def make(name):
            world = World(self.effects, BROADPHASES[self.broadphase](), self.solver)
            count = ceil(STEPS / steps)
            return MeasuredRun(
                flights(world, self.kind, name[-1], speed, plate, count, Random(0)), self.broadphase, steps
            )

        return RunRequest([(*self.chosen, lane) for lane in LANES], make)

    def _count_hits(self):
        for row in self.world.events.begin:
            trial = self.of_body.get(int(row["body_a"])) or self.of_body.get(int(row["body_b"]))
            if trial is None:
                continue
            key = (self.kind, trial["lane"])
            self.hit[key] += trial["must"]
            self.false[key] += trial["passes"]
            x, y = float(row["point_x"]), float(row["point_y"])
            self.marks.append([trial["lane"], x, y, COLORS[trial["lane"]], 0])
            self.particles.burst(x, y, 14, SPARKS, speed=(30, 160), life=(0.15, 0.5), angle=pi, spread=2.0)
            self.play("hit", x, 0.3)
            self._end(trial)

    def _end(self, trial):
        for identity in trial["bodies"]:
            del self.of_body[identity]
            self.spent[identity] = COLORS[trial["lane"]]
        self.trials.remove(trial)

    def _age(self):
        for trail in self.trails:
            trail[4] += 1
        for mark in self.marks:
            mark[4] += 1
        self.trails = [t for t in self.trails if t[4] < GLOW_STEPS]
        self.marks = [m for m in self.marks if m[4] < GLOW_STEPS * 3]

    def _count_passed(self, before):
        for trial in list(self.trials):
            gone = True
            for identity in trial["bodies"]:
                pose, (vx, _) = self._pose(identity), self.world.body(identity).velocity
                self.trails.append([trial["lane"], self.kind, before.get(identity, pose), pose, 0])
                gone &= pose[0] > END_X if vx > 0.0 else pose[0] < GUN_X
            if gone:
                if trial["must"]:
                    self.missed[self.kind, trial["lane"]] += 1
                    x = PLATE_X if self.plates else (GUN_X + END_X) / 2
                    self.marks.append([trial["lane"], x, pose[1], WHITE, 0])
                self._end(trial)

    def draw(self, canvas, alpha):
        """Draw the lanes, the plates, the shots with their earlier positions, and the counts.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        for lane in LANES:
            self._draw_lane(canvas, lane)
        for trail in self.trails:
            canvas.surface.set_clip(inside(trail[0]))
            self._draw_trail(canvas.surface, *trail)
        for identity, trial in self.of_body.items():
            canvas.surface.set_clip(inside(trial["lane"]))
            self._draw_shot(canvas.surface, self._pose(identity), COLORS[trial["lane"]])
        for lane, x, y, color, age in self.marks:
            canvas.surface.set_clip(inside(lane))
            fading = faded(color, age / (GLOW_STEPS * 3))
            pygame.draw.circle(canvas.surface, fading, (round(x), round(y)), 3 + age // 3, 1)
        canvas.surface.set_clip(None)
        self.particles.draw(canvas, self.camera, alpha)

    def _draw_lane(self, canvas, lane):
        top = LANE_TOP + LANES.index(lane) * LANE_HEIGHT
        y, key = round(middle(lane)), (self.kind, lane)
        lane_rect = inside(lane).inflate(2, 2)
        canvas.surface.blit(self.sky, lane_rect, (50, 6, *lane_rect.size))
        pygame.draw.rect(canvas.surface, SLATE, lane_rect, 1)
        canvas.text((BULLET_TITLES if self.kind == "bullets" else TITLES)[lane], 6, top + 1, COLORS[lane], SMALL)
        canvas.sprite(self.gun, GUN_X - 8, y)
        if self.kind == "bullets":
            canvas.sprite(self.gun_back, END_X - 14, y)
        if lane in self.plates:
            width = max(1, int(self.values["plate"]))
            rect = pygame.Rect(round(PLATE_X) - width // 2, y - int(PLATE_HALF), width, 2 * int(PLATE_HALF))
            canvas.surface.fill(INK, rect.inflate(2, 2))
            canvas.surface.fill(PAPER, rect)
        under_way = sum(1 for trial in self.trials if trial["lane"] == lane and trial["must"])
        missed = self.missed[key]
        canvas.text(f"{missed}", COUNT_X, top + 10, RED if missed else GREEN, TEXT, 2)
        canvas.text("missed", COUNT_X + 82, top + 14, FOG, SMALL, align="right")
        canvas.text(f"{self.hit[key]} of {self.due[key] - under_way} hits found", COUNT_X, top + 30, PAPER, SMALL)
        canvas.text(f"{self.fired[key]} shots", COUNT_X, top + 39, FOG, SMALL)
        canvas.text(f"a step: {cost_text(self, (*self.chosen, lane))}", COUNT_X, top + 48, FOG, SMALL)

    def _draw_trail(self, surface, lane, kind, start, end, age):
        color = faded(COLORS[lane], 0.2 + 0.7 * age / GLOW_STEPS)
        left, right = max(min(start[0], end[0]), 5.0), min(max(start[0], end[0]), 382.0)
        if left < right:
            pygame.draw.line(surface, color, (round(left), round(start[1])), (round(right), round(end[1])))
        if 10.0 < end[0] < 376.0:
            if kind == "rods":
                pygame.draw.line(surface, color, *rod_ends(end), 3)
            else:
                radius = RADIUS if kind == "balls" else BULLET_RADIUS + 1
                pygame.draw.circle(surface, color, (round(end[0]), round(end[1])), int(radius), 1)

    def _draw_shot(self, surface, pose, color):
        if not 10.0 < pose[0] < 376.0:
            return
        if self.kind == "rods":
            pygame.draw.line(surface, INK, *rod_ends(pose), 5)
            pygame.draw.line(surface, color, *rod_ends(pose), 3)
            pygame.draw.circle(surface, WHITE, (round(pose[0]), round(pose[1])), 1)
            return
        radius = int(RADIUS if self.kind == "balls" else BULLET_RADIUS + 1)
        pygame.draw.circle(surface, color, (round(pose[0]), round(pose[1])), radius)
        pygame.draw.circle(surface, WHITE, (round(pose[0]), round(pose[1])), max(radius - 3, 1))

    def check(self):
        """Return the scene's goals, a list of Goal.

        The lane "toi" misses no shot. Each other lane misses the shots that its method cannot find.
        """
        missed, due = self.missed, self.due
        made_up = sum(count for (kind, lane), count in self.false.items() if kind != "rods" or lane == "toi")

        def found(kind, lane):
            return f"{missed[kind, lane]} of {due[kind, lane]}"

        return [
            *(
                Goal(
                    f"toi misses none of the {kind}",
                    when,
                    due[kind, "toi"] > 5 and missed[kind, "toi"] == 0,
                    found(kind, "toi"),
                )
                for kind, when in (("balls", 220), ("rods", 420), ("bullets", 600))
            ),
            Goal(
                "the sweep misses no ball",
                220,
                due["balls", "swept"] > 5 and missed["balls", "swept"] == 0,
                found("balls", "swept"),
            ),
            Goal(
                "the sweep is wrong about rods that turn",
                420,
                missed["rods", "swept"] + self.false["rods", "swept"] > 0,
                f"{found('rods', 'swept')} missed, {self.false['rods', 'swept']} made up",
            ),
            Goal(
                "the ray misses some that graze",
                420,
                missed["balls", "ray"] + missed["rods", "ray"] > 0,
                f"{found('balls', 'ray')} balls, {found('rods', 'ray')} rods",
            ),
            Goal(
                "without either most are missed",
                600,
                all(2 * missed[kind, "off"] > due[kind, "off"] for kind in SHOTS),
                ", ".join(f"{found(kind, 'off')} {kind}" for kind in SHOTS),
            ),
            Goal("no hit is made up where nothing turns, nor by toi", 600, made_up == 0, f"{made_up}"),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        kind, step, lane = self.kind, self.values["speed"] / 60, LANES[int(self.values["lane"])]
        missed, ended = self.missed[kind, lane], self.hit[kind, lane] + self.missed[kind, lane]
        how = WORDS[lane]
        what = "each other" if kind == "bullets" else f"a plate of {self.values['plate']} px"
        sentence = f"{how}, at {step:.0f} px a step, {kind} pass {what}."
        number, unit = f"{missed} of {ended}", f"went through (lane {lane})"
        headline = Headline(sentence, "X: next lane", number, unit, ended, ENOUGH, kind, not missed)
        return headline.asks(f"{how}, at {step:.0f} px a step, do {kind} pass {what}?")

    def finding(self):
        """Return a sentence with two figures for each lane: the missed shots, and the time of a step.

        The missed shots are given as a number out of all shots that had to hit.
        """
        kind = self.kind
        ended = {lane: self.hit[kind, lane] + self.missed[kind, lane] for lane in LANES}
        if not all(ended.values()):
            return f"not yet: {kind} have to come to each wall"
        parts = []
        for lane in LANES:
            missed = self.missed[kind, lane]
            parts.append(f"{lane} missed {missed} of {ended[lane]} ({cost_text(self, (*self.chosen, lane))})")
        return f"{kind}: {', '.join(parts)}"

    def bot(self):
        """Return the bot's input for the next step.

        The bot shows balls, rods and bullets, and raises the speed once.
        """
        tap = {100: "right", 220: "fire", 420: "fire"}.get(self.frame)
        return InputFrame(frozenset((tap,)) if tap else frozenset())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the counts. The worlds are hashed separately."""
        counts = (self.fired, self.due, self.hit, self.missed, self.false)
        return (self.frame, *self.values.values(), *(value for count in counts for value in count.values()))


def middle(lane):
    """Return the y of a lane's centre line [canvas px]."""
    return LANE_TOP + LANES.index(lane) * LANE_HEIGHT + 9 + (LANE_HEIGHT - 12) / 2


def inside(lane):
    """Return the canvas rectangle inside the frame of a lane."""
    return pygame.Rect(5, LANE_TOP + LANES.index(lane) * LANE_HEIGHT + 10, 378, LANE_HEIGHT - 14)


def rod_ends(pose):
    """Return both ends of a rod's centre line, each as integers (x, y) [px].

    pose: (x, y, angle) of the rod [px, px, rad].
    """
    x, y, angle = pose
    dx, dy = ROD_HALF * cos(angle), ROD_HALF * sin(angle)
    return (round(x - dx), round(y - dy)), (round(x + dx), round(y + dy))
