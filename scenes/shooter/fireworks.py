"""Moving decoration of the shooter: explosions, sparks, debris, smoke, rings, texts. No game rule depends on it."""

import numpy as np

from game.drawing.sprites import load_atlas
from scenes.shooter.cast import GROUND_SPEED, HEIGHT

FIRE = ((255, 255, 240), (255, 226, 130), (255, 160, 50), (216, 78, 40), (120, 40, 52), (60, 34, 50))
SPARK = ((255, 255, 255), (255, 240, 170), (255, 180, 70), (170, 80, 50))
BLUE = ((255, 255, 255), (170, 236, 255), (70, 160, 240), (40, 70, 160))
GOLD = ((255, 255, 235), (255, 226, 120), (240, 164, 50), (150, 84, 40))
ROSE = ((255, 255, 255), (255, 170, 190), (220, 80, 130), (110, 40, 90))
DUST = ((226, 210, 180), (170, 150, 124), (110, 96, 90), (66, 60, 66))
VAPOUR = ((214, 232, 255), (150, 178, 214), (92, 116, 156))
FOAM = ((255, 255, 255), (206, 232, 255), (120, 170, 214), (62, 96, 150))
WORD_LIFE = 0.8  # [s]
RING_LIFE = 0.45  # [s] of a shock wave
MOST_SCARS = 24  # scorched places that are kept
WORD_RISE = 18.0  # [px/s]
DEBRIS_DRAG, DEBRIS_FALL = 0.985, 0.8  # factor on the velocity per step; [px/s] added to the downward speed per step
BURNING = 0.7  # share of its life in which debris burns and trails sparks


class Fireworks:
    """Decoration without physics, stored as lists of rows. Each row ages, and is removed at the end of its lifetime."""

    def __init__(self, particles):
        self.particles, self.random = particles, particles.random
        self.bursts = []  # [animation, x, y, vx, vy, age s]; not shown while its age is negative
        self.debris = []  # [frame, x, y, vx, vy, age s, life s]
        self.words = []  # [text, x, y, age s, color]
        self.rings = []  # [x, y, radius px, age s]: shock waves
        self.scars = []  # [x, y, size px] of fires on the ground

    def step(self, dt, still=False):
        """Make one step of `dt` [s]. still: True if the ground does not scroll; otherwise scorch marks move with it."""
        effects = load_atlas("effects")
        for burst in self.bursts:
            burst[1] += burst[3] * dt
            burst[2] += burst[4] * dt
            burst[5] += dt
        self.bursts = [b for b in self.bursts if b[5] < effects.animation(b[0]).seconds]
        for piece in self.debris:
            piece[1] += piece[3] * dt
            piece[2] += piece[4] * dt
            piece[3] *= DEBRIS_DRAG
            piece[4] = piece[4] * DEBRIS_DRAG + DEBRIS_FALL
            piece[5] += dt
            if int(piece[5] * 60) % 4 == 0 and piece[5] < BURNING * piece[6]:
                self.particles.burst(piece[1], piece[2], 1, FIRE, speed=(0, 10), life=(0.2, 0.5), size=(1, 2))
        self.debris = [piece for piece in self.debris if piece[5] < piece[6]]
        for word in self.words:
            word[2] -= WORD_RISE * dt
            word[3] += dt
        self.words = [word for word in self.words if word[3] < WORD_LIFE]
        for ring in self.rings:
            ring[3] += dt
        self.rings = [ring for ring in self.rings if ring[3] < RING_LIFE]
        if not still:
            for scar in self.scars:
                scar[1] += GROUND_SPEED * dt
            self.scars = [scar for scar in self.scars if scar[1] < HEIGHT + 40]

    def burst(self, name, x, y, vx=0.0, vy=0.0, age=0.0):
        """Add an animation that plays once at (x, y) [px] and moves by (vx, vy) [px/s].

        A negative `age` [s] delays it.
        """
        self.bursts.append([name, x, y, vx, vy, age])

    def chain(self, x, y, wide, high, count, apart):
        """Add `count` small explosions at random points around (x, y) [px], one every `apart` seconds.

        wide, high: greatest distance of a point along x and along y [px].
        """
        for number in range(count):
            dx, dy = self.random.uniform(-wide, wide), self.random.uniform(-high, high)
            self.burst("explosion_small", x + dx, y + dy, dx * 0.6, dy * 0.6 + 12, -apart * number)

    def sparks(self, x, y, count, ramp, speed=150):
        """Add `count` sparks at (x, y) [px] that fly in all directions, with speeds up to `speed` [px/s].

        ramp: colours of a spark over its life.
        """
        self.particles.burst(x, y, count, ramp, speed=(speed * 0.2, speed), life=(0.25, 0.8), size=(1, 2), drag=2.6)

    def embers(self, xs, ys):
        """Add three sparks at each of the points (xs, ys), two arrays [px]."""
        self.particles.burst(
            np.repeat(xs, 3),
            np.repeat(ys, 3),
            3 * len(xs),
            ROSE,
            speed=(10, 50),
            life=(0.25, 0.8),
            size=(1, 2),
            drag=2.6,
        )

    def puffs(self, x, y, count):
        """Add `count` puffs of smoke near (x, y) [px] that drift apart."""
        for number in range(count):
            vx, vy = self.random.uniform(-20, 20), self.random.uniform(-14, 26)
            self.burst("smoke", x + vx * 0.6, y + vy * 0.6, vx, vy, -0.12 - 0.05 * number)

    def pieces(self, frames, x, y, vx, vy, count, blow):
        """Add debris of a destroyed plane at (x, y) [px], which flies in the direction of the Blow `blow`.

        A harder blow gives more and faster pieces. frames: numbers of the debris's two pictures; vx, vy: velocity of
        the destroyed plane [px/s]; count: number of pieces for a plain shot.
        """
        wild = 0.7 + 0.3 * blow.strength
        vx, vy = vx + blow.kick[0], vy + blow.kick[1]
        for number in range(max(2, round(count * blow.strength))):
            self.piece(
                frames[number % 2],
                x,
                y,
                vx + wild * self.random.uniform(-90, 90),
                vy + wild * self.random.uniform(-100, 50),
                self.random.uniform(0.5, 1.2),
            )

    def piece(self, kind, x, y, vx, vy, life):
        """Add one piece of debris at (x, y) [px] with velocity (vx, vy) [px/s] for `life` [s].

        kind: number of the piece's picture.
        """
        self.debris.append([f"debris_{kind}", x, y, vx, vy, 0.0, life])

    def ring(self, x, y, radius):
        """Add a shock wave at (x, y) [px] that grows to `radius` [px]."""
        self.rings.append([x, y, radius, 0.0])

    def scar(self, x, y, size):
        """Add a scorch mark of `size` [px] at (x, y) [px], which moves with the ground."""
        self.scars = [*self.scars[1 - MOST_SCARS :], [x, y, size]]

    def word(self, text, x, y, color):
        """Add a text that rises from (x, y) [px], unless another text has appeared near this point within 0.3 s."""
        if not any(abs(w[1] - x) < 26 and abs(w[2] - y) < 8 and w[3] < 0.3 for w in self.words):
            self.words.append([text, x, y, 0.0, color])
