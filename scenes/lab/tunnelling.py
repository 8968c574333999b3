"""The same shots in three lanes: tested where they stand, along a ray, and swept. Which lane misses?

What to see: a fast ball is on one side of a thin plate in one step and beyond it in the next. The ray
through its centre finds the plate, but passes a ball that would only graze the edge. The sweep finds both.
Turn up the speed or thin the plate, and count.
"""

import numpy as np
import pygame

from game.colors import FOG, GOLD, GREEN, INK, NIGHT, ORANGE, PAPER, RED, SLATE, WHITE, faded
from game.draw import SMALL, TEXT
from game.inputs import InputFrame
from game.scene import Goal, Scene, Slider
from game.sprites import load_atlas, load_backdrop
from physics import Circle, Effects, Polygon

LANES = ("off", "ray", "swept")
TITLES = {"off": "off: only where it stands", "ray": "ray: along the centre's path", "swept": "swept: the whole ball"}
COLORS = {"off": RED, "ray": ORANGE, "swept": GREEN}
LANE_TOP, LANE_HEIGHT = 30, 76
GUN_X, PLATE_X, END_X = 30.0, 300.0, 380.0      # [px]
RADIUS, PLATE_HALF = 5.0, 12.0                  # [px]
EVERY = 12                                      # steps between shots
SPREAD = 20.0                                   # [px] shots leave at up to this much above or below the middle
CLEAR = 0.75                                    # [px] shots this close to just touching are not counted either way
GLOW_STEPS = 14                                 # steps a mark of a hit stays
SPARKS = ((255, 255, 230), (255, 214, 90), (255, 148, 40), (140, 40, 52))
COUNT_X = 392


class Tunnelling(Scene):
    """One world, three lanes, one plate and one gun in each."""

    name = "lab/tunnelling"
    title = "Tunnelling"
    about = "Fast shots at a thin plate: off, ray and swept side by side, with every missed hit counted."
    effects = Effects(response=True, continuous=True)
    features = ("no sweep, ray approximation, swept first time of impact", "missed hits counted against geometry")
    sliders = (Slider("speed", 300, 12000, 3600, "px/s", step=100), Slider("plate", 1, 16, 3, "px", step=1))
    actions = (("left right", "speed"), ("up down", "plate"))
    broadphase = "sweep"

    def build(self):
        """Three plates."""
        self.add_world()
        self.sky = load_backdrop("sky_dusk")
        self.gun = pygame.transform.rotate(load_atlas("planes")["player"], -90)
        self.shots = {}            # body id -> (lane, offset from the plate's middle)
        self.trails = []           # per shot of the last steps: (lane, x0, x1, y, age), only seen
        self.marks = []            # (x, y, colour, age), only seen
        self.fired = dict.fromkeys(LANES, 0)
        self.due = dict.fromkeys(LANES, 0)         # shots that must hit, by geometry
        self.hit = dict.fromkeys(LANES, 0)
        self.missed = dict.fromkeys(LANES, 0)
        self.false = dict.fromkeys(LANES, 0)       # hits of shots that pass by
        self.plates = {}
        self._raise_plates()

    def _raise_plates(self):
        for lane in LANES:
            if lane in self.plates:
                self.world.remove_body(self.plates[lane])
            shape = Polygon.box(self.values["plate"], 2 * PLATE_HALF)
            self.plates[lane] = self.world.add_body(shape, position=(PLATE_X, middle(lane)), kind="static")

    def change_slider(self, name, value):
        """Another plate is built at once; shots under way no longer count."""
        super().change_slider(name, value)
        if name == "plate":
            self.world.remove_bodies(list(self.shots))
            self.shots.clear()
            self._raise_plates()

    def update(self, inputs):
        """Keys, guns, one step, then the count."""
        for slider, back, forth, notch in (("speed", "left", "right", 300), ("plate", "down", "up", 1)):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(slider, self.values[slider] + way * notch)
        if self.frame % EVERY == 0:
            self._fire()
        before = {body: float(self.world.body(body).position[0]) for body in self.shots}
        self.world.step()
        self._count_hits()
        self._count_passed(before)

    def _fire(self):
        offset = self.random.uniform(-SPREAD, SPREAD)
        start = GUN_X + self.random.uniform(0.0, self.values["speed"] / 60)    # so that steps fall anywhere
        for lane in LANES:
            body = self.world.add_body(
                Circle(RADIUS), position=(start, middle(lane) + offset), velocity=(self.values["speed"], 0.0),
                continuous=lane,
            )
            self.shots[body.id] = (lane, offset)
            self.fired[lane] += 1
            self.due[lane] += must_hit(offset)

    def _count_hits(self):
        begun = self.world.events.begin
        for row in begun:
            shot = int(row["body_a"]) if int(row["body_a"]) in self.shots else int(row["body_b"])
            if shot not in self.shots:
                continue
            lane, offset = self.shots.pop(shot)
            self.hit[lane] += must_hit(offset)
            self.false[lane] += must_pass(offset)
            x, y = float(row["point_x"]), float(row["point_y"])
            self.marks.append([x, y, COLORS[lane], 0])
            self.particles.burst(x, y, 14, SPARKS, speed=(30, 160), life=(0.15, 0.5), angle=np.pi, spread=2.0)
            self.play("hit", x, 0.35)
            self.world.remove_body(self.world.body(shot))

    def _count_passed(self, before):
        for trail in self.trails:
            trail[4] += 1
        for mark in self.marks:
            mark[3] += 1
        self.trails = [t for t in self.trails if t[4] < GLOW_STEPS]
        self.marks = [m for m in self.marks if m[3] < GLOW_STEPS * 3]
        for body, (lane, offset) in list(self.shots.items()):
            x, y = self.world.body(body).position
            self.trails.append([lane, before.get(body, GUN_X), float(x), float(y), 0])
            if x > END_X:
                if must_hit(offset):
                    self.missed[lane] += 1
                    self.marks.append([PLATE_X, float(y), WHITE, 0])
                del self.shots[body]
                self.world.remove_body(self.world.body(body))

    def draw(self, canvas, alpha):
        """Lanes, plates, shots at every step they made, and the counts."""
        canvas.surface.fill(NIGHT)
        canvas.text("TUNNELLING", 4, 4, GOLD)
        step = self.values["speed"] / 60
        words = f"{step:.0f} px a step, plate {self.values['plate']} px, ball {2 * RADIUS:.0f} px"
        canvas.text(words, 474, 6, FOG, SMALL, align="right")
        for lane in LANES:
            self._draw_lane(canvas, lane)
        for lane, x0, x1, y, age in self.trails:
            self._draw_trail(canvas, lane, x0, x1, y, age)
        for body, (lane, _) in self.shots.items():
            x, y = self.world.body(body).position
            place = (round(x), round(y))
            if x < END_X:
                pygame.draw.circle(canvas.surface, COLORS[lane], place, int(RADIUS))
                pygame.draw.circle(canvas.surface, WHITE, place, int(RADIUS) - 3)
        for x, y, color, age in self.marks:
            fading = faded(color, age / (GLOW_STEPS * 3))
            pygame.draw.circle(canvas.surface, fading, (round(x), round(y)), 3 + age // 3, 1)
        self.particles.draw(canvas, self.camera, alpha)

    def _draw_lane(self, canvas, lane):
        top = LANE_TOP + LANES.index(lane) * LANE_HEIGHT
        y = round(middle(lane))
        lane_rect = pygame.Rect(4, top + 10, 380, LANE_HEIGHT - 14)
        canvas.surface.blit(self.sky, lane_rect, (50, 6, *lane_rect.size))
        pygame.draw.rect(canvas.surface, SLATE, lane_rect, 1)
        canvas.text(TITLES[lane], 6, top + 1, COLORS[lane], SMALL)
        canvas.sprite(self.gun, GUN_X - 8, y)
        plate = self.plates[lane]
        width = max(1, int(self.values["plate"]))
        rect = pygame.Rect(round(plate.position[0]) - width // 2, y - int(PLATE_HALF), width, 2 * int(PLATE_HALF))
        canvas.surface.fill(INK, rect.inflate(2, 2))
        canvas.surface.fill(PAPER, rect)
        must = self.due[lane] - sum(1 for owner, offset in self.shots.values() if owner == lane and must_hit(offset))
        canvas.text(f"{self.missed[lane]}", COUNT_X, top + 14, RED if self.missed[lane] else GREEN, TEXT, 2)
        canvas.text("missed", COUNT_X + 82, top + 18, FOG, SMALL, align="right")
        canvas.text(f"{self.hit[lane]} of {must} hits found", COUNT_X, top + 36, PAPER, SMALL)
        canvas.text(f"{self.fired[lane]} shots", COUNT_X, top + 46, FOG, SMALL)

    def _draw_trail(self, canvas, lane, x0, x1, y, age):
        color = faded(COLORS[lane], 0.2 + 0.7 * age / GLOW_STEPS)
        end = min(x1, 382)
        if x0 < end:
            pygame.draw.line(canvas.surface, color, (round(x0), round(y)), (round(end), round(y)))
        if x1 < 378:
            pygame.draw.circle(canvas.surface, color, (round(x1), round(y)), int(RADIUS), 1)

    def check(self):
        """The sweep misses nothing, the ray only grazes, and the plain test tunnels."""
        missed = self.missed
        return [
            Goal("the sweep misses nothing", 600, self.due["swept"] > 10 and missed["swept"] == 0,
                 f"{missed['swept']} of {self.due['swept']}"),
            Goal("the ray misses some that graze", 600, missed["ray"] > 0, f"{missed['ray']} of {self.due['ray']}"),
            Goal("without either most are missed", 600, missed["off"] > missed["ray"],
                 f"{missed['off']} of {self.due['off']}"),
            Goal("no shot that passes by is a hit", 600, not any(self.false.values()), f"{self.false}"),
        ]

    def bot(self):
        """Watch; make it faster once, then thinner."""
        tap = {300: "right", 420: "down"}.get(self.frame)
        return InputFrame(frozenset((tap,)) if tap else frozenset())

    def state(self):
        """The counts; the world holds the shots."""
        counts = (self.fired, self.due, self.hit, self.missed, self.false)
        return (self.frame, self.values["speed"], self.values["plate"], *(c[lane] for c in counts for lane in LANES))


def middle(lane):
    """Canvas y of a lane's middle."""
    return LANE_TOP + LANES.index(lane) * LANE_HEIGHT + 10 + (LANE_HEIGHT - 14) / 2


def must_hit(offset):
    """By geometry alone: the ball's path meets the plate, by more than a hair."""
    return abs(offset) < PLATE_HALF + RADIUS - CLEAR


def must_pass(offset):
    """By geometry alone: the ball's path stays clear of the plate, by more than a hair."""
    return abs(offset) > PLATE_HALF + RADIUS + CLEAR
