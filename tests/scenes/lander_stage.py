"""A lander that is played by hand, step by step."""

from game.input.inputs import InputFrame, InputState
from scenes.lander.scene import Lander


class Flight:
    """`scene` and the keys of its steps."""

    def __init__(self, seed=1):
        self.scene = Lander(seed=seed)
        self.inputs = InputState()

    @property
    def ship(self):
        """Its ship."""
        return self.scene.ship

    def step(self, count=1, keys=(), changes=()):
        """Step with the same keys held."""
        for _ in range(count):
            self.inputs.set(InputFrame(frozenset(keys), changes=tuple(changes)))
            self.scene.step(self.inputs)

    def until(self, done, most, keys=()):
        """Step until done() is true. Fail if it is not after `most` steps."""
        for _ in range(most):
            if done():
                return
            self.step(1, keys)
        raise AssertionError(f"not after {most} steps")

    def put(self, x, y, velocity=(0.0, 0.0), angle=0.0):
        """Move the ship to (x, y) [px]."""
        body = self.ship.body
        body.move_to((x, y), angle)
        body.velocity, body.angular_velocity = velocity, 0.0
        self.ship.touching.clear()
        self.ship.read()

    def put_over(self, pad, high=60.0, velocity=(0.0, 0.0)):
        """Move the ship over a pad, with its feet `high` px above the pad."""
        self.put(pad.x, pad.y - 16.0 - high, velocity)

    def piece(self, number=0):
        """Return (id, Cargo) of a piece of cargo."""
        return list(self.scene.yard.cargo.items())[number]
