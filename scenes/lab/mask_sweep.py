"""Bullets and spinning swords fly at walls of one pixel, with and without sweep: which get through?

In short: at the left only the poses after each step are tested, and most shots pass. The white mark is a swept impact.

What to see: a shot moves sixty pixels per step, and a wall is one pixel thick. If only the poses after each step are
tested, most shots pass the wall. A swept shot, rotation included, never passes: it stops where its own outline first
meets the wall's. The white mark shows this pose, and the number is the time of impact, as a share of the step.

Why it matters: Bullets that fly through walls are a common bug, and walls of one pixel are the thinnest.

To try: follow one white mark: it shows the shot's pose at its time of impact.

Source: Mirtich, Impulse-based Dynamic Simulation, 1996 (conservative advancement).
"""

from math import cos, pi, sin

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL, TEXT
from game.drawing.colors import FOG, GOLD, GREEN, NIGHT, PAPER, RED, SLATE, WHITE, faded
from game.drawing.headline import ENOUGH, Headline
from game.drawing.rotated import RotatedPicture
from game.drawing.sprites import load_atlas, load_backdrop
from game.measure.rates import Rate
from game.overlays.mask_edges import mask_edges
from game.overlays.outlines import draw_lines, moved
from game.scene import FAIR, Goal, Scene, Slider
from physics import Effects, PixelMask, debug
from scenes.lab.thin_walls import SHAPES, is_beyond, wall_of
from scenes.lab.yard import HEAD, plate

WAYS = ("off", "toi")
TITLES = {"off": "continuous off", "toi": "time of impact"}
COLORS = {"off": RED, "toi": GREEN}
SHOTS = ("both", "bullets", "swords")
PICTURES = {"bullets": "shot", "swords": "sword"}
LANE_TOP, LANE_HEIGHT, LANE_WIDTH = 30, 76, 238  # [canvas px]
WALL_X, GUN_X = 150.0, 16.0  # [px] in a lane
MIDDLE = 38.0  # [px] of a lane's height
ASIDE = 9.0  # [px] off the middle: every shot within it meets the wall
SPIN = (20.0, 50.0)  # [rad/s]
EVERY = 9  # steps between two shots of a lane
PASSES = 8  # of the solver
END_X = 226.0  # [px]
GLOW_STEPS = 30  # steps for which a mark of an impact stays
TRAIL_STEPS, LABEL_STEPS = 12, 14
COUNTS = 40  # [canvas px] on the right of a lane, for its figures
SPARKS = ((255, 255, 230), (255, 214, 90), (255, 148, 40), (140, 40, 52))
WORDS = "white: the sprite's outline where it met the wall; gold: at which share of the step; dim: where it was going"


class MaskSweep(Scene):
    """Scene with two worlds, without and with swept shots. Each has three lanes, for a straight wall, a slanted wall
    and a ring.
    """

    name = "lab/mask_sweep"
    title = "Mask sweep"
    question = FAIR
    about = "Bullets and spinning swords at walls of one pixel, with and without continuous collision."
    effects = Effects(response=True, rotation=True, stacking=True, continuous=True)
    pieces = ("masks", "boxes", "circles")
    features = (
        "time of impact of sprites, their turning included",
        "walls one pixel thin: straight, aslant, a ring",
        "what passes is counted, with and without",
    )
    sliders = (
        Slider("speed", 300, 9000, 3600, "px/s", step=100),
        Slider("shots", 0, len(SHOTS) - 1, 0, choices=SHOTS),
        Slider("side", 0, 1, 0, choices=("unswept", "swept")),  # the one that the title line is about
    )
    actions = (("X", "other side"), ("left right", "speed"), ("Space", "bullets, swords"))
    broadphase = "brute"  # a dozen shots and three walls per world: no structure pays off
    solver = "sequential_impulse"  # a shot that meets a wall is removed in the next step: there is no lasting load
    head = HEAD
    legend_at = (4, 218)

    def build(self):
        """Build two worlds, the first for shots without sweep, the second for swept shots, with three walls in each."""
        self.sky, atlas = load_backdrop("sky_dusk"), load_atlas("lab")
        self.masks = {kind: PixelMask.from_surface(atlas[name]) for kind, name in PICTURES.items()}
        self.pictures = {kind: RotatedPicture(atlas[name]) for kind, name in PICTURES.items()}
        self.gun = pygame.transform.rotate(load_atlas("planes")["player"], -90)
        self.walls = {shape: wall_of(shape) for shape in SHAPES}
        self.wall_pictures = {shape: picture_of(wall) for shape, wall in self.walls.items()}
        self.cameras, self.shots, self.spent = [], [], []
        self.edges = {}  # of each kind of shot, about its origin
        self.trails, self.marks = [], []  # for drawing only: [way, kind, pose, age], and the records of _mark
        keys = [(way, shape) for way in WAYS for shape in SHAPES]
        self.fired, self.hit, self.passed = (dict.fromkeys(keys, 0) for _ in range(3))
        for column in range(len(WAYS)):
            world = self.add_world(substeps=PASSES)
            left = 1 + column * (LANE_WIDTH + 2)
            self.cameras.append(Camera((left, LANE_TOP, LANE_WIDTH, 3 * LANE_HEIGHT)))
            for lane, shape in enumerate(SHAPES):
                world.add_body(self.walls[shape], position=(WALL_X, middle(lane)), kind="static")

    def update(self, inputs):
        """Process keys, fire, step both worlds, and count the shots that hit or passed."""
        way = inputs.pressed("right") - inputs.pressed("left")
        if way:
            self.change_slider("speed", self.values["speed"] + 300 * way)
        if inputs.pressed("bomb"):
            self.change_slider("side", 1 - self.values["side"])
        if inputs.pressed("fire"):
            self.change_slider("shots", (int(self.values["shots"]) + 1) % len(SHOTS))
        for _, _, body in self.spent:  # visible for one more step
            body.remove()
        self.spent = []
        for lane in range(len(SHAPES)):
            if self.frame % EVERY == 3 * lane:
                self._fire(lane)
        for world in self.worlds:
            world.step()
        for seen in (self.trails, self.marks):
            for each in seen:
                each[-1] += 1
        self.trails = [each for each in self.trails if each[-1] < TRAIL_STEPS]
        self.marks = [each for each in self.marks if each[-1] < GLOW_STEPS]
        for column in range(len(WAYS)):
            self._count(column)

    def _fire(self, lane):
        """Fire the same shot in both worlds, in lane number `lane`.

        Its start is shifted at random by at most the distance that it moves in a step, so that the times of impact
        vary.
        """
        speed = float(self.values["speed"])
        chosen = SHOTS[int(self.values["shots"])]
        kind = self.random.choice(SHOTS[1:]) if chosen == "both" else chosen
        x = GUN_X - self.random.uniform(0.0, speed / 60.0)
        y, angle, spin = self.random.uniform(-ASIDE, ASIDE), 0.0, 0.0
        if kind == "swords":
            angle, spin = self.random.uniform(0.0, 2 * pi), self.random.choice((-1, 1)) * self.random.uniform(*SPIN)
        for column, way in enumerate(WAYS):
            body = self.worlds[column].add_body(
                self.masks[kind],
                position=(x, middle(lane) + y),
                velocity=(speed, 0.0),
                angle=angle,
                angular_velocity=spin,
                continuous=way,
            )
            self.shots.append((column, lane, kind, body))
            self.fired[way, SHAPES[lane]] += 1

    def _count(self, column):
        """Count the shots of world number `column` that hit a wall in this step, and those that have passed their
        wall.
        """
        world, way = self.worlds[column], WAYS[column]
        begun = world.events.begin
        met = set(begun["body_a"].tolist()) | set(begun["body_b"].tolist())
        fractions = {int(row["body"]): row for row in debug.impact_ghosts(world)}
        left = []
        for shot in self.shots:
            of, lane, kind, body = shot
            if of != column:
                left.append(shot)
                continue
            x, y = body.position
            self.trails.append([way, kind, (x, y, body.angle), 0])
            beyond = is_beyond(SHAPES[lane], x - WALL_X, y - middle(lane))
            if body.id in met and not beyond:
                self.hit[way, SHAPES[lane]] += 1
                self._mark(column, kind, body, fractions.get(body.id))
                self.spent.append((column, kind, body))
            elif x > END_X or body.id in met:
                self.passed[way, SHAPES[lane]] += 1
                self.spent.append((column, kind, body))
            else:
                left.append(shot)
        self.shots = left

    def _mark(self, column, kind, body, ghost):
        """Record the mark of a shot that has hit a wall, play a sound, and emit sparks.

        column: number of the world; kind: kind of the shot; ghost: row of debug.impact_ghosts with the pose that the
        shot would have without the wall, or None.
        """
        world = self.worlds[column]
        rows = np.flatnonzero(world.shapes["body"] == body.id)
        x, y = body.position
        pose, aim, fraction = (x, y, body.angle), None, None
        if kind not in self.edges:
            self.edges[kind] = placed(mask_edges(world, rows, 3.0).outer, pose, (0.0, 0.0, 0.0))
        if ghost is not None:
            aim = (float(ghost["x"]), float(ghost["y"]), float(ghost["angle"]))
            fraction = float(ghost["fraction"])
        self.marks.append([column, kind, pose, aim, fraction, 0])
        self.play("hit", self.cameras[column].viewport.x + x, 0.2)
        self.particles.burst(
            self.cameras[column].viewport.x + x, LANE_TOP + y, 8, SPARKS, (20, 110), (0.1, 0.4), pi, 2.2
        )

    def views(self):
        """Return a list of (world, camera), one for the picture of each world."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw six lanes with their shots, and the counts. alpha: position (0..1) between the last two steps."""
        canvas.surface.fill(NIGHT)
        for column, way in enumerate(WAYS):
            camera = self.cameras[column]
            canvas.surface.set_clip(camera.viewport)
            for lane in range(len(SHAPES)):
                self._draw_lane(canvas.surface, camera.viewport, lane)
            self._draw_shots(canvas.surface, column)
            canvas.surface.set_clip(None)
            self._draw_counts(canvas, camera.viewport, way)
        canvas.text(WORDS, 240, 261, FOG, SMALL, align="center")
        self.particles.draw(canvas, self.camera, alpha)

    def _draw_lane(self, surface, view, lane):
        rect = pygame.Rect(view.x, view.y + lane * LANE_HEIGHT, LANE_WIDTH, LANE_HEIGHT - 3)
        surface.blit(self.sky, rect, (60, 20 + 40 * lane, *rect.size))
        pygame.draw.rect(surface, SLATE, rect, 1)
        gun_width, gun_height = self.gun.get_size()
        surface.blit(self.gun, (view.x + GUN_X - gun_width / 2, view.y + middle(lane) - gun_height / 2))
        picture = self.wall_pictures[SHAPES[lane]]
        width, height = picture.get_size()
        surface.blit(picture, (view.x + WALL_X - width / 2, view.y + middle(lane) - height / 2))

    def _draw_shots(self, surface, column):
        view = self.cameras[column].viewport
        for way, kind, (x, y, angle), age in self.trails:
            if way == WAYS[column] and age > 0:
                dx, dy = (8.0, 0.0) if kind == "bullets" else (15.0 * cos(angle), 15.0 * sin(angle))
                color = faded(COLORS[way], 0.35 + 0.6 * age / TRAIL_STEPS)
                at_x, at_y = view.x + x, view.y + y
                pygame.draw.line(surface, color, (at_x - dx, at_y - dy), (at_x + dx, at_y + dy))
        stopped = [(kind, body) for of, kind, body in self.spent if of == column]
        for kind, body in [*stopped, *((kind, body) for of, _, kind, body in self.shots if of == column)]:
            (x, y), angle = body.position, body.angle
            self.pictures[kind].draw(surface, view.x + x, view.y + y, angle)

    def _draw_counts(self, canvas, view, way):
        canvas.text(TITLES[way], view.x + 3, 19, COLORS[way])
        passed, fired = (sum(each[way, shape] for shape in SHAPES) for each in (self.passed, self.fired))
        canvas.text(f"{passed} of {fired} pass", view.right - 3, 19, PAPER, align="right")
        for lane, shape in enumerate(SHAPES):
            y = view.y + lane * LANE_HEIGHT + 3
            count = self.passed[way, shape]
            plate(canvas, (view.right - COUNTS, y - 1, COUNTS - 3, 37))
            plate(canvas, (view.x + 2, y - 1, 36, 9))
            canvas.text(f"{count}", view.right - 4, y, RED if count else GREEN, TEXT, 2, align="right", outline=True)
            canvas.text("passed", view.right - 4, y + 20, FOG, SMALL, align="right")
            canvas.text(f"{self.hit[way, shape]} hit", view.right - 4, y + 28, PAPER, SMALL, align="right")
            canvas.text(shape, view.x + 4, y, FOG, SMALL)

    def draw_on_frame(self, frame):
        """Draw the marks of impacts: the shot's outline in white at its time of impact, and dim at its pose without
        the wall.

        The time of impact, as a share of the step, is written beside the mark.
        """
        for column, kind, pose, aim, fraction, age in self.marks:
            x, y, _ = pose
            lens = frame.lens(self.cameras[column])
            clip = lens.clip.copy()
            clip.width -= round(COUNTS * frame.zoom)
            frame.surface.set_clip(clip)
            fading = age / GLOW_STEPS
            if aim is not None:
                lines = placed(self.edges[kind], (0.0, 0.0, 0.0), aim)
                draw_lines(frame.surface, lens, lines, faded(COLORS[WAYS[column]], 0.4 + 0.6 * fading))
            lines = placed(self.edges[kind], (0.0, 0.0, 0.0), pose)
            draw_lines(frame.surface, lens, lines, faded(WHITE, fading), max(1, frame.scale - 1) if age < 6 else 1)
            frame.surface.set_clip(None)
            if fraction is not None and age < LABEL_STEPS:
                at = lens.points(x - 18.0, y - 14.0)
                frame.text_if_free(f"{fraction:.2f}", *at, GOLD, SMALL, frame.plot_scale, "right", True)

    def check(self):
        """Return the scene's goals, a list of Goal. No swept shot passes a wall, and some unswept shots pass each
        wall.
        """
        passed, fired, hit = self.passed, self.fired, self.hit
        flying = {way: sum(WAYS[of] == way for of, *_ in self.shots) for way in WAYS}
        all_accounted = all(
            sum(fired[way, shape] - hit[way, shape] - passed[way, shape] for shape in SHAPES) == flying[way]
            for way in WAYS
        )
        goals = [
            Goal(
                f"none passes the wall, {shape}",
                300,
                passed["toi", shape] == 0 and hit["toi", shape] > 10,
                f"{passed['toi', shape]} of {fired['toi', shape]} pass",
            )
            for shape in SHAPES
        ]
        return [
            *goals,
            Goal(
                "without it some pass each wall",
                300,
                all(passed["off", shape] > 0 for shape in SHAPES),
                ", ".join(f"{passed['off', shape]} of {fired['off', shape]}" for shape in SHAPES),
            ),
            Goal("every shot has passed, hit, or flies", 300, all_accounted, f"{sum(flying.values())} fly"),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        passed, met = ({way: sum(each[way, shape] for shape in SHAPES) for way in WAYS} for each in self._ended())
        step, at = f"at {float(self.values['speed']) / 60:.0f} px a step,", int(self.values["side"])
        way, other, name = WAYS[at], WAYS[1 - at], ("Unswept", "Swept")[at]
        number = f"{passed[way]} of {met[way]}"
        unit = f"passed; {('swept', 'unswept')[at]}, {passed[other]} of {met[other]}"
        sentence = f"{name}, {step} sprites pass walls of one pixel."
        mend = f"X: {('swept', 'unswept')[at]}"
        headline = Headline(sentence, mend, number, unit, met[way], ENOUGH, "shots", not passed[way])
        return headline.asks(f"{name}, {step} do sprites pass walls of one pixel?")

    def finding(self):
        """Return a sentence with the number of shots that passed the walls, without sweep and with sweep.

        For swept shots it includes the upper end of the 95 % confidence interval of the rate.
        """
        passed, met = ({way: sum(each[way, shape] for shape in SHAPES) for way in WAYS} for each in self._ended())
        if not all(met.values()):
            return "not yet: shots have to come to the walls"
        rates = {way: Rate(passed[way], met[way]) for way in WAYS}
        most = 100 * rates["toi"].interval[1]
        sentence = f"{rates['off'].count} of {rates['off'].total} shots came through walls of one pixel"
        return f"{sentence}; swept, {rates['toi'].count} of {rates['toi'].total} (95 %: at most {most:.1f} %)"

    def _ended(self):
        """Return (passed, ended), two dicts {(way, shape of the wall): number of shots}.

        way: one of WAYS, "off" for shots without continuous collision, "toi" for swept shots. passed: shots that passed
        the wall; ended: shots that passed or hit it.
        """
        return self.passed, {key: count + self.passed[key] for key, count in self.hit.items()}

    def bot(self):
        """Return the bot's input for the next step. The bot waits, and later raises the speed three times."""
        return frozenset(("right",)) if self.frame in (200, 210, 220) else frozenset()

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the counts. The worlds are hashed separately."""
        counts = (self.fired, self.hit, self.passed)
        return (self.frame, *self.values.values(), len(self.shots), *(v for count in counts for v in count.values()))


def middle(lane):
    """Return the world y [px] of the centre line of lane number `lane`."""
    return lane * LANE_HEIGHT + MIDDLE - 1.0


def picture_of(wall):
    """Return a Surface with the picture of a wall's PixelMask, one pixel for each pixel of the mask."""
    solid = wall.solid
    image = pygame.Surface(solid.shape[::-1], pygame.SRCALPHA, 32)
    for y, x in np.argwhere(solid).tolist():
        image.set_at((x, y), (*PAPER, 255))
    return image


def placed(lines, pose, other):
    """Return line segments of a body, transformed from the body's pose `pose` to its pose `other`.

    lines: array (n, 4) of x0, y0, x1, y1 [px]; the result has the same shape. Both poses are (x, y, angle) [px, rad].
    """
    return moved(("lines", lines.reshape(-1, 2)), pose, other)[1].reshape(-1, 4)
