"""Parameters of the lander's flight, damage and tools, and the collision filters of its bodies."""

from game.scene import STEP_SECONDS
from physics import Filter

# Flying
GRAVITY = 42.0  # [px/s2] a long fall is 3 s: time to react
THRUST = 112.0  # [px/s2] of the ship alone: hovering takes three eighths of it
TURN_RATE = 3.0  # [rad/s] half a turn takes a second
TURN_GAIN, TURN_LOSS = 16.0, 12.0  # [rad/s2] start of a turn, and its stop without a key
DRAG = 0.10  # [1/s] rate at which velocities approach that of the air: the air is thin
CEILING, CEILING_PUSH = -60.0, 3.0  # [px] y of the altitude limit; [1/s2] acceleration down per px above it
SHIP_MASS, CARGO_MASS, DENSITY = 400.0, 120.0, 0.6  # [mass], [mass], [mass/px2] of rock
# Fuel, hull, shells
FUEL, FUEL_RATE, CAN = 100.0, 4.6, 40.0  # full tank; fuel burnt per second; fuel in a can
LOW_FUEL = 25.0
HULL = 100.0
HARMLESS = 34.0  # [px/s] a smaller change of the ship's velocity does no damage
DAMAGE = 0.95  # loss of hull per px/s above HARMLESS: 140 px/s destroys the ship
SHELLS, FEWEST_SHELLS = 12, 6  # most shells; number up to which the gun recharges, so that the ship is never walled in
LIVES = 3
# Landing
SOFT = 30.0  # [px/s] touchdown speed up to which the whole bonus is given
HARD = 72.0  # [px/s] touchdown speed from which there is no bonus
UPRIGHT = 0.30  # [rad] greatest lean of a landed ship
STILL = 7.0  # [px/s] greatest speed of a landed ship
WARN_SPEED, WARN_HEIGHT = 85.0, 110.0  # [px/s], [px]: the alarm sounds at this sinking speed below this height
# Gun and blasts
SHELL_SPEED, SHELL_MASS, SHELL_RADIUS = 340.0, 5.0, 2.5  # [px/s] relative to the ship, [mass], [px]
MUZZLE = 20.0  # [px] from the ship's middle
BLAST, CRASH_BLAST = 20.0, 28.0  # [px] radius of a crater
PUSH_REACH, PUSH = 64.0, 105.0  # [px] range of a blast; [px/s] change of velocity next to it
CRUMB = 14  # area in pixels: smaller pieces are removed
# The line
REACH, LINE, LINKS = 62.0, 48.0, 8  # [px] range of the claw; length of the line, and its links: an even number
LINE_MASS, LINE_STRENGTH = 4.0, 2.5e6  # [mass] of the line; [mass px/s2] force at which it tears
# Cargo
CARGO_HARMLESS, CARGO_DAMAGE = 55.0, 0.7  # [px/s] harmless change of velocity; damage (of 100) per px/s above it


def steps(seconds):
    """Return the time `seconds` as a number of steps of 1/60 s, rounded."""
    return round(seconds / STEP_SECONDS)


COOLDOWN = steps(0.22)  # steps between two shells
CHARGE = steps(2.5)  # steps in which the gun recharges a shell
SHELL_LIFE = steps(2.5)
AWAY = steps(1.8)  # steps between the loss of a ship and the next ship
SETTLED = steps(0.6)  # steps at rest before a landing counts
STRANDED = steps(3.0)  # steps on the ground without fuel and off a pad, before the ship is given up
DELIVERED = steps(0.6)  # steps for which cargo must rest on a pad before it counts
REFUEL, REPAIR, REARM = 30.0 / 60, 16.0 / 60, steps(0.45)  # fuel per step, hull per step, steps per shell


GROUND_BIT, SHIP_BIT, SHELL_BIT, LOOSE_BIT, ZONE_BIT, CAN_BIT, LINE_BIT = (1 << bit for bit in range(7))
FILTER_NAMES = {
    GROUND_BIT: "ground and pads",
    SHIP_BIT: "ship",
    SHELL_BIT: "shell",
    LOOSE_BIT: "cargo and rocks",
    ZONE_BIT: "over a pad",
    CAN_BIT: "fuel",
    LINE_BIT: "line",
}
GROUND = Filter(GROUND_BIT, SHIP_BIT | SHELL_BIT | LOOSE_BIT | LINE_BIT)
SHIP = Filter(SHIP_BIT, GROUND_BIT | LOOSE_BIT | CAN_BIT)
SHELL = Filter(SHELL_BIT, GROUND_BIT | LOOSE_BIT)
LOOSE = Filter(LOOSE_BIT, GROUND_BIT | SHIP_BIT | SHELL_BIT | LOOSE_BIT | ZONE_BIT)
ZONE = Filter(ZONE_BIT, LOOSE_BIT)
FUEL_CAN = Filter(CAN_BIT, SHIP_BIT)
LINE_FILTER = Filter(LINE_BIT, GROUND_BIT)


def approach(value, target, change):
    """Return `value` moved towards `target`, by at most `change`."""
    return min(value + change, target) if value < target else max(value - change, target)
