"""The picture of the platformer: dusk behind, tiles in chunks, things, the hero, lights, and words on top.

Everything is read, nothing is changed: pictures are cached, state is not touched.
"""

from functools import lru_cache

import pygame

from game.camera import Camera
from game.draw import CANVAS_SIZE, Canvas, whole
from game.sprites import load_atlas, load_backdrop
from game.tile_picture import TilePicture
from game.turned import TurnedPicture
from scenes.platformer import board
from scenes.platformer.hero import APEX_SPEED, HEIGHT
from scenes.platformer.things import WALKER_BOX

# Backdrop, back to front: picture, share of the camera's way along x and along y, own drift [px/s].
LAYERS = (("clouds", 0.05, 0.02, 3.0), ("mountains_far", 0.10, 0.05, 0.0), ("mountains_mid", 0.20, 0.10, 0.0),
          ("mountains_near", 0.42, 0.18, 0.0))
CLOUDS_TOP = 14              # [canvas px]
HORIZON = 62                 # [canvas px] the mountains stand above the picture's lower edge: the ground hides the rest
FOOT = (26, 24, 48)          # colour of the near mountains' feet, below them in pits
STRIDE = 13.0                # [px] of way per frame of the run: feet do not slide
NEAR = 40                    # [px] around the picture in which things are still drawn
COIN_WAVE = 0.9              # [px] coins bob by this much, in a wave along the level
LIGHTS = {"torch": (0.10, 11.0), "lantern": (0.05, 5.0)}     # how much, and how quickly, a flame flickers


class View:
    """Draws one level; made when the first picture is wanted."""

    def __init__(self, level):
        self.level = level
        self.sky = load_backdrop("sky_dusk")
        self.layers = [(load_backdrop(name), *rest) for name, *rest in LAYERS]
        self.decor, self.ground = TilePicture(level.map, "decor"), TilePicture(level.map, "solid")
        self.things, self.hero = load_atlas("things"), load_atlas("hero")
        self.crates = [TurnedPicture(self.things[name]) for name in ("crate", "crate_large")]
        self.shaped = lru_cache(maxsize=512)(self._shaped)
        self.lowest = level.size[1] - CANVAS_SIZE[1]
        self._paint_ahead()

    def _paint_ahead(self):
        """Paint every chunk of tiles now: 0.1 s once, instead of a hitch of 10 ms at each border while playing."""
        canvas, camera = Canvas(), Camera()
        for left in range(0, self.level.size[0], CANVAS_SIZE[0]):
            for top in (0, self.lowest):
                camera.place(left, top)
                self.decor.draw(canvas, camera)
                self.ground.draw(canvas, camera)

    def draw(self, scene, canvas, alpha):
        """The whole picture."""
        left, top = scene.camera.view(alpha)
        self.left, self.top = left, top
        self._draw_dusk(canvas, scene.look.time, left, top)
        self.decor.draw(canvas, scene.camera, alpha)
        self._draw_still_things(canvas, scene)
        self.ground.draw(canvas, scene.camera, alpha)
        self._draw_moving_things(canvas, scene, alpha)
        scene.particles.draw(canvas, scene.camera, alpha)
        self._draw_puffs(canvas, scene.look)
        self._draw_hero(canvas, scene, alpha)
        self._draw_lights(canvas, scene)
        board.draw_board(canvas, scene, (left, top))

    def _draw_dusk(self, canvas, time, left, top):
        surface = canvas.surface
        surface.blit(self.sky, (0, 0))
        for picture, along, down, drift in self.layers:
            width, height = picture.get_size()
            y = CLOUDS_TOP if drift else CANVAS_SIZE[1] - HORIZON - height
            y += whole(max(0, self.lowest - top) * down)
            x = -whole(left * along + time * drift) % width - width
            while x < CANVAS_SIZE[0]:
                surface.blit(picture, (x, y))
                x += width
        surface.fill(FOOT, (0, y + height, CANVAS_SIZE[0], CANVAS_SIZE[1]))

    def _sees(self, x):
        return self.left - NEAR < x < self.left + CANVAS_SIZE[0] + NEAR

    def _stand(self, canvas, image, x, bottom):
        """Draw an image with the middle of its lower edge at a world point."""
        width, height = image.get_size()
        canvas.surface.blit(image, (whole(x) - width // 2 - self.left, whole(bottom) - height - self.top))

    def _draw_still_things(self, canvas, scene):
        things, time = self.things, scene.look.time
        for sign in self.level.map.things_of("sign"):
            if self._sees(sign.x):
                self._stand(canvas, things["sign"], sign.x + sign.width / 2, sign.y + sign.height)
        for trigger in scene.things.triggers.values():
            if not self._sees(trigger.x):
                continue
            x, bottom = trigger.foot
            if trigger.kind == "checkpoint":
                image = things.animation("checkpoint").at(time + x) if trigger.lit else things["checkpoint_off"]
                self._stand(canvas, image, x, bottom)
            elif trigger.kind == "goal":
                self._stand(canvas, things.animation("goal").at(time), x, bottom)
            elif trigger.kind == "spring":
                self._stand(canvas, self._spring(scene, trigger), x, bottom)

    def _spring(self, scene, trigger):
        animation = self.things.animation("spring")
        if trigger.touched is None:
            return self.things["spring_0"]
        return animation.at((scene.frame - trigger.touched) / 60, loop=False)

    def _draw_moving_things(self, canvas, scene, alpha):
        things, look = self.things, scene.look
        for trigger in scene.things.triggers.values():
            if trigger.kind == "coin" and self._sees(trigger.x):
                image = things.animation("coin").at(look.time + trigger.x * 0.004)
                bob = COIN_WAVE * wave(look.time * 0.55 + trigger.x * 0.011)
                canvas.sprite(image, trigger.x - self.left, trigger.y + bob - self.top)
        for platform in scene.things.platforms:
            x, y = between(look.before(platform.body), platform.body.position, alpha)
            canvas.surface.blit(things["platform"], (whole(x - platform.size[0] / 2) - self.left,
                                                     whole(y - platform.size[1] / 2) - self.top))
        for crate in scene.things.crates:
            x, y = between(look.before(crate.body), crate.body.position, alpha)
            if self._sees(x):
                angle = look.angles.get(crate.body.id, crate.body.angle)
                angle += (crate.body.angle - angle) * alpha
                self.crates[crate.size[0] > 16].draw(canvas.surface, x - self.left, y - self.top, angle)
        for walker in scene.things.walkers.values():
            x, y = between(look.before(walker.character.body), walker.character.position, alpha)
            if self._sees(x):
                image = things.animation("walker").at(look.time + walker.home[0])
                self._stand(canvas, image if walker.way < 0 else flipped(image), x, y + WALKER_BOX[1] / 2)
        for x, bottom, way, _ in look.flat:
            image = things["walker_squashed"]
            self._stand(canvas, image if way < 0 else flipped(image), x, bottom)

    def _draw_puffs(self, canvas, look):
        for name, x, y, age in look.puffs:
            image = self.things.animation(name).at(age, loop=False)
            if name == "dust":
                self._stand(canvas, image, x, y)
            else:
                canvas.sprite(image, x - self.left, y - self.top)

    # --- the hero ------------------------------------------------------------------------------------------------------

    def _draw_hero(self, canvas, scene, alpha):
        hero, look = scene.hero, scene.look
        if scene.mercy and scene.phase == "playing" and scene.mercy % 8 < 4:
            return
        x, y = between(hero.before, hero.character.position, alpha)
        bottom = y + HEIGHT / 2
        name, way = self._hero_frame(scene)
        if scene.phase == "hurt":
            bottom += look.fall
        elif hero.grounded:
            bottom += lowered(self.level, hero)
        image = self.shaped(name, way, whole(24 * look.width), whole(24 * look.height))
        self._stand(canvas, image, x, bottom)

    def _hero_frame(self, scene):
        """(frame name, way he faces)."""
        hero, look, frames = scene.hero, scene.look, self.hero
        if scene.phase == "hurt":
            return "hurt_0", hero.facing
        if hero.sliding:
            return cycle(frames.animation("slide"), look.time), hero.sliding
        if not hero.grounded:
            if hero.vy < APEX_SPEED:
                return ("jump_0" if hero.vy < -APEX_SPEED else "jump_1"), hero.facing
            return cycle(frames.animation("fall"), look.time), hero.facing
        if scene.phase == "won":
            return cycle(frames.animation("win"), look.time), hero.facing
        if abs(hero.vx) > 12.0:
            run = frames.animation("run")
            return run.names[int(look.run / STRIDE) % len(run.names)], hero.facing
        return cycle(frames.animation("idle"), look.time), hero.facing

    def _shaped(self, name, way, width, height):
        image = self.hero[name]
        if (width, height) != image.get_size():
            image = pygame.transform.scale(image, (width, height))
        return image if way > 0 else pygame.transform.flip(image, True, False)

    def _draw_lights(self, canvas, scene):
        time, light = scene.look.time, self.things["lantern_light"]
        lights = [(x, y - 3, "torch") for x, y in self.level.torches if self._sees(x)]
        lights += [(c.foot[0], c.foot[1] - 23, "lantern") for c in scene.checkpoints if c.lit and self._sees(c.x)]
        for x, y, kind in lights:
            much, quick = LIGHTS[kind]
            size = whole(light.get_width() * (1.0 - much + much * wave(time * quick / 6.28 + x * 0.13)))
            image = scaled(light, size)
            canvas.surface.blit(image, (whole(x) - size // 2 - self.left, whole(y) - size // 2 - self.top),
                                special_flags=pygame.BLEND_RGB_ADD)


@lru_cache(maxsize=2)
def level_view(level):
    """The View of a level: its pictures outlive a restart."""
    return View(level)


@lru_cache(maxsize=64)
def flipped(image):
    """An image the other way round."""
    return pygame.transform.flip(image, True, False)


@lru_cache(maxsize=64)
def scaled(image, size):
    """A square image at another size."""
    return pygame.transform.scale(image, (size, size))


def between(before, now, alpha):
    """A place between two steps."""
    return before[0] + (now[0] - before[0]) * alpha, before[1] + (now[1] - before[1]) * alpha


def wave(turns):
    """A soft wave -1..1 per turn, of two parabolas: no table and no sine per coin."""
    part = turns % 1.0
    return 16.0 * part * (0.5 - part) if part < 0.5 else -16.0 * (part - 0.5) * (1.0 - part)


def cycle(animation, seconds):
    """The name of the frame shown after so many seconds."""
    return animation.names[animation.index_at(seconds)]


def lowered(level, hero):
    """How far below his box the hero is drawn [px]: on a slope the box stands on its corner, his feet at their middle."""
    if hero.slope == 0.0:
        return 0.0
    left, _, right, bottom = hero.box
    return level.drop_to_ground((left + right) / 2, bottom, 0.5 * (right - left))
