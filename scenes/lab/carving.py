"""Ground of 480 x 240 pixels to blast and dig: do loose parts fall, roll and come to rest by their own pixels?

In short: parts that are cut free hang in the air. X lets them fall with their own pixels.

What to see: a carve rebuilds only the tiles that it touches, so it costs the same in large ground as in small. A loose
part becomes a body in the same step, with its own pixels, mass and spin. All pixels are counted: a pixel that left the
ground is in a fragment, was removed by the tool, or was a crumb. The overlay of masks shows the tiles.

Why it matters: Diggable ground must be rebuilt; the cost of a hole must not grow with the level.

To try: cut a block free on all sides, and watch it become a body with the last pixel.

Source: Rosenfeld and Pfaltz, Sequential operations in digital picture processing, 1966 (pieces).
"""

from dataclasses import replace
from math import hypot

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, INK, PAPER, SLATE
from game.drawing.headline import Headline
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas, load_backdrop
from game.measurement_requests import STEPS, Act, MeasuredRun, RunRequest
from game.scene import STANDS, Goal, Scene, Slider
from physics import Circle, Effects, Material, PixelMask, Polygon
from physics.tables.shape import PART
from scenes.lab.costs import cost_text
from scenes.lab.digging_plan import plan
from scenes.lab.prints import Prints
from scenes.lab.tools import TOOLS, Tool
from scenes.lab.yard import HEAD, plate

TOP, BOTTOM = 24, 264  # [px] of the ground
CRUMB = 12  # pixels: smaller pieces are removed when they come loose
BLAST_REACH, BLAST_SPEED = 2.6, 190.0  # radii; [px/s] speed that a blast gives to the nearest bodies
EARTH, IRON = Material(density=1.0, friction=0.7, rolling_resistance=0.02), Material(3.0, 0.5, 0.2, 0.03)
DUST = ((226, 200, 160), (176, 140, 108), (120, 92, 80), (70, 56, 60))
SPARKS = ((255, 255, 230), (255, 214, 90), (255, 148, 40), (140, 40, 52))
# Loose things: the picture, x, y [px]. Those of iron are circles and are not carved.
MASKS = (
    *(("lab", "crate_16_1", x, y) for x, y in ((22, 140), (40, 140), (31, 123), (420, 126), (438, 126), (429, 109))),
    ("lab", "bracket_teal", 86, 138),
    ("lab", "star_gold", 168, 144),
    ("lab", "disc_large", 204, 145),
    ("hero", "idle_0", 142, 147),
    ("lab", "bracket_purple", 268, 86),
    ("lab", "crate_16_0", 294, 84),
    ("lab", "disc_large", 460, 114),
)
BALLS = (("ball_2", 5.0, 56, 148), ("ball_5", 5.0, 188, 152), ("ball_1", 5.0, 364, 124), ("steel_ball", 14.0, 390, 112))
LOOSE = ("hang", "fall")
OPENS = 30  # step of a first cut, unless the player has carved
CUTS = ((52, 8, 240, 172), (8, 30, 218, 190), (8, 30, 262, 190), (52, 26, 240, 216))  # width, height, x, y: a block
KNOCK = 70.0  # [px/s] a softer one is silent
PLATE = (4, 19, 122, 85)
FEWEST = 6  # places of the ground at which a carve is timed


class Carving(Scene):
    """Scene with one world: the ground, bodies on it, and the fragments carved off the ground and the bodies."""

    name = "lab/carving"
    title = "Carving"
    question = STANDS
    about = "Blast and dig with the mouse: pieces come loose, fall, roll and rest by their own pixels."
    effects = Effects(
        response=True,
        gravity=True,
        rotation=True,
        friction=True,
        restitution=True,
        stacking=True,
        sleeping=True,
        carving=True,
    )
    pieces = ("masks", "circles", "boxes", "queries")
    features = (
        "ground, crates and sprites carved by discs, boxes and sprites",
        "what comes loose is a body of its own pixels",
        "pixels, pieces, tiles, and the cost of a carve, measured beside the game",
    )
    sliders = (
        Slider("tool", 0, len(TOOLS) - 1, 0, choices=TOOLS),
        Slider("radius", 3, 40, 14, "px"),
        Slider("loose parts", 0, 1, 0, choices=LOOSE),
    )
    actions = (("X", "loose parts"), ("mouse", "blast, dig"), ("wheel", "radius"), ("left right", "tool"))
    broadphase = "tree"
    head = HEAD
    legend_at = (4, 198)
    hides_pointer = False

    def build(self):
        """Build the ground, the bedrock, the walls at both sides of the picture, and the bodies on the ground."""
        self.sky, self.wall = load_backdrop("sky_dusk"), load_backdrop("lab_earth_wall")
        world = self.add_world()
        for shape, place in (
            (Polygon.box(680, 40), (240, BOTTOM + 20)),
            (Polygon.box(40, 900), (-21, -100)),
            (Polygon.box(40, 900), (501, -100)),
        ):
            world.add_body(shape, position=place, kind="static")
        self.prints, self.cast, self.tool = Prints(), Cast(load_atlas("lab")), Tool()
        picture = load_backdrop("lab_earth")
        mask = PixelMask.from_surface(picture, origin=(0, 0))
        ground = world.add_body(mask, position=(0, TOP), kind="static", material=EARTH)
        self.ground = self.prints.add(ground, picture).id
        for sheet, name, x, y in MASKS:
            atlas = load_atlas(sheet)
            body = world.add_body(atlas.mask(name), position=(x, y), material=EARTH)
            self.prints.add(body, atlas[name])
        for name, radius, x, y in BALLS:
            self.cast.add(world.add_body(Circle(radius), position=(x, y), material=IRON), name)
        self.whole = self.left = self.solid()  # pixels before the first carve, and now
        self.removed = self.crumbs = self.carves = self.made = self.unequal = 0
        self.fell = 0.0  # [px] greatest fall of a piece since it came loose
        self.hanging = set()  # ids of loose parts that are held in the air
        self.loose_at = {}  # body id -> height of its centre when it came loose [px]
        self.pointed = (240, 100)
        self.anew = 0  # tiles of the ground rebuilt by the last carve
        self._take_tool()

    def _take_tool(self):
        self.tool.choose(TOOLS[int(self.values["tool"])], int(self.values["radius"]))
        self.draggable = self.tool.name == "hand"

    def change_slider(self, name, value):
        """Set the slider `name` to `value`: the tool, its radius, or whether loose parts fall."""
        super().change_slider(name, value)
        self._take_tool()
        if name == "loose parts" and self.values[name]:
            for identity in sorted(self.hanging):
                self.world.body(identity).set_kind("dynamic")
            self.hanging.clear()

    def solid(self):
        """Return the number of solid pixels in the masks of all bodies."""
        masks = (shape for each in self.prints.of for shape in self.world.body(each).shapes)
        return sum(int(np.count_nonzero(mask.solid)) for mask in masks if isinstance(mask, PixelMask))

    def update(self, inputs):
        """Process keys and the tool, and make one step."""
        for name, back, forth in (("tool", "left", "right"), ("radius", "down", "up")):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(name, self.values[name] + way)
        if inputs.wheel:
            self.change_slider("radius", self.values["radius"] + inputs.wheel)
        self.pointed = inputs.pointer
        cut = self.tool.cut(inputs)
        if cut is not None and inputs.pointer[1] > HEAD:
            self._carve(*cut, self.tool.reach)
            if self.tool.name == "blast":
                self._blast(*self.pointed)
        if inputs.pressed("bomb"):
            self.change_slider("loose parts", 1 - self.values["loose parts"])
        if self.frame == OPENS and not self.carves:
            for width, height, x, y in CUTS:
                self._carve(Polygon.box(width, height), (x, y, 0.0), ((x - width, y - height), (x + width, y + height)))
        self.world.step()
        self._follow()

    def _carve(self, shape, pose, reach):
        """Carve a shape out of every carvable body within reach, and update the counts.

        pose: (x, y, angle) [px, rad] of `shape`; reach: corners ((x, y), (x, y)) of the box that it is in.
        """
        x, y = pose[:2]
        tiles = self._tiles()
        reached = sorted(self.world.query_aabb(*reach), key=lambda each: each.id)
        taken = sum(self._carve_one(body, shape, pose) for body in reached if body.id in self.prints.of)
        if taken:
            self.carves += 1
            self.left = self.solid()
            self.unequal += self.left + self.removed + self.crumbs != self.whole
            now = self._tiles()
            self.anew = sum(now.get(tile) != tiles.get(tile) for tile in now.keys() | tiles.keys())
            self.particles.burst(x, y, min(10 + taken // 12, 90), DUST, (10, 110), (0.3, 0.9), gravity=200.0)

    def _carve_one(self, body, shape, pose):
        """Carve `shape` out of one body, and return the number of pixels that the shape removed.

        Fragments become bodies of the scene. A body without pixels left is removed from the scene's tables. pose: (x,
        y, angle) [px, rad] of `shape`.
        """
        identity, place, (before,) = body.id, (*body.position, body.angle), body.shapes
        parent = (self.prints.of[identity], before, place)
        carved = body.carve(shape, pose, crumb=CRUMB)
        for piece in carved.fragments:
            self.prints.add_piece(piece, parent)
            self.loose_at[piece.id] = piece.center[1]
            if not self.values["loose parts"] and body.kind == "static":
                piece.set_kind("static")
                self.hanging.add(piece.id)
        if identity not in self.world:
            self.prints.forget(identity)
            self.loose_at.pop(identity, None)
            self.hanging.discard(identity)
        self.removed += carved.removed
        self.crumbs += carved.crumbs
        self.made += len(carved.fragments)
        return carved.removed

    def measured(self):
        """Return a RunRequest for one run that the measuring process times during the game.

        In this run the current tool carves at up to sixty places of the ground. Return None if the tool does not
        carve, or if too little ground is left.
        """
        if self.tool.name == "hand" or self.ground not in self.world:
            return None
        masks = self.world.body(self.ground).shapes
        solid = sum(mask.area for mask in masks if isinstance(mask, PixelMask))
        square = (2 * self.tool.radius) ** 2
        if solid < FEWEST * square:
            return None
        act = Act(f"{__package__}.tools:carving", (self.tool.name, self.tool.radius, self.ground, CRUMB))
        steps = max(FEWEST, min(STEPS, solid // (2 * square)))
        return RunRequest(
            [self._run_name()], lambda name: MeasuredRun([self.world.snapshot()], self.broadphase, steps, act=act)
        )

    def _run_name(self):
        return self.tool.name, self.tool.radius

    def _tiles(self):
        """Return {tile of the ground: list of the ids of its collision parts}.

        A rebuilt tile has parts with new ids.
        """
        shapes = self.world.shapes
        mine = shapes[(shapes["body"] == self.ground) & (shapes["role"] == PART)]
        found = {}
        for tile, identity in zip(mine["tile"].tolist(), mine["id"].tolist(), strict=True):
            found.setdefault(tile, []).append(identity)
        return found

    def _blast(self, x, y):
        """Push the dynamic bodies around (x, y) [px] outwards. A nearer body gets a higher speed."""
        reach = BLAST_REACH * self.tool.radius
        self.play("explosion", x, 0.5)
        self.camera.shake(0.18 + self.tool.radius / 120)
        self.particles.burst(x, y, 30, SPARKS, (30, 40 + 6 * self.tool.radius), (0.15, 0.5))
        for body in self.world.overlap(Circle(reach), (x, y)):
            if body.kind == "dynamic":
                dx, dy = body.center[0] - x, body.center[1] - y
                far = hypot(dx, dy)
                if far > 0.0:
                    gain = BLAST_SPEED * max(0.15, 1.0 - far / reach) * body.mass / far
                    body.apply_impulse((gain * dx, gain * dy - 0.25 * gain * far))

    def _follow(self):
        """Update the greatest distance that a loose piece has fallen, and play a sound for the strongest impact of
        this step.
        """
        for identity, height in self.loose_at.items():
            self.fell = max(self.fell, self.world.body(identity).center[1] - height)
        hits = self.world.events.hits
        loud = hits[hits["speed"] > KNOCK]
        if len(loud):
            first = loud[int(np.argmax(loud["normal_impulse"]))]
            self.play("land", float(first["point_x"]), 0.35)

    @property
    def awake(self):
        """Number of awake bodies."""
        bodies = self.world.bodies
        return int(np.count_nonzero(bodies["awake"] & (bodies["inverse_mass"] > 0.0)))

    def draw(self, canvas, alpha):
        """Draw the sky, the wall behind carved pixels, all bodies with pixels, and the figures.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.blit(self.sky, (0, 0))
        camera = self.camera
        left, top = camera.view(alpha)
        canvas.surface.blit(self.wall, (-left, TOP - top))
        canvas.surface.fill(INK, (0, BOTTOM - top, 480, 270 - BOTTOM + top + 8))
        canvas.surface.fill(SLATE, (0, BOTTOM - top, 480, 1))
        self.prints.draw(canvas, camera, self.world, alpha)
        self.cast.draw(canvas, camera, self.world, alpha)
        self.particles.draw(canvas, camera, alpha)
        plate(canvas, PLATE)
        x, y = PLATE[:2]
        canvas.text(f"{self.tool.name}", x + 5, y + 4, GOLD)
        canvas.text(f"{self.tool.radius} px" if self.tool.name != "hand" else "", x + 116, y + 4, GOLD, align="right")
        shapes = self.world.shapes
        rows = (
            ("pixels carved", f"{self.removed:,}"),
            ("in crumbs", f"{self.crumbs:,}"),
            ("pieces", f"{self.made}"),
            ("a carve", cost_text(self, self._run_name())),
            ("tiles made anew", f"{self.anew} of {len(self._tiles())}"),
            ("parts", f"{int(np.count_nonzero(shapes['role'] == PART)):,}"),
            ("awake", f"{self.awake} of {int(np.count_nonzero(self.world.bodies['inverse_mass'] > 0.0))}"),
            ("pixels", f"{self.whole - self.removed - self.crumbs:,}"),
        )
        for number, (word, value) in enumerate(rows):
            canvas.text(word, x + 5, y + 17 + number * 8, FOG, SMALL)
            canvas.text(value, x + 116, y + 17 + number * 8, PAPER, SMALL, align="right")

    def draw_on_frame(self, frame):
        """Draw the outline of the tool around the pointer."""
        if self.tool.name == "hand":
            return
        lens = frame.lens(self.camera)
        x, y = self.pointed
        points = [lens.points(x + dx, y + dy) for dx, dy in self.tool.ring()]
        pygame.draw.lines(frame.surface, INK, True, points, 3 * max(1, frame.scale - 1))
        pygame.draw.lines(frame.surface, GOLD, True, points, max(1, frame.scale - 1))

    def check(self):
        """Return the scene's goals, a list of Goal.

        No pixel is lost, undermined ground falls, and all bodies come to rest.
        """
        bodies = self.world.bodies
        finite = all(np.isfinite(bodies[name]).all() for name in ("x", "y", "angle", "vx", "vy"))
        inside = bool((bodies["y"][bodies["inverse_mass"] > 0.0] < BOTTOM).all())
        return [
            Goal(
                "no pixel is lost: left, carved and crumbs are all there were",
                60,
                self.carves > 0 and self.unequal == 0 and self.left + self.removed + self.crumbs == self.whole,
                f"{self.left} + {self.removed} + {self.crumbs} of {self.whole}, {self.unequal} carves differ",
            ),
            Goal("pieces came loose", 240, self.made >= 3, f"{self.made}"),
            Goal("what was undermined fell", 400, self.fell > 30.0, f"{self.fell:.0f} px"),
            Goal("everything is finite, and inside", 600, finite and inside, f"{len(bodies)} bodies"),
            Goal("all sleep in the end", 600, self.awake == 0, f"{self.awake} awake"),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        hang, lost = len(self.hanging), self.whole - self.left - self.removed - self.crumbs
        sentence = "A part that is cut free hangs in the air."
        number, unit = f"{hang} of {self.made}", f"loose parts hang, {lost} pixels lost"
        headline = Headline(sentence, "X: let them fall", number, unit, self.carves, 1, "cuts", not hang)
        return headline.asks("Does a part that is cut free fall with its own pixels?")

    def finding(self):
        """Return a sentence on the last carve: the number of tiles of the ground that it rebuilt.

        The sentence also gives the numbers of pixels that were removed and lost so far.
        """
        if not self.carves:
            return "not yet: something has to be carved"
        lost = self.whole - self.left - self.removed - self.crumbs
        tiles = f"the last carve made {self.anew} of {len(self._tiles())} tiles of the ground anew"
        return f"{tiles}; of {self.whole:,} pixels {self.removed + self.crumbs:,} were taken and {lost} lost"

    def bot(self):
        """Return the bot's input for the next step, from the plan in digging_plan.py.

        The bot undermines a bridge, a rock on a thin neck and a cliff. It digs under the crates, and carves with the
        star.
        """
        inputs = plan(self.frame)
        return inputs if self.frame else replace(inputs, changes=(*inputs.changes, ("slider:loose parts", 1)))

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the counts. The worlds are hashed separately."""
        return (
            self.frame,
            *self.values.values(),
            *(self.removed, self.crumbs, self.made, self.carves, self.left, self.unequal, self.fell),
            *(self.tool.last or (0.0, 0.0)),
            *(value for pair in sorted(self.loose_at.items()) for value in pair),
        )
