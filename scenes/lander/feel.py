"""Every number that makes the lander fly as it does, and the collision filters."""

from game.scene import STEP_SECONDS
from physics import Filter

# Flying
GRAVITY = 42.0  # [px/s2] a long fall is 3 s: time to react
THRUST = 112.0  # [px/s2] of the ship alone: hovering takes three eighths of it
TURN_RATE = 3.0  # [rad/s] half a turn takes a second
TURN_GAIN, TURN_LOSS = 16.0, 12.0  # [rad/s2] start of a turn, and its stop without a key
DRAG = 0.10  # [1/s] thin air; the wind acts by this share of its speed
CEILING, CEILING_PUSH = -60.0, 3.0  # [px] altitude limit of the engine; [1/s2] pull per px above it
SHIP_MASS, CARGO_MASS, DENSITY = 400.0, 120.0, 0.6  # [.], [.], [1/px2] of rock
# Fuel, hull, shells
FUEL, FUEL_RATE, CAN = 100.0, 4.6, 40.0  # full; [1/s] burnt; content of a can
LOW_FUEL = 25.0
HULL = 100.0
HARMLESS = 34.0  # [px/s] a smaller change of the ship's velocity does no damage
DAMAGE = 0.95  # hull per px/s above it: 140 px/s destroys the ship
SHELLS, FEWEST_SHELLS = 12, 6  # full; limit up to which the gun recharges itself, so that the ship is never walled in
LIVES = 3
# Landing
SOFT = 30.0  # [px/s] touchdown speed up to which the whole bonus is given
HARD = 72.0  # [px/s] from which there is no bonus
UPRIGHT = 0.30  # [rad] greatest lean of a landed ship
STILL = 7.0  # [px/s] its greatest speed
WARN_SPEED, WARN_HEIGHT = 85.0, 110.0  # [px/s], [px]: the alarm sounds at this sinking speed below this height
# Gun and blasts
SHELL_SPEED, SHELL_MASS, SHELL_RADIUS = 340.0, 5.0, 2.5  # [px/s] with the ship's own, [.], [px]
MUZZLE = 20.0  # [px] from the ship's middle
BLAST, CRASH_BLAST = 20.0, 28.0  # [px] radius of a crater
PUSH_REACH, PUSH = 64.0, 105.0  # [px] range of a blast; [px/s] change of velocity next to it
CRUMB = 14  # [px] smaller pieces are dust
# The line
REACH, LINE = 62.0, 48.0  # [px] range of the claw; length of the taut line
LINE_RATE, LINE_DAMPING, SNAP = 4.0, 0.55, 150.0  # [Hz], of critical, [px] length at which it tears
# Cargo
CARGO_HARMLESS, CARGO_DAMAGE = 55.0, 0.7  # [px/s], share of 100 per px/s above it


def steps(seconds):
    """Return a time as whole steps."""
    return round(seconds / STEP_SECONDS)


COOLDOWN = steps(0.22)  # between two shells
CHARGE = steps(2.5)  # in which the gun recharges a shell
SHELL_LIFE = steps(2.5)
AWAY = steps(1.8)  # time between two ships
SETTLED = steps(0.6)  # steps at rest before a landing counts
STRANDED = steps(3.0)  # at rest without fuel off a pad, before the ship is given up
DELIVERED = steps(0.6)  # cargo at rest on a pad before it counts
REFUEL, REPAIR, REARM = 30.0 / 60, 16.0 / 60, steps(0.45)  # per step, per step, steps per shell


GROUND_BIT, SHIP_BIT, SHELL_BIT, LOOSE_BIT, ZONE_BIT, CAN_BIT = (1 << bit for bit in range(6))
FILTER_NAMES = {
    GROUND_BIT: "ground and pads",
    SHIP_BIT: "ship",
    SHELL_BIT: "shell",
    LOOSE_BIT: "cargo and rocks",
    ZONE_BIT: "over a pad",
    CAN_BIT: "fuel",
}
GROUND = Filter(GROUND_BIT, SHIP_BIT | SHELL_BIT | LOOSE_BIT)
SHIP = Filter(SHIP_BIT, GROUND_BIT | LOOSE_BIT | CAN_BIT)
SHELL = Filter(SHELL_BIT, GROUND_BIT | LOOSE_BIT)
LOOSE = Filter(LOOSE_BIT, GROUND_BIT | SHIP_BIT | SHELL_BIT | LOOSE_BIT | ZONE_BIT)
ZONE = Filter(ZONE_BIT, LOOSE_BIT)
FUEL_CAN = Filter(CAN_BIT, SHIP_BIT)


def approach(value, target, change):
    """Return the value moved towards a target by at most `change`."""
    return min(value + change, target) if value < target else max(value - change, target)
