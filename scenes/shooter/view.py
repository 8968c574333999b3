"""Drawing of the shooter, from the ground up: shadows, planes, fire, and bullets on top.

Drawing changes no state of the scene. NumPy computes the positions of the bullets, and one call per look draws them. A
sprite is drawn exactly where the physics has its mask: floor(position - origin + 0.5).
"""

from functools import lru_cache
from itertools import repeat
from math import sin

import numpy as np
import pygame

from game.drawing.blit import blit_many
from game.drawing.canvas import CANVAS_SIZE
from game.drawing.sprites import RotatedSprites, lit, load_atlas
from scenes.shooter import banners, board, light
from scenes.shooter.bullets import LOOKS, NAMES
from scenes.shooter.cast import GROUNDED
from scenes.shooter.ending import PLAYING
from scenes.shooter.fireworks import BURNING
from scenes.shooter.ground import draw_ground
from scenes.shooter.loot import PICTURES
from scenes.shooter.plane import RING_RADIUS, SPEED
from scenes.shooter.wreck_view import WreckView

SHADOW_AT = (15, 24)  # [px] from a plane to its shadow on the ground
SHADOW = (8, 12, 30, 84)
CYCLES = {
    "red": "bullet_red",
    "purple": "bullet_purple",
    "orange": "bullet_orange",
    "small": "bullet_small",
    "big": "bullet_big",
    "hollow": "bullet_ring",
}
GLOWS = {
    "shot": "glow_blue",
    "heavy": "glow_blue",
    "red": "glow_small",
    "orange": "glow_small",
    "purple": "glow_blue",
    "big": "glow_small",
}
MOST_GLOWS = 160  # bullets of a look with a glow; more would be one bright fog, and slow
OUT = 24  # [px] a bullet this far outside of the picture is invisible, with its light
EXHAUST_AT = 15  # [px] from the plane's middle to the root of its flame
EXHAUST_PLAY = 0.35  # share by which the flame is longer at full speed up, and shorter at full speed down
MUZZLE_AT, MUZZLE_STEPS = 16, 4  # [px] from the plane's middle to its guns; steps of their flash
WHITE, PALE = 190, 28  # brightness that a hit adds to a plane, and to a heavy one
FAINT = 120  # alpha of a ghost, and of the core while it is not marked
TUMBLES = 14  # quarter turns of debris a second
STURDY = 20  # planes with more health than this have a health bar
HEALTH_AT = 26  # [px] from a plane's middle up to its health bar
LIT = 0.25  # [s] that an explosion lights its surroundings
BLINK = 8  # steps of one blink of a ghost


class View:
    """Renderer of the shooter, with its caches of pictures. All scenes share one instance."""

    def __init__(self):
        self.planes, self.effects = load_atlas("planes"), load_atlas("effects")
        self.turned = {}  # (atlas, shown frame, frame that collides) -> RotatedSprites
        self.shaded, self.whitened = lru_cache(maxsize=512)(shade), lru_cache(maxsize=512)(lit)
        self.outlined = lru_cache(maxsize=16)(outline)
        self.ghostly = lru_cache(maxsize=16)(ghostly)
        self.stretched = lru_cache(maxsize=64)(stretched)
        self.tumbled = lru_cache(maxsize=64)(tumbled)
        self.wrecks = WreckView(self)

    def sprite(self, atlas, frame, angle=0.0, mask=None):
        """Return (image, origin [px]) of a picture at an angle [rad]. The image covers exactly the rotated mask.

        frame: name of the picture; mask: name of the picture whose mask is the shape, None for `frame` itself; origin:
        point of the image that is at the body's position.
        """
        mask = mask or frame
        if angle == 0.0:
            return atlas[frame], atlas.mask(mask).origin
        key = (atlas is self.planes, frame, mask)
        if key not in self.turned:
            self.turned[key] = RotatedSprites(atlas[frame], atlas.mask(mask))
        return self.turned[key].at(angle)

    def draw(self, scene, canvas, alpha):
        """Draw the scene on the canvas. alpha: position (0..1) between the last two steps."""
        self.surface, self.alpha = canvas.surface, alpha
        self.left, self.top = scene.camera.view(alpha)
        self.time = scene.spectacle.time
        works = scene.spectacle.works
        draw_ground(self.surface, scene, alpha, self.left, self.top)
        ground, air = self._planes(scene)
        blit_many(self.surface, ground)
        blit_many(
            self.surface, [(self.shaded(image), (x + SHADOW_AT[0], y + SHADOW_AT[1])) for image, (x, y), _ in air]
        )
        self.wrecks.draw(scene, shaded=True)
        self._draw_loot(scene)
        self._draw_bullets(scene, scene.shots)
        self._draw_exhaust(scene)
        blit_many(
            self.surface, [(self.whitened(image, white) if white else image, place) for image, place, white in air]
        )
        self._draw_health(scene)
        self._draw_debris(works)
        self._draw_bursts(works)
        self.wrecks.draw(scene)
        light.draw_rings(self, works)
        light.draw_bomb(self, scene)
        scene.particles.draw(canvas, scene.camera, alpha)
        board.draw_words(canvas, scene, (self.left, self.top))
        self._draw_bullets(scene, scene.incoming)
        self._draw_player_marks(scene)
        board.draw_board(canvas, scene)
        banners.draw_banners(canvas, scene)

    def places(self, scene, ids):
        """Return (x, y, angle), three arrays [px, px, rad] of the poses of bodies. ids: their ids.

        Positions are interpolated between the last two steps; angles are not.
        """
        rows, bodies = scene.world.rows(ids), scene.world.bodies
        x, y = bodies["x"][rows], bodies["y"][rows]
        back = 1.0 - self.alpha
        return (
            x - (x - bodies["previous_x"][rows]) * back,
            y - (y - bodies["previous_y"][rows]) * back,
            bodies["angle"][rows],
        )

    def at(self, x, y, origin):
        """Return the top left corner [canvas px] of a picture whose point `origin` is at the world point
        (x, y) [px].
        """
        return (int(np.floor(x - origin[0] + 0.5)) - self.left, int(np.floor(y - origin[1] + 0.5)) - self.top)

    def shadow(self, image, place, high=1.0):
        """Return (picture, position [canvas px]) of the shadow of a picture.

        place: world point (x, y) [px] of the picture's centre; high: height above the ground, as a share of the planes'
        height.
        """
        dark = shade(image)
        x, y = place[0] + SHADOW_AT[0] * high, place[1] + SHADOW_AT[1] * high
        return dark, self.at(x, y, middle(dark))

    def add_light(self, image, x, y):
        """Add a picture to the colours of the canvas, centred on the world point (x, y) [px]."""
        self.surface.blit(image, self.at(x, y, middle(image)), special_flags=pygame.BLEND_RGB_ADD)

    def _planes(self, scene):
        """Return two lists: (picture, position) of enemies on the ground, and (picture, position, whiteness) of
        planes.

        position: upper left corner [canvas px]; whiteness: strength of the white flash after a hit, 0 for none. The
        player's plane is the last entry of the second list.
        """
        ground, air = [], []
        fleet, flashes = scene.fleet.planes, scene.spectacle.flashes
        if fleet:
            x, y, angles = self.places(scene, list(fleet))
            for plane, px, py, angle in zip(fleet.values(), x.tolist(), y.tolist(), angles.tolist(), strict=True):
                image, origin = self.sprite(self.planes, self._frame(plane), angle, plane.frame)
                white = (PALE if plane.heavy else WHITE) if plane.id in flashes else 0
                if plane.side is GROUNDED:
                    ground.append((self.whitened(image, white) if white else image, self.at(px, py, origin)))
                else:
                    air.append((image, self.at(px, py, origin), white))
        player = scene.plane
        if player.here:
            image, origin = self.sprite(self.planes, player.frame)
            blinks = scene.accessibility.flashing and scene.ending.mode == PLAYING
            if blinks and player.safe % BLINK >= BLINK // 2:
                image = self.ghostly(image)
            x, y, _ = self.places(scene, [player.body.id])
            air.append((image, self.at(x[0], y[0], origin), WHITE if player.body.id in flashes else 0))
        return ground, air

    def _frame(self, plane):
        """Return the name of the current picture of an enemy plane.

        A dart has one picture for each mode. Other kinds have an animation whose pictures share one mask.
        """
        if plane.kind == "dart":
            return plane.frame
        animation = self.planes.animation(plane.frame[:-2])
        return animation.names[animation.index_at(plane.age / 60)]

    def _draw_exhaust(self, scene):
        player = scene.plane
        if not player.here:
            return
        x, y, _ = self.places(scene, [player.body.id])
        image = self.planes.animation("exhaust").at(self.time)
        width, height = image.get_size()
        # The flame is longer while the plane flies up, and shorter while it flies down.
        height = round(height * (1.0 - EXHAUST_PLAY * player.velocity[1] / SPEED))
        image = pygame.transform.scale(image, (width, height)) if player.velocity[1] else image
        self.surface.blit(image, self.at(x[0], y[0] + EXHAUST_AT, (width / 2, 0)))

    def _draw_loot(self, scene):
        if not scene.loot.items:
            return
        x, y, _ = self.places(scene, list(scene.loot.items))
        for item, px, py in zip(scene.loot.items.values(), x.tolist(), y.tolist(), strict=True):
            image = self.planes.animation(PICTURES[item.what]).at(self.time)
            self.add_light(self.effects["glow_blue" if item.what == "bomb" else "glow_small"], px, py)
            # The item pulses: wide and low, then narrow and high.
            image = self.stretched(image, round(2 * sin(6.0 * self.time + 0.1 * px)))
            self.surface.blit(image, self.at(px, py, middle(image)))

    def _draw_bullets(self, scene, bullets):
        if not len(bullets):
            return
        x, y, angles = self.places(scene, bullets.ids)
        looks = bullets.table.rows["look"]
        seen = (x > -OUT) & (x < CANVAS_SIZE[0] + OUT) & (y > -OUT) & (y < CANVAS_SIZE[1] + OUT)
        x, y, angles, looks = x[seen], y[seen], angles[seen], looks[seen]
        safe = scene.accessibility.palette != "standard" and bullets is scene.incoming
        for number in np.unique(looks).tolist():
            mine, name = looks == number, NAMES[number]
            if name in GLOWS and np.count_nonzero(mine) <= MOST_GLOWS:
                glow = self.effects[GLOWS[name]]
                self._stamp(glow, middle(glow), x[mine], y[mine], pygame.BLEND_RGB_ADD)
            frame, painted = LOOKS[name]
            shown = f"safe_{frame}" if safe else frame
            if painted is None:
                image = self.effects.animation(("safe_" if safe else "") + CYCLES[name]).at(self.time)
                self._stamp(image, self.effects.mask(frame).origin, x[mine], y[mine])
            else:
                self._stamp_turned(shown, frame, x[mine], y[mine], angles[mine])

    def _stamp(self, image, origin, x, y, flags=0):
        """Draw one picture at many world points. x, y: arrays [px].

        origin: point of the picture that is at the world point; flags: pygame's blend flags.
        """
        across = (np.floor(x - origin[0] + 0.5).astype(np.int64) - self.left).tolist()
        down = (np.floor(y - origin[1] + 0.5).astype(np.int64) - self.top).tolist()
        blit_many(self.surface, list(zip(repeat(image), zip(across, down, strict=True))), flags)

    def _stamp_turned(self, shown, frame, x, y, angles):
        """Draw one picture at many world points, each at its own angle. x, y [px] and angles [rad]: arrays.

        shown: name of the picture; frame: name of the picture whose mask is the shape.
        """
        pairs = []
        for px, py, angle in zip(x.tolist(), y.tolist(), angles.tolist(), strict=True):
            image, origin = self.sprite(self.effects, shown, angle, frame)
            pairs.append((image, self.at(px, py, origin)))
        blit_many(self.surface, pairs)

    def _draw_player_marks(self, scene):
        """Draw the marks on the player's plane: muzzle flash, core, and the hull's outline if hits of the hull cost a
        life.

        While the player flies slowly ("focus"), the core is opaque and the graze ring is visible.
        """
        player = scene.plane
        if not player.here:
            return
        x, y, _ = self.places(scene, [player.body.id])
        if scene.spectacle.muzzle < MUZZLE_STEPS:
            image = self.effects[f"muzzle_flash_{min(scene.spectacle.muzzle, 2)}"]
            self.surface.blit(image, self.at(x[0], y[0] - MUZZLE_AT, middle(image)))
        image, origin = self.sprite(self.planes, player.frame)
        # If blinking is off, a steady outline marks the invulnerable plane.
        steady = player.safe and not scene.accessibility.flashing and scene.ending.mode == PLAYING
        if steady or scene.hurts == "hull":
            self.surface.blit(self.outlined(image), self.at(x[0], y[0], (origin[0] + 1, origin[1] + 1)))
        core = self.planes.animation("core").at(self.time)
        if player.focusing:
            self.add_light(self.effects["glow_blue"], x[0], y[0])
            ring = light.circle_line(int(RING_RADIUS))
            self.surface.blit(ring, self.at(x[0], y[0], middle(ring)))
        core = core if player.focusing else light.faded(core, FAINT)
        self.surface.blit(core, self.at(x[0], y[0], middle(core)))

    def _draw_health(self, scene):
        for plane in scene.fleet.planes.values():
            if plane.full > STURDY and not plane.leads and plane.health < plane.full:
                x, y, _ = self.places(scene, [plane.id])
                place = self.at(x[0], y[0] - HEALTH_AT, (board.HEALTH_WIDTH / 2, 0))
                board.draw_health(self.surface, place, plane.health / plane.full)

    def _draw_debris(self, works):
        pairs = []
        for frame, x, y, _, _, age, life in works.debris:
            image = self.tumbled(self.effects[frame], int(age * TUMBLES) % 4, age > BURNING * life)
            pairs.append((image, self.at(x, y, middle(image))))
        blit_many(self.surface, pairs)

    def _draw_bursts(self, works):
        # Smoke is drawn below fire, also if it began later.
        for name, x, y, _, _, age in sorted(works.bursts, key=lambda burst: burst[0] != "smoke"):
            if age < 0.0:
                continue
            image = self.effects.animation(name).at(age, loop=False)
            if name.startswith("explosion") and age < LIT:
                self.add_light(self.effects["glow_large"], x, y)
            self.surface.blit(image, self.at(x, y, middle(image)))


@lru_cache(maxsize=1)
def the_view():
    """Return the one View, which is created at the first call."""
    return View()


def middle(image):
    """Return the centre (x, y) [px] of a picture, relative to its top left corner."""
    width, height = image.get_size()
    return width / 2, height / 2


def shade(image):
    """Return the shadow of a picture, a Surface: its silhouette at 3/4 of the size, dark and transparent."""
    silhouette = pygame.mask.from_surface(image).to_surface(setcolor=SHADOW, unsetcolor=(0, 0, 0, 0))
    width, height = image.get_size()
    return pygame.transform.scale(silhouette, (max(1, width * 3 // 4), max(1, height * 3 // 4)))


def ghostly(image):
    """Return a bright, transparent copy of a plane's picture.

    A plane that cannot be hit blinks: its picture and this copy are drawn alternately.
    """
    copy = lit(image, 90)
    copy.fill((255, 255, 255, FAINT), special_flags=pygame.BLEND_RGBA_MULT)
    return copy


def outline(image):
    """Return a Surface with the line of pixels around an image's solid pixels.

    It is one pixel larger than the image on each side.
    """
    width, height = image.get_size()
    mask = pygame.Mask((width + 2, height + 2))
    solid = pygame.mask.from_surface(image)
    for dx, dy in ((0, 1), (2, 1), (1, 0), (1, 2)):
        mask.draw(solid, (dx, dy))
    mask.erase(solid, (1, 1))
    return mask.to_surface(setcolor=(170, 255, 240, 230), unsetcolor=(0, 0, 0, 0))


def stretched(image, more):
    """Return the picture stretched to be `more` px wider and `more` px less high."""
    width, height = image.get_size()
    return pygame.transform.scale(image, (width + more, height - more)) if more else image


def tumbled(image, quarters, small):
    """Return a picture of debris, rotated counterclockwise by `quarters` quarter turns.

    small: whether it is reduced to two thirds.
    """
    image = pygame.transform.rotate(image, 90 * quarters)
    if small:
        image = pygame.transform.scale(image, (image.get_width() * 2 // 3, image.get_height() * 2 // 3))
    return image
