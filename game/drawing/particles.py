"""Particles, stored as arrays and moved with NumPy.

Particles are decoration: no game rule reads them, and they have their own random numbers.
"""

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.colors import Color

CAPACITY = 2048  # new particles replace the oldest; nothing but the drawing reads them
COLUMNS = ("x", "y", "vx", "vy", "age", "life", "size", "drag", "gravity")


class Particles:
    """Decorative particles: squares of 1 to 3 canvas px.

    The particles move, slow down, and change their colour along a ramp (a sequence of colours).
    """

    def __init__(self, seed: int = 0) -> None:
        self.random = np.random.default_rng(seed)
        self.rows = np.zeros((len(COLUMNS), CAPACITY))
        self.ramps = np.zeros(CAPACITY, dtype=np.int64)
        self.colors = []  # ramps seen so far: tuples of colours
        self.clear()

    def __getstate__(self):
        alive = np.flatnonzero(self.rows[4] < self.rows[5]).astype(np.int16)  # the others are not drawn
        rows, ramps = self.rows[:, alive].astype(np.float32), self.ramps[alive].astype(np.int16)  # enough for drawing
        return self.random, self.colors, self.newest, alive, rows, ramps

    def __setstate__(self, state):
        self.__init__()
        self.random, self.colors, self.newest, alive, self.rows[:, alive], self.ramps[alive] = state

    def clear(self) -> None:
        """Remove all particles."""
        self.rows[5] = 0.0  # life 0: not alive
        self.rows[4] = 1.0
        self.newest = 0

    @property
    def count(self) -> int:
        """Number of living particles."""
        return int(np.count_nonzero(self.rows[4] < self.rows[5]))

    def burst(
        self,
        x: float,
        y: float,
        count: int,
        ramp: tuple[Color, ...],
        speed: tuple[float, float] = (20, 120),
        life: tuple[float, float] = (0.2, 0.6),
        angle: float = 0.0,
        spread: float = 2 * np.pi,
        size: tuple[int, int] = (1, 2),
        drag: float = 2.0,
        gravity: float = 0.0,
        carry: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Emit `count` particles at (x, y) [world px].

        ramp: colours over the lifetime, from the first to the last. speed [px/s], life [s] and size [px]: (low, high)
        ranges. angle, spread [rad]: direction and width of the cone in which the particles start. drag: deceleration
        [1/s]; gravity: downward acceleration [px/s2]. carry: velocity [px/s] that is added to all particles, for
        example that of a wreck.
        """
        if ramp not in self.colors:
            self.colors.append(ramp)
        rng = self.random
        rows = (self.newest + np.arange(min(count, CAPACITY))) % CAPACITY
        self.newest = (self.newest + len(rows)) % CAPACITY
        heading = angle + rng.uniform(-0.5, 0.5, len(rows)) * spread
        speeds = rng.uniform(*speed, len(rows))
        self.rows[:, rows] = (
            np.full(len(rows), x),
            np.full(len(rows), y),
            np.cos(heading) * speeds + carry[0],
            np.sin(heading) * speeds + carry[1],
            np.zeros(len(rows)),
            rng.uniform(*life, len(rows)),
            rng.integers(size[0], size[1] + 1, len(rows)),
            np.full(len(rows), drag),
            np.full(len(rows), gravity),
        )
        self.ramps[rows] = self.colors.index(ramp)

    def step(self, dt: float) -> None:
        """Advance all particles by a step of `dt` [s]."""
        x, y, vx, vy, age, _, _, drag, gravity = self.rows
        slow = 1.0 / (1.0 + drag * dt)
        vx *= slow
        vy *= slow
        vy += gravity * dt
        x += vx * dt
        y += vy * dt
        age += dt

    def draw(self, canvas: Canvas, camera: Camera, alpha: float = 1.0) -> None:
        """Draw the particles that are in view. alpha: position between the last two steps, 0..1.

        The loop is over the 3 x 3 pixels of the largest particle, not over the particles. Each pixel of all particles
        is set by one array assignment.
        """
        x, y, _, _, age, life, size, _, _ = self.rows
        alive = np.flatnonzero(age < life)
        if len(alive) == 0:
            return
        view = camera.viewport.clip(canvas.rect)
        px, py = camera.to_canvas(x[alive], y[alive], alpha)
        px, py = np.floor(px + 0.5).astype(np.int64), np.floor(py + 0.5).astype(np.int64)
        colors = self._mapped(canvas.surface, alive, age, life)
        pixels = pygame.surfarray.pixels2d(canvas.surface)
        for dx in range(3):
            for dy in range(3):
                wide = size[alive] > max(dx, dy)
                ax, ay = px + dx, py + dy
                seen = wide & (ax >= view.left) & (ax < view.right) & (ay >= view.top) & (ay < view.bottom)
                pixels[ax[seen], ay[seen]] = colors[seen]
        del pixels  # unlocks the surface

    def _mapped(self, surface, alive, age, life):
        """Return the colours of the living particles as pixel values of `surface`, (n,) uint32.

        alive: (n,) indices of the living particles; age, life: age and lifetime of all particles [s].
        """
        heat = age[alive] / life[alive]
        out = np.zeros(len(alive), dtype=np.uint32)
        for index, ramp in enumerate(self.colors):
            mine = self.ramps[alive] == index
            if mine.any():
                table = np.array([surface.map_rgb(color) & 0xFFFFFFFF for color in ramp], dtype=np.uint32)
                out[mine] = table[np.minimum((heat[mine] * len(ramp)).astype(np.int64), len(ramp) - 1)]
        return out
