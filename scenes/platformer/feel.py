"""Parameters of the hero's moves, and the functions by which timers and speeds change.

The parameters follow the game Celeste, with lengths doubled: its tiles are 8 px wide, and these are 16 px. Half of the
parameters allow for inexact play: input that is a few frames or pixels off is accepted.
"""

from game.scene import STEP_SECONDS

WIDTH, HEIGHT = 10, 20  # [px] the hero's box, narrower than the sprite: a touch of the scarf is no hit

# Running
RUN_SPEED = 180.0  # [px/s] 11 tiles a second: the screen's width takes 2.7 s
RUN_ACCELERATION = 2000.0  # [px/s2] full speed after 5 frames: immediate to the hand, visible as a start
OVERSPEED_DRAG = 800.0  # [px/s2] rate at which speed above RUN_SPEED is lost (after a wall jump or a platform)
AIR_CONTROL = 0.65  # factor on both rates in the air: a jump can be steered but not undone
PUSH_SPEED = 88.0  # [px/s] while pushing; a crate loses a fifth of this speed by friction
PUSH_REACH = 4  # [px] a crate this near is still being pushed
PUSH = 3000.0  # [px/s2] the hero's push: enough for one large crate, not for two on each other
# Falling
GRAVITY = 1800.0  # [px/s2]
APEX_SPEED = 80.0  # [px/s] slower than this with jump held, gravity is half: time to aim the landing
FALL_SPEED = 320.0  # [px/s] still readable at a fall across the screen
FAST_FALL_SPEED = 480.0  # [px/s] with down held
FAST_FALL_GAIN = 600.0  # [px/s2] rate at which the limit grows to it while down is held
# Jumping
JUMP_SPEED = 210.0  # [px/s] up; with the time below 57 px, 3.5 tiles
JUMP_BOOST = 80.0  # [px/s] along the motion: a running jump reaches 7.7 tiles
JUMP_HOLD = 0.20  # [s] for which holding jump keeps the speed: short and high jumps from one button
CEILING_GRACE = 0.05  # [s] an early hit on a ceiling only delays the jump: the hold continues
COYOTE = 0.10  # [s] after the edge in which a jump is still accepted: the last pixel is not visible
BUFFER = 0.08  # [s] before the landing from which a press counts
CORNER = 8  # [px] the hero is moved aside by up to this if his head hits a corner, or if a corner squeezes him
POP_SPEED, POP_REACH = 80.0, 12  # [px/s] extra speed up for a hero whose feet are within so many px below a plank's top
# Ladders
CLIMB_SPEED = 104.0  # [px/s] a rung in 5 frames
CLIMB_ALIGN = 2.0  # [px] a step towards the ladder's middle
# Walls
SLIDE_SPEED = 40.0  # [px/s] at first; the limit grows over SLIDE_TIME
SLIDE_TIME = 1.2  # [s]
WALL_REACH = 6  # [px] distance of a wall that can be kicked, beyond the box
WALL_JUMP_SPEED = 260.0  # [px/s] away from it
WALL_JUMP_TIME = 0.16  # [s] in which the keys cannot turn back, so that one wall alone cannot be climbed
WALL_RETENTION = 0.06  # [s] in which the speed lost at a corner is restored once the corner is passed
# Throws
SPRING_SPEED = 640.0  # [px/s] 113 px: over a ledge of 5 tiles with room to see it
STOMP_SPEED = 250.0  # [px/s] with jump held it rises like a jump
LIFT_TIME = 0.10  # [s] after leaving a platform in which its speed is added to a jump
LIFT_X, LIFT_Y = 500.0, 260.0  # [px/s] at most, so that no platform throws too far
THROWN = (190.0, 230.0)  # [px/s] away and up, if a hurt costs nothing else
THROWN_TIME = 0.25  # [s] in which the keys cannot turn back
DROP_TIME = 0.12  # [s] for which the hero falls through planks: 8 px, past one plank but not the next
DROP_SPEED = 80.0  # [px/s] speed at which he begins to fall through a plank
THUD = 90.0  # [px] a fall from this height is audible: more than his own jump


def steps(seconds):
    """Return the time `seconds` as a number of steps of 1/60 s, rounded."""
    return round(seconds / STEP_SECONDS)


def approach(value, target, change):
    """Return `value` moved towards `target`, by at most `change`."""
    return min(value + change, target) if value < target else max(value - change, target)
