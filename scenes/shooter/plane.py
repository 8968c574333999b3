"""The player's plane: it moves at once, banks, fires, is lost and comes back."""

from math import pi

from game.sprites import load_atlas
from scenes.shooter.bullets import UP
from scenes.shooter.cast import FLYING, GHOST, HEIGHT, WIDTH, steps
from scenes.shooter.enemies import dress

SPEED, FOCUS = 168.0, 0.5            # [px/s]; factor while focusing
DIAGONAL = 0.7071067811865476        # both keys of a diagonal together are no faster than one alone
LEFT, RIGHT, TOP, BOTTOM = 18.0, WIDTH - 18.0, 34.0, HEIGHT - 20.0    # [px] where its centre stays
START_X, START_Y, ENTRY_Y = WIDTH / 2, 222.0, HEIGHT + 30.0
FLY_IN = steps(0.6)                  # steps of the flight into the picture
SAFE = steps(2.4)                    # steps as a ghost after that
AWAY = steps(1.0)                    # steps between two lives
BANK_RATE = 0.34                     # frames of bank per step
BANKS = ("player_left2", "player_left1", "player", "player_right1", "player_right2")
LIVES, MOST_LIVES, TOP_POWER = 3, 6, 5
COOLDOWN = 8                         # steps between two volleys
SHOT_SPEED, SIDE_SPEED = 540.0, 460.0
# What a volley is, by power: shots by their x [px] off the nose, side bullets by their lean [rad] from straight up.
VOLLEYS = (
    ((-5, 5), ()),
    ((-5, 5), (-0.16, 0.16)),
    ((-8, 0, 8), (-0.16, 0.16)),
    ((-8, 0, 8), (-0.32, -0.16, 0.16, 0.32)),
    ((-10, -4, 4, 10), (-0.48, -0.32, -0.16, 0.16, 0.32, 0.48)),
)


class Plane:
    """`body` is None between two lives; `power` 1.. chooses the volley; `safe` counts the steps as a ghost down."""

    def __init__(self, world, tier):
        self.world = world
        self.lives, self.power = LIVES, 1
        self.tier = tier
        self.bank = 0.0
        self.safe = self.away = self.cooldown = self.entering = 0
        self.body = None
        self.x, self.y = START_X, ENTRY_Y
        self.focusing = self.fired = False
        self.arrive()

    @property
    def frame(self):
        """The picture shown, which is the mask that collides."""
        return BANKS[round(self.bank) + 2]

    def arrive(self):
        """A life starts below the picture."""
        self.bank = 0.0
        self.x, self.y = START_X, ENTRY_Y
        self.body = self.world.add_body(load_atlas("planes").mask(self.frame), position=(self.x, self.y),
                                        kind="kinematic", filter=GHOST, tier=self.tier)
        self.entering, self.safe, self.cooldown = FLY_IN, FLY_IN + SAFE, 0

    def step(self, inputs, shots):
        """Move, bank, fire. Returns True when a life starts in this step."""
        self.fired = False
        if self.body is None:
            self.away = max(self.away - 1, 0)
            if self.away == 0 and self.lives > 0:
                self.arrive()
                return True
            return False
        self.x, self.y = self.body.position
        self.safe = max(self.safe - 1, 0)
        if self.safe == 0 and self.body.filter == GHOST:
            self.body.filter = FLYING
        self._move(inputs)
        self.cooldown = max(self.cooldown - 1, 0)
        if inputs.held("fire") and not self.cooldown and not self.entering:
            self._fire(shots)
        return False

    def _move(self, inputs):
        side = inputs.held("right") - inputs.held("left")
        rise = inputs.held("down") - inputs.held("up")
        self.focusing = inputs.held("focus")
        if self.entering:
            self.entering -= 1
            side, vx, vy = 0, 0.0, (START_Y - ENTRY_Y) * 60 / FLY_IN
        else:
            speed = SPEED * (FOCUS if self.focusing else 1.0) * (DIAGONAL if side and rise else 1.0)
            vx = min(max(side * speed, (LEFT - self.x) * 60), (RIGHT - self.x) * 60)
            vy = min(max(rise * speed, (TOP - self.y) * 60), (BOTTOM - self.y) * 60)
        self.body.velocity = (vx, vy)
        before, wanted = self.frame, 2.0 * side * (0.5 if self.focusing else 1.0)
        self.bank += min(max(wanted - self.bank, -BANK_RATE), BANK_RATE)
        if self.frame != before:
            dress(self.world, self.body.id, self.frame, self.tier)

    def _fire(self, shots):
        straight, leaning = VOLLEYS[self.power - 1]
        for x in straight:
            shots.fire("shot", self.x + x, self.y - 14 + abs(x) * 0.6, (UP,), SHOT_SPEED)
        for lean in leaning:
            shots.fire("side", self.x + 40 * lean / pi, self.y - 6, (UP + lean * self._spread,), SIDE_SPEED)
        self.cooldown, self.fired = COOLDOWN, True

    @property
    def _spread(self):
        """Focus draws the side bullets together."""
        return 0.45 if self.focusing else 1.0

    def lose_life(self):
        """It is hit. Returns the id of its body, which is to be removed."""
        wreck, self.body = self.body.id, None
        self.lives -= 1
        self.power = max(self.power - 1, 1)
        self.away = AWAY
        return wreck

    def strengthen(self):
        """A power-up. Returns False when there is nothing left to gain."""
        gained = self.power < TOP_POWER
        self.power = min(self.power + 1, TOP_POWER)
        return gained

    def state(self):
        """For the digest."""
        return (self.lives, self.power, self.bank, self.safe, self.away, self.cooldown, self.entering, self.x, self.y,
                self.focusing, -1 if self.body is None else self.body.id)
