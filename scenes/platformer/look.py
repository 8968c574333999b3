"""What is only seen and heard: squash and stretch, dust, sparkles, the camera's thinking. No rule reads any of it."""

from math import exp, pi

from scenes.platformer.hero import HEIGHT, RUN_SPEED

# The camera
AHEAD = 64.0                 # [px] it looks this far in the way of a run
AHEAD_RATE = 1.8             # [1/s] slowly, so that a step back does not swing the picture
FOLLOW_RATE = 6.5            # [1/s]
DEAD_ZONE = (6.0, 10.0)      # [px] small moves leave the picture still
RAISED = 38.0                # [px] the hero stands below the middle: there is more to see above
JUMP_ROOM = 58.0             # [px] a jump of that height does not lift the camera; its landing does
# Squash and stretch: (width, height) at the moment, and how fast it fades
STRETCHES = {"jump": (0.72, 1.28), "wall_jump": (0.72, 1.28), "land": (1.22, 0.80), "thud": (1.40, 0.64),
             "launch": (0.60, 1.42), "stomp": (0.72, 1.28), "bump": (1.15, 0.85), "drop": (0.85, 1.12)}
STRETCH_RATE = 11.0          # [1/s]
SOUNDS = {"jump": ("jump", 0.7), "wall_jump": ("jump", 0.8), "land": ("land", 0.4), "thud": ("land", 0.8),
          "launch": ("spring", 0.9), "stomp": ("stomp", 0.9), "bump": ("hit", 0.25), "drop": ("blip", 0.4)}
DUST = ((214, 200, 190), (160, 142, 140), (104, 90, 100))
GOLDEN = ((255, 255, 235), (255, 226, 120), (240, 164, 50), (150, 84, 40))
EMBER = ((255, 244, 190), (255, 178, 70), (214, 84, 40), (90, 40, 52))
MOTE = ((255, 226, 150), (226, 150, 110), (130, 84, 120))
CONFETTI = (((255, 92, 92), (180, 50, 80)), ((120, 220, 232), (60, 130, 190)), ((255, 222, 110), (214, 140, 60)),
            ((190, 236, 120), (90, 160, 80)))
FALLEN = 260.0               # [px/s] how fast a hurt hero is thrown up before he falls out of the picture
FALLEN_GRAVITY = 1100.0      # [px/s2]
RUN_DUST = 11                # steps between puffs of a run
MOTE_EVERY = 9               # steps between motes of light in the air
EMBER_EVERY = 5              # steps between sparks of a flame
LOUDEST = 400000.0           # [density px3/s] impulse of a hit beyond which nothing gets louder: the large crate from 10 tiles
FAINTEST, SHAKING = 0.02, 0.25   # of that: quieter is not heard, harder shakes the picture
SQUASHED = 0.5               # [s] a squashed walker is seen


class Look:
    """Owned by the scene, which tells it what happened."""

    def __init__(self, scene):
        self.scene = scene
        self.time = 0.0
        self.width = self.height = 1.0       # the hero's stretch
        self.run = 0.0                       # [px] way on the ground, which drives the run's frames
        self.puffs = []                      # [animation, x, y, age s]
        self.flat = []                       # squashed walkers: [x, bottom, way, age s]
        self.pulse = 0.0                     # the coin counter's jump, 1..0
        self.fall = self.fall_speed = 0.0    # a hurt hero's way down
        self.ahead = 0.0
        self.level_y = scene.hero.character.position[1]
        self.bodies, self.angles = {}, {}    # body id -> place, and angle of a crate, before this step
        camera = scene.camera
        camera.keep_within(0, 0, *scene.level.size)
        self.arrive()

    def begin_step(self):
        """Before anything moves."""
        things = self.scene.things
        self.bodies = {one.body.id: one.body.position for one in (*things.platforms, *things.crates)}
        self.angles = {crate.body.id: crate.body.angle for crate in things.crates}
        for walker in things.walkers.values():
            self.bodies[walker.character.body.id] = walker.character.position

    def before(self, body):
        """Where a body was before the last step [px]."""
        return self.bodies.get(body.id, body.position)

    def step(self, dt):
        """After everything has moved."""
        scene, hero = self.scene, self.scene.hero
        self.time += dt
        back = 1.0 - exp(-STRETCH_RATE * dt)
        self.width += (1.0 - self.width) * back
        self.height += (1.0 - self.height) * back
        self.pulse = max(0.0, self.pulse - 4.0 * dt)
        if hero.grounded:
            self.run += abs(hero.vx) * dt
        for aging in (self.puffs, self.flat):
            for one in aging:
                one[3] += dt
        self.puffs = [puff for puff in self.puffs if puff[3] < 0.3]
        for one in self.flat:
            if one[3] >= SQUASHED:
                self._puff("dust", one[0], one[1])
        self.flat = [one for one in self.flat if one[3] < SQUASHED]
        self._follow(dt)
        self._air(scene)
        if scene.phase == "hurt":
            self.fall += self.fall_speed * dt
            self.fall_speed += FALLEN_GRAVITY * dt
        elif hero.grounded and abs(hero.vx) > 0.9 * RUN_SPEED and scene.frame % RUN_DUST == 0:
            self._dust(3, -hero.facing * 4, speed=(8, 30))
        elif hero.sliding and scene.frame % 4 == 0:
            x, y = hero.character.position
            scene.particles.burst(x + 5 * hero.sliding, y + 4, 2, DUST, speed=(5, 26), life=(0.2, 0.4),
                                  angle=pi / 2 * (1 + hero.sliding), spread=1.6, gravity=60.0)

    def _follow(self, dt):
        scene, hero = self.scene, self.scene.hero
        x, y = hero.character.position
        wanted = AHEAD * hero.vx / RUN_SPEED if abs(hero.vx) > 60.0 else AHEAD * 0.35 * hero.facing
        self.ahead += (max(-AHEAD, min(AHEAD, wanted)) - self.ahead) * (1.0 - exp(-AHEAD_RATE * dt))
        if hero.grounded or hero.sliding:
            self.level_y = y
        self.level_y = max(min(self.level_y, y + JUMP_ROOM), y)     # below it he is always followed
        if scene.phase != "hurt":
            scene.camera.follow(x + self.ahead, self.level_y - RAISED, dt, FOLLOW_RATE, DEAD_ZONE)

    def _air(self, scene):
        """Motes drift through the dusk, sparks rise from flames."""
        particles, random = scene.particles, scene.particles.random
        left, top = scene.camera.view()
        width, height = scene.camera.size
        if scene.frame % MOTE_EVERY == 0:
            particles.burst(left + width * random.uniform(0, 1), top + height * random.uniform(0.2, 1), 1, MOTE,
                            speed=(4, 14), life=(1.5, 3.2), size=(1, 1), drag=0.2, gravity=-3.0)
        if scene.frame % EMBER_EVERY == 0:
            for x, y in scene.level.torches:
                if left - 16 < x < left + width + 16:
                    particles.burst(x, y - 4, 1, EMBER, speed=(6, 20), life=(0.3, 0.8), angle=-pi / 2, spread=1.2,
                                    size=(1, 1), gravity=-30.0)

    # --- what the scene reports --------------------------------------------------------------------------------------

    def hear(self, news):
        """Words of the hero's step, as sound, stretch and dust."""
        for word in news:
            if word in STRETCHES:
                self.width, self.height = STRETCHES[word]
            if word in SOUNDS:
                self._sound(*SOUNDS[word])
            if word in ("jump", "land"):
                self._puff("dust", self._feet()[0], self._feet()[1])
                self._dust(5, 0, speed=(12, 46))
            elif word == "thud":
                self._dust(14, 0, speed=(20, 90))
                self.scene.camera.shake(0.22)
            elif word == "wall_jump":
                x, y = self.scene.hero.character.position
                away = self.scene.hero.facing
                self.scene.particles.burst(x - 6 * away, y + 4, 10, DUST, speed=(20, 90), life=(0.2, 0.45),
                                           angle=0.0 if away > 0 else pi, spread=1.8, gravity=120.0)
            elif word == "launch":
                x, y = self._feet()
                self.scene.particles.burst(x, y, 10, GOLDEN, speed=(40, 150), life=(0.2, 0.5), angle=-pi / 2, spread=1.4)

    def took_coin(self, trigger):
        """Sparkle and count."""
        self._puff("sparkle", trigger.x, trigger.y)
        self.scene.particles.burst(trigger.x, trigger.y, 9, GOLDEN, speed=(20, 90), life=(0.25, 0.6), size=(1, 1),
                                   gravity=120.0)
        self.pulse = 1.0
        self._sound("coin", 0.6)

    def lit(self, trigger):
        """A lantern is lit."""
        x, bottom = trigger.foot
        self.scene.particles.burst(x, bottom - 24, 26, EMBER, speed=(20, 110), life=(0.3, 0.9), drag=3.0, gravity=-20.0)
        self._sound("powerup", 0.7)

    def squashed(self, walker):
        """A walker is flat."""
        x, _ = walker.character.position
        bottom = walker.bottom
        self.flat.append([x, bottom, walker.way, 0.0])
        self.scene.particles.burst(x, bottom - 6, 14, DUST, speed=(30, 110), life=(0.2, 0.5), angle=-pi / 2, spread=2.6,
                                   gravity=200.0)
        self.scene.camera.shake(0.2)

    def struck(self, x, y, impulse):
        """A crate hit something at a point: everything about it grows with the impulse."""
        force = min(impulse / LOUDEST, 1.0)
        if force < FAINTEST:
            return
        self.scene.particles.burst(x, y, 2 + round(16 * force), DUST, speed=(10, 30 + 80 * force), life=(0.2, 0.3 + 0.4 * force),
                                   angle=-pi / 2, spread=2.6, gravity=60.0)
        left, top = self.scene.camera.view()
        width, height = self.scene.camera.size
        if left - 32 < x < left + width + 32 and top - 32 < y < top + height + 32:
            self.scene.play("land", self.scene.camera.to_canvas(x, 0.0)[0], 0.15 + 0.75 * force)
            if force > SHAKING:
                self.scene.camera.shake(0.35 * force)

    def hurt(self):
        """The hero is thrown out of the picture."""
        x, y = self.scene.hero.character.position
        self.fall, self.fall_speed = 0.0, -FALLEN
        self.scene.particles.burst(x, y, 24, ((255, 255, 255), (255, 150, 150), (190, 50, 80), (80, 30, 60)),
                                   speed=(30, 170), life=(0.25, 0.7))
        self.scene.camera.shake(0.6)
        self._sound("hurt", 0.9)

    def won(self, trigger):
        """Confetti."""
        for ramp in CONFETTI:
            self.scene.particles.burst(trigger.x, trigger.y - 10, 34, ramp, speed=(60, 240), life=(0.8, 2.0),
                                       angle=-pi / 2, spread=2.2, drag=1.6, gravity=150.0)
        self._sound("goal", 1.0)

    def arrive(self):
        """A life starts: the picture is there at once."""
        scene = self.scene
        x, y = scene.spawn
        self.level_y, self.ahead = y, AHEAD * 0.35
        scene.camera.center_on(x + self.ahead, y - RAISED)
        self.width, self.height = 0.5, 1.4

    def _sound(self, name, volume):
        x, _ = self.scene.camera.to_canvas(self.scene.hero.character.position[0], 0.0)
        self.scene.play(name, x, volume)

    def _feet(self):
        x, y = self.scene.hero.character.position
        return x, y + HEIGHT / 2

    def _puff(self, name, x, y):
        self.puffs.append([name, x, y, 0.0])

    def _dust(self, count, dx, speed):
        x, bottom = self._feet()
        self.scene.particles.burst(x + dx, bottom - 1, count, DUST, speed=speed, life=(0.15, 0.4), angle=-pi / 2,
                                   spread=2.8, drag=3.0, gravity=40.0)
