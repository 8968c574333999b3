"""Drawing of the lander: sky, ground, pads, loose bodies, the ship and its fire, and the heads-up display.

Drawing changes no state of the scene. Pictures are cached.
"""

from functools import lru_cache, partial
from math import cos, sin

import pygame

from game.drawing.canvas import CANVAS_SIZE, whole
from game.drawing.rotated import RotatedPicture
from game.drawing.sprites import lit, load_atlas
from scenes.lander import banners, board
from scenes.lander.backdrop import Backdrop
from scenes.lander.feel import REACH
from scenes.lander.moon import the_moon
from scenes.lander.rubble_picture import RubblePictures
from scenes.lander.terrain_picture import TerrainPicture
from scenes.shooter import light

NEAR = 60  # [px] around the picture in which things are drawn
FAR = 160  # [px] around the picture in which rubble is drawn, which may be large
FLAME_AT = 22.0  # [px] from the ship's middle to the middle of its flame
MAST_OFF = 15  # [px] from a pad's end to the middle of its mast
DARK = 0.5  # depth in a cave (0 outside .. 1) from which the ship lights its surroundings
WHITE = 120  # brightness that an impact adds to the ship
BOB = 2.0  # [px] amplitude of the bobbing of cans and marks
TUMBLES = 14  # quarter turns of debris a second
ROPE = ((30, 26, 44), (214, 206, 190))
LIT = 0.25  # [s] that a burst lights its surroundings


class View:
    """Renderer of the lander, with its caches of pictures. All scenes share one instance."""

    def __init__(self):
        self.atlas, self.effects = load_atlas("lander"), load_atlas("effects")
        self.backdrop, self.terrain = Backdrop(), TerrainPicture(the_moon())
        self.rubble = RubblePictures(the_moon())
        self.turned = {}  # name -> RotatedPicture
        self.white = lru_cache(maxsize=64)(lit)

    def picture(self, name):
        """Return the cached RotatedPicture of the atlas picture called `name`."""
        if name not in self.turned:
            self.turned[name] = RotatedPicture(self.atlas[name])
        return self.turned[name]

    def draw(self, scene, canvas, alpha):
        """Draw the scene on the canvas. alpha: position (0..1) between the last two steps."""
        self.surface, self.alpha = canvas.surface, alpha
        self.left, self.top = scene.camera.view(alpha)
        look, surface = scene.spectacle, canvas.surface
        self.backdrop.draw(surface, look, self.left, self.top)
        self.backdrop.draw_snow(surface, 0, look, scene.weather.wind, self.left, self.top)
        self._draw_masts(scene)
        self.terrain.draw(surface, scene.ground, self.left, self.top)
        self._draw_pads(scene)
        self._draw_cans(scene)
        self._draw_loose(scene)
        self._draw_line(scene)
        self._draw_ship(scene)
        self._draw_shells(scene)
        self._draw_works(scene, look)
        scene.particles.draw(canvas, scene.camera, alpha)
        self.backdrop.draw_snow(surface, 1, look, scene.weather.wind, self.left, self.top)
        board.draw_words(canvas, scene, (self.left, self.top), banners.covered(scene))
        board.draw_board(canvas, scene, (self.left, self.top))
        banners.draw_banners(canvas, scene)

    # --- where things are --------------------------------------------------------------------------------------------

    def pose(self, scene, identity):
        """Return (x, y, angle) [px, rad] of the body `identity`, interpolated between the last two steps."""
        row = scene.world.bodies[scene.world.rows([identity])[0]]
        back = 1.0 - self.alpha
        return tuple((row[name] - (row[name] - row[f"previous_{name}"]) * back).item() for name in ("x", "y", "angle"))

    def sees(self, x, y, margin=NEAR):
        """Return whether the world point (x, y) [px] is in the picture, or at most `margin` px outside it."""
        return -margin < x - self.left < CANVAS_SIZE[0] + margin and -margin < y - self.top < CANVAS_SIZE[1] + margin

    def centred(self, image, x, y, flags=0):
        """Draw a picture centred on the world point (x, y) [px]. flags: pygame's blend flags."""
        width, height = image.get_size()
        self.surface.blit(
            image, (whole(x - width / 2) - self.left, whole(y - height / 2) - self.top), special_flags=flags
        )

    def add_light(self, image, x, y):
        """Add a picture to the colours of the canvas, centred on the world point (x, y) [px]."""
        self.centred(image, x, y, pygame.BLEND_RGB_ADD)

    # --- what stands -------------------------------------------------------------------------------------------------

    def _draw_masts(self, scene):
        for number, pad in enumerate(scene.moon.pads):
            x, foot = pad.x + pad.width / 2 + MAST_OFF, pad.y + 9
            if not self.sees(x, foot):
                continue
            goal = scene.course.site is pad and not scene.course.over
            on = number <= scene.score.landings if not goal else int(scene.spectacle.time * 2.5) % 2 == 0
            image = self.atlas[f"mast_{int(on)}"]
            self.surface.blit(
                image, (whole(x) - image.get_width() // 2 - self.left, whole(foot) - image.get_height() - self.top)
            )
            if on:
                self.add_light(self.atlas["glow_lamp"], x, foot - 39)

    def _draw_pads(self, scene):
        for pad in scene.moon.pads:
            image = self.atlas[pad.look]
            if not self.sees(pad.x, pad.y, 80):
                continue
            self.surface.blit(image, (whole(pad.x - image.get_width() / 2) - self.left, whole(pad.y) - self.top))
            if scene.course.site is pad and not scene.course.over:
                lift = BOB * sin(scene.spectacle.time * 4.0)
                for side in (-1, 1):
                    self.add_light(self.atlas["glow_goal"], pad.x + side * (pad.width / 2 - 5), pad.y + 1)
                board.chevron(self.surface, whole(pad.x) - self.left, whole(pad.y - 44 + lift) - self.top)

    def _draw_cans(self, scene):
        image = self.atlas.animation("can").at(scene.spectacle.time)
        for x, y in scene.yard.cans.values():
            if self.sees(x, y):
                self.add_light(self.effects["glow_small"], x, y)
                self.centred(image, x, y + BOB * sin(scene.spectacle.time * 3.0 + x))

    # --- what is loose -----------------------------------------------------------------------------------------------

    def _draw_loose(self, scene):
        for identity, piece in scene.yard.rubble.pieces.items():
            x, y, angle = self.pose(scene, identity)
            if self.sees(x, y, FAR):
                self.rubble.draw(self.surface, piece, scene.world.body(identity), x - self.left, y - self.top, angle)
        for identity, cargo in scene.yard.cargo.items():
            x, y, angle = self.pose(scene, identity)
            if self.sees(x, y):
                self.picture(cargo.look).draw(self.surface, x - self.left, y - self.top, angle)

    def _draw_line(self, scene):
        line, ship = scene.line, scene.ship
        if not ship.here:
            return
        x, y, _ = self.pose(scene, ship.body.id)
        if line.load is None:
            self._mark_reach(scene, x, y)
            return
        load_x, load_y, _ = self.pose(scene, line.load.id)
        points = [(whole(px) - self.left, whole(py) - self.top) for px, py in line.points(partial(self.pose, scene))]
        for color, lift in ((ROPE[0], 1), (ROPE[1], 0)):
            pygame.draw.lines(self.surface, color, False, [(px, py + lift) for px, py in points])
        self.centred(self.atlas["hook"], load_x, load_y)

    def _mark_reach(self, scene, x, y):
        """Draw a mark above each piece of cargo near the ship at (x, y) [px].

        A mark is green if the line can reach the cargo.
        """
        near = [
            (place[0], place[1])
            for place in (self.pose(scene, identity) for identity in scene.yard.cargo)
            if (place[0] - x) ** 2 + (place[1] - y) ** 2 < (2.6 * REACH) ** 2
        ]
        for place_x, place_y in near:
            lift = BOB * sin(scene.spectacle.time * 5.0)
            inside = (place_x - x) ** 2 + (place_y - y) ** 2 < REACH * REACH
            board.hook_mark(self.surface, whole(place_x) - self.left, whole(place_y - 17 + lift) - self.top, inside)

    # --- the ship ----------------------------------------------------------------------------------------------------

    def _draw_ship(self, scene):
        ship = scene.ship
        if not ship.here:
            return
        x, y, angle = self.pose(scene, ship.body.id)
        if scene.spectacle.shelter > DARK:
            self.add_light(self.atlas["glow_ship"], x, y)
        if ship.thrusting:
            animation = self.atlas.animation("flame")
            name = animation.names[animation.index_at(scene.spectacle.time)]
            foot_x, foot_y = x - FLAME_AT * sin(angle), y + FLAME_AT * cos(angle)
            self.add_light(self.atlas["glow_flame"], foot_x, foot_y)
            self.picture(name).draw(self.surface, foot_x - self.left, foot_y - self.top, angle)
        image = self.picture("ship").at(angle)
        self.centred(self.white(image, WHITE) if scene.spectacle.lit else image, x, y)

    def _draw_shells(self, scene):
        image = self.atlas.animation("shell").at(scene.spectacle.time)
        for identity in scene.gun.shells:
            x, y, _ = self.pose(scene, identity)
            self.add_light(self.effects["glow_small"], x, y)
            self.centred(image, x, y)

    # --- what flies about --------------------------------------------------------------------------------------------

    def _draw_works(self, scene, look):
        works = look.works
        for frame, x, y, _, _, age, _ in works.debris:
            self.centred(tumbled(self.effects[frame], int(age * TUMBLES) % 4), x, y)
        # Smoke is drawn below fire, also if it began later.
        for name, x, y, _, _, age in sorted(works.bursts, key=lambda burst: burst[0] != "smoke"):
            if age < 0.0:
                continue
            if name.startswith("explosion") and age < LIT:
                self.add_light(self.effects["glow_large"], x, y)
            self.centred(self.effects.animation(name).at(age, loop=False), x, y)
        light.draw_rings(self, works)


@lru_cache(maxsize=1)
def the_view():
    """Return the one View, which is created at the first call."""
    return View()


@lru_cache(maxsize=64)
def tumbled(image, quarters):
    """Return a picture of debris, rotated counterclockwise by `quarters` quarter turns."""
    return pygame.transform.rotate(image, 90 * quarters)
