"""A lander scene that a test plays step by step."""

from game.input.inputs import InputFrame, InputState
from scenes.lander.scene import Lander


class Flight:
    """A lander game: `scene`, and the input of its steps."""

    def __init__(self, seed=1):
        self.scene = Lander(seed=seed)
        self.inputs = InputState()

    @property
    def ship(self):
        """Return the ship of the scene."""
        return self.scene.ship

    def step(self, count=1, keys=(), changes=()):
        """Make `count` steps while the same keys are held. changes: (name, value) pairs of settings to change."""
        for _ in range(count):
            self.inputs.set(InputFrame(frozenset(keys), changes=tuple(changes)))
            self.scene.step(self.inputs)

    def until(self, done, most, keys=()):
        """Step until done() is true. Fails if it is not true within `most` steps."""
        for _ in range(most):
            if done():
                return
            self.step(1, keys)
        raise AssertionError(f"not after {most} steps")

    def put(self, x, y, velocity=(0.0, 0.0), angle=0.0):
        """Move the ship to (x, y) [px], with this velocity and angle and no rotation."""
        body = self.ship.body
        body.move_to((x, y), angle)
        body.velocity, body.angular_velocity = velocity, 0.0
        self.ship.touching.clear()
        self.ship.read()

    def put_over(self, pad, high=60.0, velocity=(0.0, 0.0)):
        """Move the ship over a pad, with its feet `high` px above the pad."""
        self.put(pad.x, pad.y - 16.0 - high, velocity)

    def piece(self, number=0):
        """Return (id, Cargo) of the piece of cargo with this number."""
        return list(self.scene.yard.cargo.items())[number]
