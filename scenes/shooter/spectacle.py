"""What is only seen and heard: explosions, sparks, debris, flashes, sounds, shake. No rule reads any of it."""

from math import pi

from game.sprites import load_atlas
from scenes.shooter.cast import WIDTH

FIRE = ((255, 255, 240), (255, 226, 130), (255, 160, 50), (216, 78, 40), (120, 40, 52), (60, 34, 50))
SPARK = ((255, 255, 255), (255, 240, 170), (255, 180, 70), (170, 80, 50))
BLUE = ((255, 255, 255), (170, 236, 255), (70, 160, 240), (40, 70, 160))
GOLD = ((255, 255, 235), (255, 226, 120), (240, 164, 50), (150, 84, 40))
ROSE = ((255, 255, 255), (255, 170, 190), (220, 80, 130), (110, 40, 90))
SMOKE_EVERY = 5              # steps between puffs of a damaged gunship
FLASH = 3                    # steps that a plane stays white when it is hit
CALM = 0.965                 # of the shock of an explosion that is left a step later
LEAN_RATE = 0.06             # share of the way to the plane that the parallax goes in a step
# kind -> explosion, sound, volume, shake, sparks, pieces of debris
DEATHS = {"dart": ("explosion_small", "explosion", 0.55, 0.06, 16, 4),
          "saucer": ("explosion_small", "explosion", 0.7, 0.10, 24, 5),
          "gunship": ("explosion_large", "big_explosion", 0.9, 0.38, 60, 12)}
PAINT = {"dart": (1, 0), "saucer": (3, 4), "gunship": (2, 0), "player": (5, 0)}     # frames of the debris


class Spectacle:
    """Lists of what flies about: each entry ages, and is gone when its time is over."""

    def __init__(self, scene):
        self.scene = scene
        self.random = scene.particles.random
        self.atlas = load_atlas("effects")
        self.time = 0.0
        self.bursts = []             # [animation, x, y, vx, vy, age s]; before age 0 it waits
        self.debris = []             # [frame, x, y, vx, vy, age s, life s]
        self.words = []              # [text, x, y, age s, color]
        self.flashes = {}            # body id -> steps it stays white
        self.muzzle = 9              # steps since the last volley
        self.shock = 0.0             # light of explosions on the picture, 1..0
        self.news = 0                # steps that the name of the wave is still shown
        self.pulse = 0.0             # the score jumps when it grows, 1..0
        self.lean = self.lean_before = 0.0     # [px] off the middle, as the parallax sees it: slower than the plane

    def step(self, dt):
        """Everything ages."""
        self.time += dt
        self.muzzle += 1
        self.lean_before = self.lean
        self.lean += (self.scene.plane.x - WIDTH / 2 - self.lean) * LEAN_RATE
        self.shock *= CALM
        self.pulse = max(0.0, self.pulse - 5.0 * dt)
        self.news = max(0, self.news - 1)
        self.flashes = {identity: left - 1 for identity, left in self.flashes.items() if left > 1}
        for enemy in self.scene.fleet.planes.values():
            if enemy.full > 8 and enemy.health < enemy.full / 2 and enemy.age % SMOKE_EVERY == 0:
                side = -15 if enemy.age % (2 * SMOKE_EVERY) else 15
                self._burst("smoke", enemy.x + side, enemy.y - 6, self.random.uniform(-8, 8), -26.0)
        for burst in self.bursts:
            burst[1] += burst[3] * dt
            burst[2] += burst[4] * dt
            burst[5] += dt
        self.bursts = [b for b in self.bursts if b[5] < self.atlas.animation(b[0]).seconds]
        for piece in self.debris:
            piece[1] += piece[3] * dt
            piece[2] += piece[4] * dt
            piece[3] *= 0.985
            piece[4] = piece[4] * 0.985 + 0.8
            piece[5] += dt
            if int(piece[5] * 60) % 4 == 0 and piece[5] < 0.7 * piece[6]:
                self.scene.particles.burst(piece[1], piece[2], 1, FIRE, speed=(0, 10), life=(0.2, 0.5), size=(1, 2))
        self.debris = [piece for piece in self.debris if piece[5] < piece[6]]
        for word in self.words:
            word[2] -= 18.0 * dt
            word[3] += dt
        self.words = [word for word in self.words if word[3] < 0.8]

    def lean_at(self, alpha):
        """The parallax' shift between two steps [px]."""
        return self.lean_before + (self.lean - self.lean_before) * alpha

    # --- what the scene reports --------------------------------------------------------------------------------------

    def wave(self, number):
        """A wave begins."""
        self.news = 130
        if number > 1:
            self.scene.play("blip", volume=0.4)

    def player_fires(self, plane):
        """Muzzle flash and sound."""
        self.muzzle = 0
        self.scene.play("laser", plane.x, 0.22)

    def enemy_fires(self, enemy):
        """A plane opens fire."""
        self._burst("muzzle_flash", enemy.x, enemy.y + 8, 0.0, 0.0)
        self.scene.play("enemy_shot", enemy.x, 0.4)

    def dive(self, dart):
        """A dart lights its burner."""
        self.scene.particles.burst(dart.x, dart.y - 8, 14, FIRE, speed=(30, 120), life=(0.2, 0.5), angle=-pi / 2, spread=1.4)
        self.scene.play("enemy_shot", dart.x, 0.3)

    def struck(self, enemy, x, y, blow):
        """A shot hits a plane and does not bring it down: the harder, the more sparks."""
        self.flashes[enemy.id] = FLASH
        self._burst("spark", x, y, 0.0, 20.0)
        self.scene.particles.burst(x, y, round(5 * blow.strength), SPARK, speed=(40, 160 * blow.strength), life=(0.1, 0.3),
                                   angle=pi / 2, spread=2.6, size=(1, 1))
        self.scene.play("hit", x, 0.3 * blow.strength)

    def destroyed(self, enemy, worth, blow):
        """A plane is brought down. Its pieces go on as it flew, with what the last blow gave them."""
        animation, sound, volume, shake, sparks, pieces = DEATHS[enemy.kind]
        x, y = enemy.x, enemy.y
        self._burst(animation, x, y, enemy.vx * 0.2, enemy.vy * 0.2 + 10)
        if enemy.kind == "gunship":
            for number in range(6):
                dx, dy = self.random.uniform(-22, 22), self.random.uniform(-16, 16)
                self._burst("explosion_small", x + dx, y + dy, dx, dy + 12, -0.09 * number)
            self.shock = 1.0
        self._sparks(x, y, sparks, FIRE)
        self._sparks(x, y, sparks // 3, SPARK, 260)
        self._pieces(enemy.kind, x, y, enemy.vx * 0.3, enemy.vy * 0.3, pieces, blow)
        self._puffs(x, y, 2 if enemy.kind != "gunship" else 6)
        self.word(f"{worth}", x, y - 24, (255, 236, 170))
        self.pulse = 1.0
        self.scene.camera.shake(shake * blow.strength)
        self.scene.play(sound, x, volume)

    def player_hit(self, plane, hit_by, still):
        """Pixels met: plane and bullet stand white for as many steps as all stands still."""
        for identity in (plane.body.id, *hit_by):
            self.flashes[identity] = still + 1
        self.scene.camera.shake(0.35)
        self.scene.play("hurt", plane.x, 0.8)

    def player_lost(self, plane, blow):
        """The plane bursts."""
        x, y = plane.x, plane.y
        self._burst("explosion_large", x, y, 0.0, 12.0)
        for number in range(4):
            dx, dy = self.random.uniform(-16, 16), self.random.uniform(-16, 16)
            self._burst("explosion_small", x + dx, y + dy, dx, dy, -0.12 * (number + 1))
        self._sparks(x, y, 60, FIRE, 200)
        self._sparks(x, y, 30, BLUE, 240)
        self._pieces("player", x, y, 0.0, 0.0, 10, blow)
        self._puffs(x, y, 6)
        self.shock = 1.0
        self.scene.camera.shake(0.5)
        self.scene.play("big_explosion", x, 0.8)

    def bullets_burnt(self, places):
        """Bullets that vanish with the player's plane turn into sparks."""
        for x, y in places:
            self._sparks(x, y, 4, ROSE, 50)

    def near_miss(self, x, y, toward_x, toward_y):
        """Something passed within its box."""
        mid_x, mid_y = (x + toward_x) / 2, (y + toward_y) / 2
        self._sparks(mid_x, mid_y, 6, BLUE, 90)
        self.word("CLOSE", toward_x, toward_y - 20, (150, 226, 255))
        self.scene.play("blip", x, 0.25)

    def loot_left(self, x, y):
        """A power-up appears."""
        self._sparks(x, y, 14, GOLD, 90)

    def loot_taken(self, x, y, text):
        """A power-up is taken."""
        self._sparks(x, y, 30, GOLD, 150)
        self.word(text, x, y - 18, (255, 226, 120))
        self.scene.play("powerup", x, 0.7)

    def life_won(self, plane):
        """An extra life."""
        self.word("1UP", plane.x, plane.y - 24, (170, 255, 190))
        self.scene.play("powerup", plane.x, 0.9)

    def word(self, text, x, y, color):
        """A word that rises from a place, unless one was just written there."""
        if not any(abs(w[1] - x) < 26 and abs(w[2] - y) < 8 and w[3] < 0.3 for w in self.words):
            self.words.append([text, x, y, 0.0, color])

    # --- pieces --------------------------------------------------------------------------------------------------------

    def _burst(self, name, x, y, vx, vy, age=0.0):
        self.bursts.append([name, x, y, vx, vy, age])

    def _sparks(self, x, y, count, ramp, speed=150):
        self.scene.particles.burst(x, y, count, ramp, speed=(speed * 0.2, speed), life=(0.25, 0.8), size=(1, 2), drag=2.6)

    def _puffs(self, x, y, count):
        for number in range(count):
            vx, vy = self.random.uniform(-20, 20), self.random.uniform(-14, 26)
            self._burst("smoke", x + vx * 0.6, y + vy * 0.6, vx, vy, -0.12 - 0.05 * number)

    def _pieces(self, kind, x, y, vx, vy, count, blow):
        """Debris: the harder the blow, the more pieces, and the faster, along its way."""
        frames, wild = PAINT[kind], 0.7 + 0.3 * blow.strength
        vx, vy = vx + blow.kick[0], vy + blow.kick[1]
        for number in range(max(2, round(count * blow.strength))):
            self.debris.append([f"debris_{frames[number % 2]}", x, y, vx + wild * self.random.uniform(-90, 90),
                                vy + wild * self.random.uniform(-100, 50), 0.0, self.random.uniform(0.5, 1.2)])
