"""The picture of the shooter, from the sea up: clouds, shadows, planes, fire, and bullets above everything.

Everything is read, nothing is changed. Swarms are placed with NumPy and blitted in one call per layer. A sprite
stands where the physics puts its mask: floor(position - origin + 0.5).
"""

from functools import lru_cache

import numpy as np
import pygame

from game.compat import blit_many
from game.draw import CANVAS_SIZE
from game.sprites import TurnedSprites, lit, load_atlas, load_backdrop
from scenes.shooter import board
from scenes.shooter.bullets import LOOKS, NAMES

# Layer, its way down [px/s], px it shifts for each px that the plane is off the middle, and a fixed shift [px].
LAYERS = (("sea", 22.0, 0.04, 0), ("cloud_shadows", 36.0, 0.06, 40), ("clouds_low", 36.0, 0.08, 0),
          ("clouds_high", 74.0, 0.16, 0))
SHADOW_AT = (15, 24)         # [px] from a plane to its shadow on the sea
SHADOW = (8, 12, 30, 84)
CYCLES = {"red": "bullet_red", "purple": "bullet_purple", "orange": "bullet_orange"}
GLOWS = {"shot": "glow_blue", "red": "glow_small", "orange": "glow_small", "purple": "glow_blue"}
EXHAUST_AT = 21              # [px] from the plane's middle to that of its flames
WHITE, PALE = 190, 60         # how much a hit brightens a plane; what takes many hits only glimmers
STREAKS = 16                 # wisps of air that show the speed
BLINK = 8                    # steps of one blink of a ghost


class View:
    """Caches of pictures; one is enough for all shooters."""

    def __init__(self):
        self.planes, self.effects = load_atlas("planes"), load_atlas("effects")
        self.layers = [(load_backdrop(name), *rest) for name, *rest in LAYERS]
        self.streak = pygame.Surface((1, 14), pygame.SRCALPHA)
        for row in range(14):
            self.streak.set_at((0, row), (220, 236, 255, 4 + 4 * row))
        self.turned = {}             # (atlas, frame) -> TurnedSprites
        self.shaded, self.whitened = lru_cache(maxsize=512)(shade), lru_cache(maxsize=512)(lit)
        self.outlined = lru_cache(maxsize=16)(outline)
        self.ghostly = lru_cache(maxsize=16)(ghostly)
        self.dimmed = lru_cache(maxsize=64)(dimmed)

    def sprite(self, atlas, frame, angle=0.0):
        """(image, origin in it) of a frame at an angle: exactly the pixels of its mask."""
        if angle == 0.0:
            return atlas[frame], atlas.mask(frame).origin
        key = (atlas is self.planes, frame)
        if key not in self.turned:
            self.turned[key] = TurnedSprites(atlas[frame], atlas.mask(frame))
        return self.turned[key].at(angle)

    def draw(self, scene, canvas, alpha):
        """The whole picture."""
        self.canvas, self.surface, self.alpha = canvas, canvas.surface, alpha
        self.left, self.top = scene.camera.view(alpha)
        self.time = scene.spectacle.time
        self._draw_ground(scene)
        planes = self._planes(scene)
        below = [(self.shaded(image), (x + SHADOW_AT[0], y + SHADOW_AT[1])) for image, (x, y), _ in planes]
        blit_many(self.surface, below)
        self._draw_loot(scene)
        self._draw_bullets(scene, scene.shots)
        self._draw_exhaust(scene)
        shown = [(self.whitened(image, white) if white else image, place) for image, place, white in planes]
        blit_many(self.surface, shown)
        self._draw_marks(scene)
        self._draw_debris(scene)
        self._draw_bursts(scene)
        scene.particles.draw(canvas, scene.camera, alpha)
        board.draw_words(canvas, scene, (self.left, self.top))
        self._draw_bullets(scene, scene.incoming)
        self._draw_light(scene)
        board.draw_board(canvas, scene)

    def _places(self, scene, ids):
        """Interpolated x and y of bodies [px], as arrays, and their angles."""
        rows, bodies = scene.world.rows(ids), scene.world.bodies
        x, y = bodies["x"][rows], bodies["y"][rows]
        back = 1.0 - self.alpha
        return (x - (x - bodies["previous_x"][rows]) * back, y - (y - bodies["previous_y"][rows]) * back,
                bodies["angle"][rows])

    def _at(self, x, y, origin):
        """Canvas place of a picture whose origin is at a world point."""
        return (int(np.floor(x - origin[0] + 0.5)) - self.left, int(np.floor(y - origin[1] + 0.5)) - self.top)

    def _draw_ground(self, scene):
        time = self.time + (self.alpha - 1.0) / 60
        off = scene.spectacle.lean_at(self.alpha)
        for picture, speed, share, shift in self.layers:
            tile(self.surface, picture, shift - off * share, time * speed + shift)
        drawn = []
        for number in range(STREAKS):
            across = number * 97 % CANVAS_SIZE[0] + off * -0.3
            down = (time * (260 + 23 * (number % 5)) + number * 61) % (CANVAS_SIZE[1] + 60) - 30
            drawn.append((self.streak, (int(across) % CANVAS_SIZE[0], int(down))))
        blit_many(self.surface, drawn)

    def _planes(self, scene):
        """(picture, place, whiteness) of every plane in the air, the player last."""
        drawn = []
        fleet, flashes = scene.fleet.planes, scene.spectacle.flashes
        if fleet:
            x, y, angles = self._places(scene, list(fleet))
            for plane, px, py, angle in zip(fleet.values(), x.tolist(), y.tolist(), angles.tolist(), strict=True):
                image, origin = self.sprite(self.planes, self._frame(plane), angle)
                drawn.append((image, self._at(px, py, origin), flash_of(plane) if plane.id in flashes else 0))
        player = scene.plane
        if player.body is not None:
            image, origin = self.sprite(self.planes, player.frame)
            if player.safe % BLINK >= BLINK // 2:
                image = self.ghostly(image)
            x, y, _ = self._places(scene, [player.body.id])
            drawn.append((image, self._at(x[0], y[0], origin), WHITE if player.body.id in flashes else 0))
        return drawn

    def _frame(self, plane):
        """Saucers and gunships run through pictures that share one mask; a dart's picture is its mode."""
        if plane.kind == "dart":
            return plane.frame
        animation = self.planes.animation(plane.kind)
        return animation.names[animation.index_at(plane.age / 60)]

    def _draw_exhaust(self, scene):
        player = scene.plane
        if player.body is None:
            return
        x, y, _ = self._places(scene, [player.body.id])
        image = self.planes.animation("exhaust").at(self.time)
        self.surface.blit(image, self._at(x[0], y[0] + EXHAUST_AT, (image.get_width() / 2, image.get_height() / 2)))

    def _draw_loot(self, scene):
        if not scene.loot.born:
            return
        x, y, _ = self._places(scene, list(scene.loot.born))
        glow, image = self.effects["glow_small"], self.planes.animation("powerup").at(self.time)
        for px, py in zip(x.tolist(), y.tolist(), strict=True):
            self.surface.blit(glow, self._at(px, py, (16, 16)), special_flags=pygame.BLEND_RGB_ADD)
            self.surface.blit(image, self._at(px, py, (9, 9)))

    def _draw_bullets(self, scene, bullets):
        if not len(bullets):
            return
        x, y, angles = self._places(scene, bullets.ids)
        looks = bullets.table.rows["look"]
        for number in np.unique(looks).tolist():
            mine, name = looks == number, NAMES[number]
            glow = GLOWS.get(name)
            if glow is not None:
                self._stamp(self.effects[glow], (16.0, 16.0), x[mine], y[mine], pygame.BLEND_RGB_ADD)
            frame, painted = LOOKS[name]
            if painted is None:
                image = self.effects.animation(CYCLES[name]).at(self.time)
                self._stamp(image, self.effects.mask(frame).origin, x[mine], y[mine])
            else:
                self._stamp_turned(frame, x[mine], y[mine], angles[mine])

    def _stamp(self, image, origin, x, y, flags=0):
        """One picture at many places."""
        across = (np.floor(x - origin[0] + 0.5).astype(np.int64) - self.left).tolist()
        down = (np.floor(y - origin[1] + 0.5).astype(np.int64) - self.top).tolist()
        blit_many(self.surface, [(image, place) for place in zip(across, down, strict=True)], flags)

    def _stamp_turned(self, frame, x, y, angles):
        """One picture at many places, each at its own angle."""
        pairs = []
        for px, py, angle in zip(x.tolist(), y.tolist(), angles.tolist(), strict=True):
            image, origin = self.sprite(self.effects, frame, angle)
            pairs.append((image, self._at(px, py, origin)))
        blit_many(self.surface, pairs)

    def _draw_marks(self, scene):
        """Muzzle flash, the outline that collides while focusing, and the health of damaged gunships."""
        player = scene.plane
        if player.body is not None:
            x, y, _ = self._places(scene, [player.body.id])
            if scene.spectacle.muzzle < 4:
                image = self.effects[f"muzzle_flash_{min(scene.spectacle.muzzle, 2)}"]
                self.surface.blit(image, self._at(x[0], y[0] - 16, (7, 7)))
            if player.focusing:
                image, origin = self.sprite(self.planes, player.frame)
                self.surface.blit(self.outlined(image), self._at(x[0], y[0], (origin[0] + 1, origin[1] + 1)))
        for plane in scene.fleet.planes.values():
            if plane.full > 8 and plane.health < plane.full:
                x, y, _ = self._places(scene, [plane.id])
                board.draw_health(self.surface, self._at(x[0], y[0] - 26, (18, 0)), plane.health / plane.full)

    def _draw_debris(self, scene):
        pairs = []
        for frame, x, y, _, _, age, life in scene.spectacle.debris:
            image = self.effects[frame]
            quarter = int(age * 14) % 4
            image = self.dimmed(image, quarter, age > 0.7 * life)
            pairs.append((image, self._at(x, y, (image.get_width() / 2, image.get_height() / 2))))
        blit_many(self.surface, pairs)

    def _draw_bursts(self, scene):
        # Smoke lies under fire, whatever came first.
        for name, x, y, _, _, age in sorted(scene.spectacle.bursts, key=lambda burst: burst[0] != "smoke"):
            if age < 0.0:
                continue
            image = self.effects.animation(name).at(age, loop=False)
            half = image.get_width() / 2
            if name.startswith("explosion") and age < 0.25:
                glow = self.effects["glow_large"]
                self.surface.blit(glow, self._at(x, y, (48, 48)), special_flags=pygame.BLEND_RGB_ADD)
            self.surface.blit(image, self._at(x, y, (half, half)))

    def _draw_light(self, scene):
        """A large explosion lights the picture for a moment; never more than a tenth of white."""
        light = int(26 * scene.spectacle.shock)
        if light > 1:
            self.surface.fill((light, light * 2 // 3, light // 3), special_flags=pygame.BLEND_RGB_ADD)


@lru_cache(maxsize=1)
def the_view():
    """The one View, made when the first picture is wanted."""
    return View()


def flash_of(plane):
    """How white a plane turns when it is hit."""
    return PALE if plane.full > 8 else WHITE


def tile(surface, picture, x, y):
    """Cover the surface with a picture that repeats both ways, its corner at (x, y)."""
    width, height = picture.get_size()
    start = int(np.floor(y + 0.5)) % height - height
    left = int(np.floor(x + 0.5)) % width - width
    for top in range(start, CANVAS_SIZE[1], height):
        for side in range(left, CANVAS_SIZE[0], width):
            if top + height > 0 and side + width > 0:
                surface.blit(picture, (side, top))


def shade(image):
    """The shadow of a picture: its silhouette, small as seen from above, dark and clear."""
    silhouette = pygame.mask.from_surface(image).to_surface(setcolor=SHADOW, unsetcolor=(0, 0, 0, 0))
    width, height = image.get_size()
    return pygame.transform.scale(silhouette, (max(1, width * 3 // 4), max(1, height * 3 // 4)))


def ghostly(image):
    """A plane that nothing can hit, in every other moment: bright and clear."""
    copy = lit(image, 90)
    copy.fill((255, 255, 255, 120), special_flags=pygame.BLEND_RGBA_MULT)
    return copy


def outline(image):
    """A thin line around the solid pixels of a picture, one pixel larger on each side."""
    width, height = image.get_size()
    mask = pygame.Mask((width + 2, height + 2))
    solid = pygame.mask.from_surface(image)
    for dx, dy in ((0, 1), (2, 1), (1, 0), (1, 2)):
        mask.draw(solid, (dx, dy))
    mask.erase(solid, (1, 1))
    return mask.to_surface(setcolor=(170, 255, 240, 230), unsetcolor=(0, 0, 0, 0))


def dimmed(image, quarter, small):
    """Debris: turned by quarters as it tumbles, half the size when it is nearly burnt."""
    image = pygame.transform.rotate(image, 90 * quarter)
    if small:
        image = pygame.transform.scale(image, (image.get_width() * 2 // 3, image.get_height() * 2 // 3))
    return image
