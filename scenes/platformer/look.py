"""Visual effects and sounds of the platformer: squash and stretch, dust, afterimages, light, camera.

They never influence the game rules.
"""

from math import cos, exp, sin

from game.scene import STEP_SECONDS
from scenes.platformer import bursts
from scenes.platformer.blasting import THROWN
from scenes.platformer.feel import FALL_SPEED, HEIGHT, RUN_SPEED
from scenes.platformer.gaze import Gaze

# Squash and stretch of the hero's picture by event: factors on width and height, which fade at STRETCH_RATE.
STRETCHES = {
    "jump": (0.60, 1.40),
    "wall_jump": (0.60, 1.40),
    "land": (1.22, 0.80),
    "thud": (1.40, 0.60),
    "launch": (0.60, 1.42),
    "stomp": (0.72, 1.28),
    "bump": (1.15, 0.85),
    "drop": (0.85, 1.12),
    "thrown": (1.25, 0.80),
}
STRETCH_RATE = 11.0  # [1/s]
SOUNDS = {
    "jump": ("jump", 0.7),
    "wall_jump": ("jump", 0.8),
    "land": ("land", 0.4),
    "thud": ("land", 0.8),
    "launch": ("spring", 0.9),
    "stomp": ("stomp", 0.9),
    "bump": ("hit", 0.25),
    "drop": ("blip", 0.4),
    "thrown": ("hit", 0.7),
}
FALLEN = 260.0  # [px/s] speed up of a hurt hero, before he falls out of the picture
FALLEN_GRAVITY = 1100.0  # [px/s2]
RUN_DUST = 11  # steps between puffs of a run
MOTE_EVERY = 9  # steps between motes of light in the air
EMBER_EVERY = 5  # steps between sparks of a flame
RUNG = 14.0  # [px] of climbing between two sounds
LOUDEST = 400000.0  # [density px3/s] impulse of the loudest impact: the large crate after a fall of 10 tiles
FAINTEST, SHAKING = 0.02, 0.25  # shares of LOUDEST: a weaker impact is silent; a stronger one shakes the picture
SQUASHED = 0.5  # [s] that a flattened walker is visible
TUMBLED = 1.2  # [s] that a flattened bat or hedgehog is seen falling
QUICK, AFTERIMAGES = 250.0, 7  # [px/s] speed above which the hero leaves afterimages; steps for which each is shown
DARKEN = 2.2  # [1/s] rate at which the light changes to another act
COVER_RATE = 7.0  # [1/s] rate at which a covered room opens and closes
PULSE_FADE, GEM_FADE = 4.0, 1.5  # [1/s] rate at which the counters' pulses end
BLAST_LIFE = 0.54  # [s] all frames of a burst
FUSE_SOUND = 12  # steps between two sounds of a fuse that burns
FUSE = (4.0, -7.5)  # [px] from the middle of a bomb to the end of its fuse
PUFF_LIFE = 0.3  # [s] all frames of dust or a sparkle
HELD_STEP = STEP_SECONDS / 4  # [s] per step for lights and coins while the picture is frozen
SPLIT_TIME = 2.6  # [s] for which the difference in time from the best run is shown at a checkpoint
WINDOW = 20.0, 72.0  # [px] distance (x, y) from a checkpoint within which the ghost of the best run passes it


class Look:
    """Visible and audible effects of the platformer.

    Each method from hear() on shows one kind of event by pictures and sound.
    """

    def __init__(self, scene):
        self.scene = scene
        self.time = 0.0
        self.width = self.height = 1.0  # stretch of the hero's picture
        self.run = self.climb = 0.0  # [px] path run and climbed so far, which selects the animation frames
        self.blasts = []  # [x, y, age s]
        self.puffs = []  # [animation, x, y, age s]
        self.flat = []  # flattened enemies: [kind, x, bottom, way, age s]
        self.afterimages = []  # [x, bottom, frame, way, age steps]
        self.pulse = 0.0  # the coin counter's jump, 1..0
        self.gem_pulse = 0.0
        self.fall = self.fall_speed = 0.0  # a hurt hero's fall
        self.bodies, self.angles = {}, {}  # body id -> place, and angle of a crate, before this step
        self.act = "meadow"  # outside all zones
        self.act = self.last_act = self._act()
        self.act_age = 0.0  # [s] in this act
        self.dark = 1.0 if self.act == "cave" else 0.0
        self.open = [0.0] * len(scene.level.covers)  # opening of each covered room, 0..1
        self.split = None  # (seconds behind the ghost of the best run, seconds since it is shown), or None
        self.gaze = Gaze(scene)
        self.arrive()

    @property
    def foot(self):
        """Drawn y of the hero's feet [px], also while he falls out of the picture after a hit."""
        return self.scene.hero.box[3] + (self.fall if self.scene.phase == "hurt" else 0.0)

    def _act(self):
        """Return the act of the zone in which the hero is. Between zones, return the previous act."""
        zones = self.scene.level.zones_at(*self.scene.hero.character.position)
        return zones[0].properties["act"] if zones else self.act

    def begin_step(self):
        """Record positions and angles of all bodies before the step, for the interpolation."""
        rows = self.scene.world.bodies
        self.bodies = self.scene.things.places()
        self.angles = dict(zip(rows["id"].tolist(), rows["angle"].tolist(), strict=True))

    def hold(self):
        """Make one step of the effects while the game is frozen. Lights and coins continue at a quarter of their
        speed.
        """
        self.time += HELD_STEP

    def before(self, body):
        """Return the position (x, y) [px] of a body before the last step."""
        return self.bodies.get(body.id, body.position)

    def step(self, dt):
        """Make one step of `dt` [s] of all effects. Call it after the world's step."""
        scene, hero = self.scene, self.scene.hero
        self.time += dt
        back = 1.0 - exp(-STRETCH_RATE * dt)
        self.width += (1.0 - self.width) * back
        self.height += (1.0 - self.height) * back
        self.pulse = max(0.0, self.pulse - PULSE_FADE * dt)
        self.gem_pulse = max(0.0, self.gem_pulse - GEM_FADE * dt)
        self._age(dt)
        self._follow_act(dt)
        if scene.phase != "hurt":
            self.gaze.step(dt)
        self._air(scene)
        self._leave_images(hero)
        if scene.phase == "hurt":
            self.fall += self.fall_speed * dt
            self.fall_speed += FALLEN_GRAVITY * dt
        else:
            self._move(scene, hero, dt)

    def _move(self, scene, hero, dt):
        if hero.grounded:
            self.run += abs(hero.vx) * dt
        if hero.ladder is not None:
            rung = self.climb // RUNG
            self.climb += abs(hero.vy) * dt
            if self.climb // RUNG != rung:
                self._sound("ladder", 0.35)
        if hero.grounded and abs(hero.vx) > 0.9 * RUN_SPEED and scene.frame % RUN_DUST == 0:
            self._dust(3, -hero.facing * 4, speed=(8, 30))
        elif hero.pushing and abs(hero.vx) > 20.0 and scene.frame % 7 == 0:
            self._dust(2, hero.facing * 10, speed=(8, 26))
        elif hero.sliding and scene.frame % 4 == 0:
            x, y = hero.character.position
            bursts.slide(scene.particles, x, y, hero.sliding)
        for crumble in scene.things.crumbles:
            if crumble.shaking and scene.frame % 3 == 0:
                bursts.trickle(scene.particles, crumble.box)

    def _age(self, dt):
        self._burn_fuses()
        for aging in (self.puffs, self.flat, self.blasts):
            for one in aging:
                one[-1] += dt
        self.blasts = [blast for blast in self.blasts if blast[2] < BLAST_LIFE]
        self.puffs = [puff for puff in self.puffs if puff[3] < PUFF_LIFE]
        for one in self.flat:
            if one[0] == "walker" and one[4] >= SQUASHED:
                self._puff("dust", one[1], one[2])
        self.flat = [one for one in self.flat if one[4] < (SQUASHED if one[0] == "walker" else TUMBLED)]
        for one in self.afterimages:
            one[4] += 1
        self.afterimages = [one for one in self.afterimages if one[4] <= AFTERIMAGES]
        if self.split is not None:
            self.split = (self.split[0], self.split[1] + dt) if self.split[1] < SPLIT_TIME else None

    def _burn_fuses(self):
        """Emit the sparks of all burning fuses, and play their sound."""
        for bomb in self.scene.things.bombs:
            if bomb.phase == THROWN:
                bursts.fuse(self.scene.particles, *fuse_end(bomb))
                if bomb.count % FUSE_SOUND == 0:
                    self._sound_at("fuse", bomb.place[0], 0.5)

    def _follow_act(self, dt):
        act = self._act()
        if act != self.act:
            self.last_act, self.act, self.act_age = self.act, act, 0.0
        self.act_age += dt
        self.dark += ((1.0 if self.act == "cave" else 0.0) - self.dark) * (1.0 - exp(-DARKEN * dt))
        x, y = self.scene.hero.character.position
        for number, cover in enumerate(self.scene.level.covers):
            inside = cover.x - 4 < x < cover.x + cover.width + 4 and cover.y - 4 < y < cover.y + cover.height + 4
            self.open[number] += (float(inside) - self.open[number]) * (1.0 - exp(-COVER_RATE * dt))

    def hidden(self, x, y):
        """Return whether the point (x, y) [px] is in a hidden room whose cover is still mostly opaque.

        A light at this point must not be visible then.
        """
        return any(
            seen < 0.5 and cover.x <= x <= cover.x + cover.width and cover.y <= y <= cover.y + cover.height
            for cover, seen in zip(self.scene.level.covers, self.open, strict=True)
        )

    def _leave_images(self, hero):
        """Add an afterimage in every second step while the hero is faster than he can run or fall."""
        quick = hero.vy < -QUICK or hero.vy > FALL_SPEED + 20.0 or (abs(hero.vx) > QUICK - 20.0 and not hero.grounded)
        if quick and self.scene.frame % 2 == 0 and self.scene.phase == "playing" and self.scene.trail:
            x, bottom, name, way = self.scene.trail[-1]
            self.afterimages.append([x, bottom, name, way, 0])

    def _air(self, scene):
        """Emit floating specks in the air, and sparks from torches."""
        left, top = scene.camera.view()
        width, height = scene.camera.size
        if scene.frame % MOTE_EVERY == 0:
            bursts.mote(scene.particles, (left, top, width, height), self.act)
        if scene.frame % EMBER_EVERY == 0:
            for x, y, name in scene.level.lights:
                seen = left - 16 < x < left + width + 16 and top - 16 < y < top + height + 16
                if name == "torch" and seen and not self.hidden(x, y):
                    bursts.ember(scene.particles, x, y)

    # --- events of the scene -----------------------------------------------------------------------------------------

    def hear(self, news):
        """Show the hero's events of this step by sound, stretch, dust and shaking. news: names of events, such as
        "jump".
        """
        for word in news:
            if word in STRETCHES:
                self.width, self.height = STRETCHES[word]
            if word in SOUNDS:
                self._sound(*SOUNDS[word])
            if word in ("jump", "land"):
                self._puff("dust", *self._feet())
                self._dust(5, 0, speed=(12, 46))
            elif word == "thud":
                self._dust(14, 0, speed=(20, 90))
                self.scene.camera.shake(0.22)
            elif word == "wall_jump":
                x, y = self.scene.hero.character.position
                bursts.wall_jump(self.scene.particles, x, y, self.scene.hero.facing)
            elif word == "launch":
                bursts.launch(self.scene.particles, *self._feet())

    def show(self, word, thing):
        """Show an event of a crumbling stone ("shake", "break", "back"), of a bat ("wake"), or of a bomb.

        word: name of the event; thing: the stone, bat or bomb.
        """
        scene = self.scene
        if word == "wake":
            self._sound_at("blip", thing.character.position[0], 0.35)
            return
        if thing.kind == "bomb":
            self._show_bomb(word, *thing.place)
            return
        x, y = thing.center
        if word == "shake":
            self._sound_at("crumble", x, 0.4)
        elif word == "break":
            scene.feats.broke()
            self._sound_at("crumble", x, 0.9)
            bursts.rubble(scene.particles, x, y)
            scene.camera.shake(0.15)
        elif self._in_picture(x, y):
            self._puff("sparkle", x, y)

    def _show_bomb(self, word, x, y):
        """Show that a bomb at (x, y) [px] is taken, thrown, or back on its stand. word: name of the event."""
        if word == "taken":
            self._sound_at("hook", x, 0.5)
            self._puff("sparkle", x, y)
        elif word == "thrown":
            self._sound_at("throw", x, 0.8)
            self._sound_at("fuse", x, 0.6)
        elif self._in_picture(x, y):
            self._puff("sparkle", x, y)
            self._sound_at("blip", x, 0.4)

    def burst(self, x, y, loose, hit):
        """Show the explosion of a bomb at (x, y) [px].

        loose: list of the Rubble that has come loose; hit: whether a wall was hit.
        """
        scene = self.scene
        self.blasts.append([x, y, 0.0])
        bursts.blast(scene.particles, x, y)
        for piece in loose:
            bursts.rubble(scene.particles, *piece.body.center)
        if not self._in_picture(x, y):
            return
        scene.camera.shake(0.7 if hit else 0.4)
        scene.flash.start(0.4, (255, 220, 160))
        self._sound_at("blast", x, 1.0)
        if loose:
            self._sound_at("crumble", x, 1.0)

    def took(self, trigger):
        """Show that the hero takes a coin or a gem. trigger: Trigger of the coin or gem."""
        if trigger.kind == "secret":
            bursts.gem(self.scene.particles, trigger.x, trigger.y)
            self.gem_pulse = 1.0
            self.scene.flash.start(0.5, (150, 255, 240))
            self._sound("secret", 0.9)
            return
        self._puff("sparkle", trigger.x, trigger.y)
        bursts.coin(self.scene.particles, trigger.x, trigger.y)
        self.pulse = 1.0
        self._sound("coin", 0.6)

    def threw(self, trigger):
        """Show that a spring has thrown a crate. trigger: Trigger of the spring."""
        self._sound_at("spring", trigger.x, 0.7)
        bursts.launch(self.scene.particles, trigger.x, trigger.foot[1] - 8)

    def lit(self, trigger):
        """Show that the hero has reached a checkpoint: its lantern is lit.

        The time of the run is compared with the best run's time at this checkpoint. trigger: Trigger of the
        checkpoint.
        """
        x, bottom = trigger.foot
        bursts.kindle(self.scene.particles, x, bottom - 24)
        self._sound("checkpoint", 0.8)
        for number, row in enumerate(self.scene.ghost or ()):
            if abs(row[0] - x) < WINDOW[0] and abs(row[1] - bottom) < WINDOW[1]:
                self.split = ((self.scene.clock - number - 1) / 60.0, 0.0)
                break

    def squashed(self, enemy):
        """Show that an enemy is flattened."""
        x, _ = enemy.character.position
        self.flat.append([enemy.kind, x, enemy.bottom, enemy.way, 0.0])
        bursts.squash(self.scene.particles, x, enemy.bottom - 6)
        if self._in_picture(x, enemy.bottom):
            self.scene.camera.shake(0.2)
            self._sound_at("stomp", x, 0.6)

    def struck(self, x, y, impulse):
        """Show an impact of a crate at (x, y) [px], with dust and sound in proportion to its impulse."""
        force = min(impulse / LOUDEST, 1.0)
        if force < FAINTEST or not self._in_picture(x, y):
            return
        bursts.knock(self.scene.particles, x, y, force)
        self._sound_at("crate", x, 0.15 + 0.75 * force)
        if force > SHAKING:
            self.scene.camera.shake(0.35 * force)

    def hurt(self):
        """Start the effect for a hurt hero: he is thrown up and falls out of the picture."""
        x, y = self.scene.hero.character.position
        self.fall, self.fall_speed = 0.0, -FALLEN
        bursts.hurt(self.scene.particles, x, y)
        self.scene.camera.shake(0.6)
        self.scene.flash.start(0.35, (255, 190, 190))
        self._sound("hurt", 0.9)

    def vanished(self):
        """Show a puff at the hero's position. Call this method before he is moved back to safe ground."""
        bursts.vanish(self.scene.particles, *self.scene.hero.character.position)
        self.scene.camera.shake(0.25)

    def won(self, trigger):
        """Show confetti at the goal. trigger: Trigger of the goal."""
        bursts.confetti(self.scene.particles, trigger.x, trigger.y - 10)
        self._sound("goal", 1.0)

    def arrive(self):
        """Move the camera at once to the position where a life starts, and remove all afterimages."""
        self.gaze.arrive(*self.scene.spawn)
        self.afterimages.clear()
        self.width, self.height = 0.5, 1.4

    def _in_picture(self, x, y):
        left, top = self.scene.camera.view()
        width, height = self.scene.camera.size
        return left - 32 < x < left + width + 32 and top - 32 < y < top + height + 32

    def _sound(self, name, volume):
        self._sound_at(name, self.scene.hero.character.position[0], volume)

    def _sound_at(self, name, x, volume):
        self.scene.play(name, self.scene.camera.to_canvas(x, 0.0)[0], volume)

    def _feet(self):
        x, y = self.scene.hero.character.position
        return x, y + HEIGHT / 2

    def _puff(self, name, x, y):
        self.puffs.append([name, x, y, 0.0])

    def _dust(self, count, dx, speed):
        x, bottom = self._feet()
        bursts.dust(self.scene.particles, x + dx, bottom - 1, count, speed)


def fuse_end(bomb):
    """Return the position (x, y) [px] of the burning end of a bomb's fuse."""
    x, y = bomb.place
    angle = 0.0 if bomb.body is None else bomb.body.angle
    return x + cos(angle) * FUSE[0] - sin(angle) * FUSE[1], y + sin(angle) * FUSE[0] + cos(angle) * FUSE[1]
