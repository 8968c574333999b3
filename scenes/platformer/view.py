"""Drawing of the platformer: background, tiles, objects, hero, ghost of the best run, lights, and texts.

Drawing changes no state of the scene; pictures are cached.
"""

from functools import lru_cache

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import CANVAS_SIZE, Canvas, whole
from game.drawing.rotated import RotatedPicture
from game.drawing.sprites import load_atlas, load_image
from game.drawing.tile_picture import TilePicture
from scenes.platformer import board
from scenes.platformer.backdrop import Backdrops
from scenes.platformer.blast_view import BlastView
from scenes.platformer.blasting import THROWN
from scenes.platformer.feel import APEX_SPEED, HEIGHT, steps
from scenes.platformer.lighting import Lighting, wave
from scenes.platformer.look import AFTERIMAGES, fuse_end
from scenes.platformer.things import SHAKES

STRIDE = 13.0  # [px] of path per frame of the run, so that feet do not slide
PUSH_STRIDE, RUNG_STRIDE = 9.0, 7.0
ABOVE_BOARDS = 12  # [px] start of a bridge's ropes above the ends of its boards
STANDING = 12.0  # [px/s] speed below which the hero is drawn standing
FRAME = 24  # [px] width and height of the hero's pictures
NEAR = 40  # [px] around the picture in which things are drawn
LIT_FROM = 100  # [px] distance from the picture within which a light reaches into it
COIN_WAVE = 0.9  # [px] amplitude of the bobbing of coins, in a wave along the level
GHOST = (96, 190, 255)  # added to the colours of the ghost
GHOST_ALPHA = 130
IMAGE = (120, 130, 220)  # added to the colours of an afterimage
IMAGE_ALPHA, ALPHA_STEP = 110, 22  # alpha of a new afterimage; it fades in steps, so that few pictures are cached
SPARED_BLINK = 8  # [steps] of one blink of a hero who was just hurt
TUMBLE = (30.0, 90.0, 420.0)  # speed aside and up [px/s], and gravity [px/s2], of flattened bats and hedgehogs
LAYERS = ("wall", "decor", "solid")
SHINING = ("secret", "goal", "coin")


class View:
    """Renderer of a level, with caches of its pictures."""

    def __init__(self, level):
        self.level = level
        sheet = load_image(level.picture)
        self.backdrops, self.lighting = Backdrops(level), Lighting()
        self.layers = {
            name: TilePicture(level.map, name, sheet) for name in (*LAYERS, "cover") if name in level.map.layers
        }
        self.things, self.hero = load_atlas("things"), load_atlas("hero")
        self.crates = [RotatedPicture(self.things[name]) for name in ("crate", "crate_large")]
        self.bits = [RotatedPicture(self.things[f"crumble_bit_{number}"]) for number in range(3)]
        self.blasts = BlastView(self)
        self.shaped = lru_cache(maxsize=512)(self._shaped)
        self.tinted = lru_cache(maxsize=512)(self._tinted)
        self._paint_ahead()
        self.covers = [self._cover(thing) for thing in level.covers]

    def _paint_ahead(self):
        """Draw all tiles once to fill the cache: 0.2 s at the start, instead of pauses of 10 ms during the game."""
        canvas, camera = Canvas(), Camera()
        for left in range(0, self.level.size[0], CANVAS_SIZE[0]):
            for top in range(0, self.level.size[1], CANVAS_SIZE[1]):
                camera.place(left, top)
                for name in LAYERS:
                    if name in self.layers:
                        self.layers[name].draw(canvas, camera)

    def _cover(self, thing):
        """Return (picture, left, top) of the tiles that cover a hidden room and its walls.

        thing: the room, an object of the map; left, top: position of the picture in the world [px].
        """
        tile = self.level.tile
        left, top = int(thing.x) - tile, int(thing.y) - tile
        canvas = Canvas(pygame.Surface((int(thing.width) + 2 * tile, int(thing.height) + 2 * tile), pygame.SRCALPHA))
        if "cover" in self.layers:
            camera = Camera(canvas.rect)
            camera.place(left, top)
            self.layers["cover"].draw(canvas, camera)
        return canvas.surface, left, top

    def draw(self, scene, canvas, alpha):
        """Draw the scene on the canvas. alpha: position (0..1) between the last two steps."""
        left, top = scene.camera.view(alpha)
        self.left, self.top = left, top
        self.near = [
            trigger for trigger in scene.things.triggers.values() if self._sees(trigger.x, trigger.y, LIT_FROM)
        ]
        self.backdrops.draw(canvas.surface, scene.look, left, top)
        for name in ("wall", "decor"):
            if name in self.layers:
                self.layers[name].draw(canvas, scene.camera, alpha)
        self._draw_still_things(canvas, scene)
        self.layers["solid"].draw(canvas, scene.camera, alpha)
        self._draw_blocks(canvas, scene)
        self._draw_bridges(canvas, scene)
        self.blasts.draw_walls(canvas, scene)
        self._draw_moving_things(canvas, scene, alpha)
        self._draw_enemies(canvas, scene, alpha)
        self._draw_ghost(canvas, scene)
        self._draw_hero(canvas, scene, alpha)
        self.blasts.draw_pieces(canvas, scene, alpha)
        self.blasts.draw_bursts(canvas, scene.look)
        self._draw_covers(canvas, scene.look)
        scene.particles.draw(canvas, scene.camera, alpha)
        self._draw_puffs(canvas, scene.look)
        self.lighting.draw(canvas.surface, list(self._lights(scene, alpha)), scene.look.dark, scene.look.time)
        board.draw_board(canvas, scene, (left, top))

    def _sees(self, x, y, reach=NEAR):
        return (
            self.left - reach < x < self.left + CANVAS_SIZE[0] + reach
            and self.top - reach < y < self.top + CANVAS_SIZE[1] + reach
        )

    def _stand(self, canvas, image, x, bottom):
        """Draw an image with the centre of its lower edge at the world point (x, bottom) [px]."""
        width, height = image.get_size()
        canvas.surface.blit(image, (whole(x) - width // 2 - self.left, whole(bottom) - height - self.top))

    def _draw_still_things(self, canvas, scene):
        things, time = self.things, scene.look.time
        for sign in self.level.map.things_of("sign"):
            if self._sees(sign.x, sign.y):
                self._stand(canvas, things["sign"], sign.x + sign.width / 2, sign.y + sign.height)
        for trigger in self.near:
            x, bottom = trigger.foot
            if trigger.kind == "checkpoint":
                image = things.animation("checkpoint").at(time + x) if trigger.lit else things["checkpoint_off"]
                self._stand(canvas, image, x, bottom)
            elif trigger.kind == "goal":
                self._stand(canvas, things.animation("goal").at(time), x, bottom)
            elif trigger.kind == "spring":
                self._stand(canvas, self._spring(scene, trigger), x, bottom)

    def _spring(self, scene, trigger):
        if trigger.touched is None:
            return self.things["spring_0"]
        return self.things.animation("spring").at((scene.ticks - trigger.touched) / 60, loop=False)

    def _draw_blocks(self, canvas, scene):
        """Draw belts and crumbling stones."""
        things = self.things
        for belt in scene.things.belts:
            left, top, right, _ = belt.box
            if not self.left - (right - left) < left < self.left + CANVAS_SIZE[0]:
                continue
            frame = int(scene.ticks * belt.speed / 60 / 4) % 4
            for x in range(left, right, 16):
                part = "left_end" if x == left else "right_end" if x == right - 16 else "mid"
                canvas.surface.blit(things[f"belt_{part}_{frame}"], (x - self.left, top - self.top))
        for crumble in scene.things.crumbles:
            if crumble.body is not None and self._sees(*crumble.center):
                left, top, _, _ = crumble.box
                worn = min(4 * crumble.count // steps(SHAKES), 3)
                shift = (crumble.count // 2) % 2 * 2 - 1 if crumble.shaking else 0
                canvas.surface.blit(things[f"crumble_{worn}"], (left + shift - self.left, top - self.top))

    def _draw_bridges(self, canvas, scene):
        for bridge in scene.things.bridges:
            x, y = bridge.left - self.left, bridge.top - self.top
            canvas.surface.blit(self.things["bridge_ropes"], (x, y - ABOVE_BOARDS))
            canvas.surface.blit(self.things["bridge"], (x, y))

    def _draw_moving_things(self, canvas, scene, alpha):
        things, look = self.things, scene.look
        for trigger in self.near:
            if trigger.kind in ("coin", "secret"):
                image = things.animation("coin" if trigger.kind == "coin" else "secret_gem").at(
                    look.time + trigger.x * 0.004
                )
                bob = COIN_WAVE * wave(look.time * 0.55 + trigger.x * 0.011)
                canvas.sprite(image, trigger.x - self.left, trigger.y + bob - self.top)
        for platform in scene.things.platforms:
            x, y = between(look.before(platform.body), platform.body.position, alpha)
            canvas.surface.blit(
                deck(int(platform.size[0])),
                (whole(x - platform.size[0] / 2) - self.left, whole(y - platform.size[1] / 2) - self.top),
            )
        for crate in scene.things.crates:
            self._draw_turned(canvas, look, crate.body, self.crates[crate.size[0] > 16], alpha)
        for crumble in scene.things.crumbles:
            for number, (body, _) in enumerate(crumble.bits):
                self._draw_turned(canvas, look, body, self.bits[number % 3], alpha)

    def _draw_turned(self, canvas, look, body, picture, alpha):
        x, y = between(look.before(body), body.position, alpha)
        if self._sees(x, y):
            angle = look.angles.get(body.id, body.angle)
            angle += (body.angle - angle) * alpha
            picture.draw(canvas.surface, x - self.left, y - self.top, angle)

    def _draw_enemies(self, canvas, scene, alpha):
        things, look = self.things, scene.look
        for enemy in scene.things.enemies.values():
            x, y = between(look.before(enemy.body), enemy.character.position, alpha)
            if not self._sees(x, y):
                continue
            if enemy.kind == "bat":
                hangs = enemy.phase == "hanging"
                image = things["bat_0"] if hangs else things.animation("bat").at(look.time + x)
                canvas.sprite(flipped(image, enemy.way >= 0, hangs), x - self.left, y - self.top)
                continue
            image = things.animation(enemy.kind).at(look.time + enemy.start[0])
            self._stand(canvas, flipped(image, enemy.way >= 0), x, y + enemy.size[1] / 2)
        for kind, x, bottom, way, age in look.flat:
            if kind == "walker":
                self._stand(canvas, flipped(things["walker_squashed"], way >= 0), x, bottom)
            else:
                image = flipped(things[f"{kind}_0"], way > 0, upside_down=True)
                aside, up, down = TUMBLE
                self._stand(canvas, image, x + aside * way * age, bottom - up * age + down * age * age)

    def _draw_puffs(self, canvas, look):
        for name, x, y, age in look.puffs:
            image = self.things.animation(name).at(age, loop=False)
            if name == "dust":
                self._stand(canvas, image, x, y)
            else:
                canvas.sprite(image, x - self.left, y - self.top)

    def _draw_covers(self, canvas, look):
        for (picture, left, top), seen in zip(self.covers, look.open, strict=True):
            place = (left - self.left, top - self.top)
            if canvas.rect.colliderect((*place, *picture.get_size())) and seen < 0.98:
                picture.set_alpha(whole(255 * (1.0 - seen)))
                canvas.surface.blit(picture, place)

    def _lights(self, scene, alpha):
        """Yield (x [canvas px], y [canvas px], name) of every light that reaches into the picture.

        alpha: position (0..1) between the last two steps.
        """
        for x, y, name in self.level.lights:
            if self._sees(x, y, LIT_FROM) and not scene.look.hidden(x, y):
                yield x - self.left, y - self.top, name
        for trigger in self.near:
            if trigger.kind == "checkpoint" and trigger.lit:
                yield trigger.foot[0] - self.left, trigger.foot[1] - 23 - self.top, "lantern"
            elif trigger.kind in SHINING and not scene.look.hidden(trigger.x, trigger.y):
                yield trigger.x - self.left, trigger.y - self.top, trigger.kind
        for bomb in scene.things.bombs:
            if bomb.phase == THROWN:
                x, y = fuse_end(bomb)
                yield x - self.left, y - self.top, "fuse"
        for x, y, _ in scene.look.blasts:
            yield x - self.left, y - self.top, "blast"
        x, y = between(scene.hero.before, scene.hero.character.position, alpha)
        yield x - self.left, y - self.top, "hero"

    # --- the hero ----------------------------------------------------------------------------------------------------

    def _draw_hero(self, canvas, scene, alpha):
        hero, look = scene.hero, scene.look
        for x, bottom, name, way, age in look.afterimages:
            left = IMAGE_ALPHA * (1.0 - age / (AFTERIMAGES + 1))
            image = self.tinted(name, way, IMAGE, whole(left / ALPHA_STEP) * ALPHA_STEP)
            self._stand(canvas, image, x, bottom)
        spared = scene.mercy and scene.phase == "playing"
        if spared and scene.accessibility.flashing and scene.mercy % SPARED_BLINK < SPARED_BLINK // 2:
            return
        x, y = between(hero.before, hero.character.position, alpha)
        bottom = y + HEIGHT / 2
        name, way = hero_frame(scene)
        if scene.phase == "hurt":
            bottom += look.fall
        elif hero.grounded:
            bottom += lowered(self.level, hero)
        image = self.shaped(name, way, whole(FRAME * look.width), whole(FRAME * look.height))
        if spared and not scene.accessibility.flashing:
            for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
                self._stand(canvas, self.tinted(name, way, (255, 255, 255), 255), x + dx, bottom + dy)
        self._stand(canvas, image, x, bottom)

    def _draw_ghost(self, canvas, scene):
        """Draw the ghost, half transparent: the hero of the best run, at the same time of his run."""
        if not scene.ghost or scene.clock >= len(scene.ghost) or scene.phase == "won":
            return
        x, bottom, name, way = scene.ghost[max(scene.clock - 1, 0)]
        if self._sees(x, bottom):
            known = name if name in self.hero.images else "idle_0"
            self._stand(canvas, self.tinted(known, 1 if way >= 0 else -1, GHOST, GHOST_ALPHA), x, bottom)

    def _shaped(self, name, way, width, height):
        image = self.hero[name]
        if (width, height) != image.get_size():
            image = pygame.transform.scale(image, (max(width, 1), max(height, 1)))
        return image if way > 0 else pygame.transform.flip(image, True, False)

    def _tinted(self, name, way, color, alpha):
        """Return a picture of the hero with `color` added.

        name: name of the picture in the atlas; way: -1 mirrors the picture; alpha: opacity, 0..255.
        """
        image = self.shaped(name, way, FRAME, FRAME).copy()
        image.fill((*color, 0), special_flags=pygame.BLEND_RGBA_ADD)
        image.fill((255, 255, 255, alpha), special_flags=pygame.BLEND_RGBA_MULT)
        return image


def hero_frame(scene):
    """Return (name, direction) of the hero's current picture. direction: 1 to the right, -1 mirrored to the left."""
    hero, look, frames = scene.hero, scene.look, load_atlas("hero")
    if scene.phase == "hurt":
        return "hurt_0", hero.facing
    if hero.ladder is not None:
        return strode(frames.animation("climb"), look.climb, RUNG_STRIDE), 1
    if hero.sliding:
        return cycle(frames.animation("slide"), look.time), hero.sliding
    if not hero.grounded:
        if hero.vy < APEX_SPEED:
            return ("jump_0" if hero.vy < -APEX_SPEED else "jump_1"), hero.facing
        return cycle(frames.animation("fall"), look.time), hero.facing
    if scene.phase == "won":
        return cycle(frames.animation("win"), look.time), hero.facing
    if hero.pushing and hero.pushed is not None:
        return strode(frames.animation("push"), look.run, PUSH_STRIDE), hero.facing
    if abs(hero.vx) > STANDING:
        return strode(frames.animation("run"), look.run, STRIDE), hero.facing
    if hero.gazing:
        return ("duck_0" if hero.gazing > 0 else "look_up_0"), hero.facing
    return cycle(frames.animation("idle"), look.time), hero.facing


@lru_cache(maxsize=2)
def level_view(level):
    """Return the View of a level. It is cached, so that a restart of the scene does not draw the pictures again."""
    return View(level)


@lru_cache(maxsize=8)
def deck(width):
    """Return a Surface with a platform of `width` px: both ends of the image, and its middle repeated between them."""
    image = load_atlas("things")["platform"]
    out = pygame.Surface((width, image.get_height()), pygame.SRCALPHA)
    for x in range(16, width - 16, 16):
        out.blit(image, (x, 0), (16, 0, min(16, width - 16 - x), image.get_height()))
    out.blit(image, (0, 0), (0, 0, 16, image.get_height()))
    out.blit(image, (width - 16, 0), (image.get_width() - 16, 0, 16, image.get_height()))
    return out


@lru_cache(maxsize=64)
def flipped(image, mirrored, upside_down=False):
    """Return a picture, mirrored left to right if `mirrored` is True, and upside down if `upside_down` is True."""
    return pygame.transform.flip(image, mirrored, upside_down) if mirrored or upside_down else image


def between(before, now, alpha):
    """Return the point (x, y) between two positions. alpha: 0 for `before` .. 1 for `now`."""
    return before[0] + (now[0] - before[0]) * alpha, before[1] + (now[1] - before[1]) * alpha


def cycle(animation, seconds):
    """Return the name of the picture that a repeated animation shows after `seconds`."""
    return animation.names[animation.index_at(seconds)]


def strode(animation, way, stride):
    """Return the name of the picture that a walking animation shows after a path of `way` px. stride: px
    per picture.
    """
    return animation.names[int(way / stride) % len(animation.names)]


def lowered(level, hero):
    """Return the distance [px] by which the hero is drawn below his box.

    On a slope, one of the box's lower corners touches the ground, but the centre of the drawn feet should touch it.
    """
    if hero.slope == 0.0:
        return 0.0
    left, _, right, bottom = hero.box
    half = 0.5 * (right - left)
    # Limited by the fall of the slope from the corner to the middle, because tilted crates count as ground, too.
    return min(level.drop_to_ground((left + right) / 2, bottom, half), abs(hero.slope) * half)
