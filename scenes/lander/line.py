"""The line: a rope between ship and load. It pulls, but never pushes.

If the rope is longer than LINE, it pulls as a damped spring. The force acts at the centres of mass of ship and load, so
it causes no torque.
"""

from math import hypot, pi
from typing import Any

from scenes.lander.feel import LINE, LINE_DAMPING, LINE_RATE, REACH, SNAP


class Line:
    """The rope on which the ship carries a load. load: its body, or None; torn: whether the rope tore in this step."""

    def __init__(self):
        self.load: Any = None
        self.torn = False

    def toggle(self, ship, loose):
        """Let go of the load or, without a load, catch the nearest of the bodies `loose` that is within REACH.

        Return "let go", "caught", or "missed" if no body is in reach.
        """
        if self.load is not None:
            self.load = None
            return "let go"
        near = [(hypot(body.center.x - ship.x, body.center.y - ship.y), body.id, body) for body in loose]
        near = [each for each in near if each[0] < REACH]
        if not near:
            return "missed"
        self.load = min(near)[2]
        self.load.wake()
        return "caught"

    def pull(self, ship):
        """Apply the rope's force to ship and load for the next step, or let the rope tear if it is too long."""
        self.torn = False
        load = self.load
        if load is None or not ship.here:
            self.load = None
            return
        body = ship.body
        dx, dy = load.center.x - body.center.x, load.center.y - body.center.y
        length = hypot(dx, dy)
        if length > SNAP:
            self.load, self.torn = None, True
            return
        if length <= LINE:
            return
        ux, uy = dx / length, dy / length
        mass = body.mass * load.mass / (body.mass + load.mass)
        rate = 2.0 * pi * LINE_RATE
        parting = (load.velocity.x - body.velocity.x) * ux + (load.velocity.y - body.velocity.y) * uy
        force = mass * (rate * rate * (length - LINE) + 2.0 * LINE_DAMPING * rate * parting)
        if force > 0.0:
            body.apply_force((force * ux, force * uy))
            load.apply_force((-force * ux, -force * uy))

    def drop(self, identity):
        """Let go of the load if it is the body `identity`. Call it before this body is removed."""
        if self.load is not None and self.load.id == identity:
            self.load = None

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (-1 if self.load is None else self.load.id,)
