"""Wreckage: a heavy plane that is shot down breaks along cracks, and its pieces fall.

Each piece is a body with its own pixels: it is drawn with these pixels, and collides by them at any angle. It starts
with a part of the plane's velocity and a random rotation. The air, which moves with the ground, slows it down. The
game is seen from above, so a falling piece shrinks instead of moving down. A piece damages small planes until it is
well below them; it never hurts the player.
"""

from dataclasses import dataclass
from math import hypot, pi

import numpy as np

from game.drawing.crack import draw_crack
from game.drawing.sprites import load_atlas
from physics import PixelMask, fit
from scenes.shooter.blows import Blow
from scenes.shooter.cast import FALLING, WRECKED, steps

STRIKE = 4.0  # factor on the damage by a piece on a small plane, which would be too small without it
DRAG = 0.9  # [1/s] drag of the air on pieces; planes have engines
CRUMB = 14  # area in pixels: smaller pieces are removed at once
CROSSING = (0.9, 1.9)  # [rad] between the two cracks that cross at the last hit
INWARD = 0.6  # the cracks cross at this share of the way from a plane's middle to the last hit
APART = 24.0  # [px] between further cracks of something large
TORN = (26.0, 62.0)  # [px/s] speed of the pieces away from the point where the cracks cross
KEPT, KICKED = 0.6, 0.25  # shares of the plane's velocity, and of the last blow's kick
SPIN = (0.8, 3.4)  # [rad/s]
LIFE = (1.5, 2.3)  # [s] until a piece is down
HARMLESS = 0.55  # share of the planes' height below which pieces strike nothing


@dataclass
class Due:
    """A plane that will break when the next step begins, so that its last hit can be inspected before.

    identity: its body id; x, y: contact point of the last hit [px]; blow: Blow of this hit.
    """

    identity: int
    x: float  # [px] place of the last blow
    y: float
    blow: Blow


@dataclass
class Piece:
    """A piece of a broken plane.

    mask: its pixels; frame: name of the picture from which it was cut; left, top: position of `mask` in that picture
    [px]; life: number of steps from the break until the piece reaches the ground; age: steps since the break; strikes:
    whether it can still hit small planes.
    """

    mask: PixelMask
    frame: str
    left: int
    top: int
    life: int
    age: int = 0
    strikes: bool = True

    @property
    def high(self):
        """Height above the ground: 1 at the planes' height, 0 on the ground. It decreases slowly at first, then
        faster.
        """
        return 1.0 - (self.age / self.life) ** 2


class Wreckage:
    """All wreckage in the game. pieces: {body id: Piece}; due: planes that break when the next step begins."""

    def __init__(self, world):
        self.world = world
        self.pieces, self.due = {}, []

    def __len__(self):
        return len(self.pieces)

    def mark(self, plane, x, y, blow):
        """Mark a plane to break when the next step begins. x, y: contact point of its last hit [px]; blow: Blow of
        this hit.
        """
        self.due.append(Due(plane.id, x, y, blow))

    def is_marked(self, identity):
        """Return whether the body `identity` is a plane that is marked to break."""
        return any(due.identity == identity for due in self.due)

    def break_due(self, fleet):
        """Break the marked planes into pieces, and remove the planes from the fleet.

        Return a list of (plane, x, y), where (x, y) [px] is the point at which the plane's cracks cross.
        """
        broken = []
        for due in self.due:
            plane = fleet.planes.pop(due.identity)
            broken.append((plane, *self._break(plane, due)))
        self.due.clear()
        return broken

    def _break(self, plane, due):
        body, mask = self.world.body(plane.id), load_atlas("planes").mask(plane.frame)
        x, y = body.position
        hub = (x + INWARD * (due.x - x), y + INWARD * (due.y - y))
        body.set_shapes(*fit(mask, "mask"))
        body.set_kind("dynamic")
        body.filter = WRECKED
        body.velocity = (KEPT * plane.vx + KICKED * due.blow.kick[0], KEPT * plane.vy + KICKED * due.blow.kick[1])
        crossing = body.to_local(hub)
        crack = cracks(mask, crossing.x, crossing.y, self.world.random)
        parts = body.carve(crack, (x, y, body.angle), CRUMB).fragments
        for part in (body, *parts):
            self._tear_off(part, (x, y), mask, plane.frame, hub)
        return hub

    def _tear_off(self, part, place, mask, frame, hub):
        random, (own,) = self.world.random, part.shapes
        left = round(part.position.x - place[0] + mask.origin[0] - own.origin[0])
        top = round(part.position.y - place[1] + mask.origin[1] - own.origin[1])
        dx, dy = part.center.x - hub[0], part.center.y - hub[1]
        far, torn = max(hypot(dx, dy), 1.0), random.uniform(*TORN)
        part.velocity += (torn * dx / far, torn * dy / far)
        part.angular_velocity = random.uniform(*SPIN) * (1.0 if random.random() < 0.5 else -1.0)
        self.pieces[part.id] = Piece(own, frame, left, top, steps(random.uniform(*LIFE)))

    def step(self):
        """Let all pieces fall for one step. Return a list of (body id, Piece) of those that have reached the ground."""
        for identity, piece in self.pieces.items():
            piece.age += 1
            if piece.strikes and piece.high < HARMLESS:
                piece.strikes = False
                self.world.body(identity).filter = FALLING
        return [(identity, piece) for identity, piece in self.pieces.items() if piece.age >= piece.life]

    def strikes(self, begun, fleet):
        """Yield (id of the piece, plane, contact point (x, y) [px]) for each hit of a piece on a small plane.

        begun: the step's begin events, which contain the hits; fleet: the Fleet of enemy planes.
        """
        columns = (begun[name].tolist() for name in ("body_a", "body_b", "point_x", "point_y"))
        for a, b, x, y in zip(*columns, strict=True):
            piece, struck = (a, b) if a in self.pieces else (b, a)
            enemy = fleet.planes.get(struck)
            if piece in self.pieces and enemy is not None and not enemy.heavy:
                yield piece, enemy, (x, y)

    def forget(self, ids):
        """Remove the pieces with the given body ids (an array) from the table."""
        for identity in ids.tolist():
            self.pieces.pop(identity, None)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple. Positions are part of the world's state."""
        out: list = []
        for due in self.due:
            out += (due.identity, due.x, due.y, due.blow.x, due.blow.y, due.blow.mass)
        for identity, each in self.pieces.items():
            out += (identity, each.frame, each.left, each.top, each.age, each.life, each.strikes)
        return tuple(out)


def cracks(mask, x, y, random):
    """Return a PixelMask of jagged cracks, along which a plane with the given mask breaks.

    Two cracks cross at (x, y) [px], relative to the mask's origin. A wide mask gets additional cracks. The result has
    the size and origin of `mask`, so that it covers the same pixels at the same pose.
    """
    height, width = mask.solid.shape
    solid = np.zeros((height, width), bool)
    at, heading = (x + mask.origin[0], y + mask.origin[1]), random.uniform(0.0, pi)
    draw_crack(solid, at, heading, random)
    draw_crack(solid, at, heading + random.uniform(*CROSSING), random)
    for number in range(round(width / (2 * APART))):
        for side in (-1, 1):
            place = (at[0] + side * APART * (number + random.uniform(0.7, 1.1)), height * random.uniform(0.3, 0.7))
            draw_crack(solid, place, pi / 2 + random.uniform(-0.5, 0.5), random)
    return PixelMask(solid, mask.origin)
