"""The player's plane: it moves without inertia, banks, fires, is lost and returns.

It has three bodies: a small core; the hull, with the mask of the current picture; and a larger ring, which is a
sensor. The world tests all three. The scene decides whether hits of the core or of the hull cost a life.
"""

from math import pi

from game.drawing.sprites import load_atlas
from physics import Circle
from scenes.shooter.bullets import UP
from scenes.shooter.cast import AT_RISK, GHOST, HEIGHT, WIDTH, steps
from scenes.shooter.fleet import dress

SPEED, FOCUS = 168.0, 0.5  # [px/s]; factor while focusing
DIAGONAL = 0.7071067811865476  # a diagonal with both keys is no faster than one alone
BORDER = 16.0  # [px] kept by its centre from the edges of the picture
LEFT, RIGHT, TOP, BOTTOM = BORDER, WIDTH - BORDER, BORDER, HEIGHT - BORDER
START_X, START_Y, ENTRY_Y = WIDTH / 2, 222.0, HEIGHT + 30.0
CORE_RADIUS, RING_RADIUS = 2.5, 16.0  # [px]
FLY_IN = steps(0.6)  # steps of the flight into the picture
SAFE = steps(2.5)  # steps after that in which it cannot be hit
AWAY = steps(1.0)  # steps between two lives
BANK_RATE = 0.34  # frames of bank per step
BANKS = ("player_left2", "player_left1", "player", "player_right1", "player_right2")
LIVES, MOST_LIVES, BOMBS, MOST_BOMBS, TOP_POWER = 3, 6, 3, 6, 5
POWER_LOST = 2  # levels of power lost with a life; one of them is dropped as a pick-up
COOLDOWN = 6  # steps between two volleys
SHOT_SPEED, SIDE_SPEED = 560.0, 480.0
# The volley at each level of power: x offsets from the nose [px] of the shots, the same of the heavy shots, and angles
# of the side bullets from straight up [rad].
VOLLEYS = (
    ((-5, 5), (), ()),
    ((-5, 5), (), (-0.16, 0.16)),
    ((-8, 0, 8), (), (-0.16, 0.16)),
    ((-9, 9), (0,), (-0.32, -0.16, 0.16, 0.32)),
    ((-13, 13), (-5, 5), (-0.48, -0.32, -0.16, 0.16, 0.32, 0.48)),
)


class Plane:
    """The player's plane.

    bodies: {part: Body} with the parts "core", "hull" and "ring"; empty between two lives. power: level of its volley,
    1..TOP_POWER; safe: remaining steps in which the plane cannot be hit.
    """

    def __init__(self, world, tier):
        self.world = world
        self.lives, self.power, self.bombs = LIVES, 1, BOMBS
        self.tier = tier
        self.right = RIGHT  # [px] greatest x
        self.bank = 0.0
        self.safe = self.away = self.cooldown = self.entering = 0
        self.bodies = {}
        self.x, self.y = START_X, ENTRY_Y
        self.velocity = (0.0, 0.0)
        self.focusing = self.fired = self.ghost = False
        self.arrive()

    @property
    def here(self):
        """True while the plane exists; False between two lives."""
        return bool(self.bodies)

    @property
    def body(self):
        """The hull's body, or None between two lives."""
        return self.bodies.get("hull")

    @property
    def frame(self):
        """Name of the current picture, whose mask is the hull's shape."""
        return BANKS[round(self.bank) + 2]

    def arrive(self):
        """Start a life: add the plane's bodies below the picture, from where the plane flies in."""
        self.bank = 0.0
        self.x, self.y = START_X, ENTRY_Y
        shapes = {
            "core": Circle(CORE_RADIUS),
            "hull": load_atlas("planes").mask(self.frame),
            "ring": Circle(RING_RADIUS),
        }
        for part, shape in shapes.items():
            self.bodies[part] = self.world.add_body(
                shape,
                position=(self.x, self.y),
                kind="kinematic",
                filter=GHOST[part],
                sensor=part == "ring",
                tier=self.tier if part == "hull" else None,
            )
        self.ghost = True
        self.entering, self.safe, self.cooldown = FLY_IN, FLY_IN + SAFE, 0

    def step(self, inputs, shots):
        """Move, bank and fire. Between two lives, wait, then start the next life.

        shots: the player's Bullets, to which new shots are added.
        """
        self.fired = False
        hull = self.body
        if hull is None:
            self.away = max(self.away - 1, 0)
            if self.away == 0 and self.lives > 0:
                self.arrive()
            return
        self.x, self.y = hull.position
        self.safe = max(self.safe - 1, 0)
        self._haunt(self.safe > 0)
        self._move(inputs, hull)
        self.cooldown = max(self.cooldown - 1, 0)
        if inputs.held("fire") and not self.cooldown and not self.entering:
            self._fire(shots)

    def shelter(self, count):
        """Make the plane invulnerable for at least `count` steps."""
        self.safe = max(self.safe, count)
        if self.here:
            self._haunt(self.safe > 0)

    def _haunt(self, ghost):
        if ghost != self.ghost:
            self.ghost = ghost
            for part, body in self.bodies.items():
                body.filter = (GHOST if ghost else AT_RISK)[part]

    def _move(self, inputs, hull):
        side = inputs.held("right") - inputs.held("left")
        rise = inputs.held("down") - inputs.held("up")
        self.focusing = inputs.held("focus")
        if self.entering:
            self.entering -= 1
            side, vx, vy = 0, 0.0, (START_Y - ENTRY_Y) * 60 / FLY_IN
        else:
            speed = SPEED * (FOCUS if self.focusing else 1.0) * (DIAGONAL if side and rise else 1.0)
            vx = min(max(side * speed, (LEFT - self.x) * 60), (self.right - self.x) * 60)
            vy = min(max(rise * speed, (TOP - self.y) * 60), (BOTTOM - self.y) * 60)
        self.velocity = (vx, vy)
        for body in self.bodies.values():
            body.velocity = self.velocity
        before, wanted = self.frame, 2.0 * side * (0.5 if self.focusing else 1.0)
        self.bank += min(max(wanted - self.bank, -BANK_RATE), BANK_RATE)
        if self.frame != before:
            dress(self.world, hull.id, self.frame, self.tier)

    def _fire(self, shots):
        straight, heavy, leaning = VOLLEYS[self.power - 1]
        for look, places in (("shot", straight), ("heavy", heavy)):
            for x in places:
                shots.fire(look, self.x + x, self.y - 14 + abs(x) * 0.6, (UP,), SHOT_SPEED)
        # Focusing draws the side bullets together.
        spread = 0.45 if self.focusing else 1.0
        for lean in leaning:
            shots.fire("side", self.x + 40 * lean / pi, self.y - 6, (UP + lean * spread,), SIDE_SPEED)
        self.cooldown, self.fired = COOLDOWN, True

    def lose_life(self):
        """Take a life from the player and remove the plane from the game.

        Return the ids of the plane's bodies, which the caller must remove from the world.
        """
        wreck = [body.id for body in self.bodies.values()]
        self.bodies = {}
        self.lives -= 1
        self.power = max(self.power - POWER_LOST, 1)
        self.bombs = BOMBS
        self.velocity = (0.0, 0.0)
        self.away, self.focusing = AWAY, False
        return wreck

    def go_on(self):
        """Restore lives and bombs. Called when the player continues after the last life."""
        self.lives, self.bombs, self.away = LIVES, BOMBS, 1

    def gain(self, what):
        """Take the pick-up `what` ("power", "bomb" or "life"): increase this stock by 1, up to its maximum.

        Return whether the stock was below its maximum.
        """
        held, most = {"power": ("power", TOP_POWER), "bomb": ("bombs", MOST_BOMBS), "life": ("lives", MOST_LIVES)}[what]
        before = getattr(self, held)
        setattr(self, held, min(before + 1, most))
        return before < most

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (
            self.lives,
            self.power,
            self.bombs,
            self.bank,
            self.safe,
            self.away,
            self.cooldown,
            self.entering,
            self.x,
            self.y,
            *self.velocity,
            self.focusing,
            self.ghost,
            *(body.id for body in self.bodies.values()),
        )
