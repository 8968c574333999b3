"""Every number that makes the hero's moves feel right, by move, and the two sums that all timers and speeds use.

The numbers are those of Celeste at twice its size, since its tiles are 8 px wide and ours 16. Half of the moves only
forgive: they do what the player meant, a few frames or pixels off from what was pressed.
"""

from game.scene import STEP_SECONDS

WIDTH, HEIGHT = 10, 20  # [px] slimmer than the sprite: what grazes the scarf is no hit

# Running
RUN_SPEED = 180.0  # [px/s] 11 tiles a second: the screen's width takes 2.7 s
RUN_ACCELERATION = 2000.0  # [px/s2] full speed after 5 frames: felt as at once, seen as a start
OVERSPEED_DRAG = 800.0  # [px/s2] a wall jump's or a platform's extra speed is lost slowly, it was earned
AIR_CONTROL = 0.65  # of both in the air: a jump can be steered but not undone
PUSH_SPEED = 88.0  # [px/s] a crate is heavy, and rubs off a fifth of it
PUSH_REACH = 4  # [px] a crate this near is still being pushed
PUSH = 3000.0  # [px/s2] one large crate, not two on each other
# Falling
GRAVITY = 1800.0  # [px/s2]
APEX_SPEED = 80.0  # [px/s] slower than this with jump held, gravity is half: time to aim the landing
FALL_SPEED = 320.0  # [px/s] what can still be read at a fall across the screen
FAST_FALL_SPEED = 480.0  # [px/s] with down held
FAST_FALL_GAIN = 600.0  # [px/s2] how quickly down gets there
# Jumping
JUMP_SPEED = 210.0  # [px/s] up; with the time below 57 px, 3.5 tiles
JUMP_BOOST = 80.0  # [px/s] along the way: a running jump is a long one, 7.7 tiles
JUMP_HOLD = 0.20  # [s] the speed is kept while jump is held: short and high jumps from one button
CEILING_GRACE = 0.05  # [s] a ceiling met that early in a jump only delays it: the hold goes on
COYOTE = 0.10  # [s] a jump is still one from the ground after the edge: nobody sees the last pixel
BUFFER = 0.08  # [s] a press this early before the landing counts
CORNER = 8  # [px] a head that hits a corner slips past it, and so does he when a corner squeezes him
POP_SPEED, POP_REACH = 80.0, 12  # [px/s], [px] feet that rise through a plank and are nearly up are helped up
# Ladders
CLIMB_SPEED = 104.0  # [px/s] a rung in 5 frames
CLIMB_ALIGN = 2.0  # [px] a step towards the ladder's middle
# Walls
SLIDE_SPEED = 40.0  # [px/s] at first; the grip tires over SLIDE_TIME
SLIDE_TIME = 1.2  # [s]
WALL_REACH = 6  # [px] a wall that near can be kicked: the hand reaches further than the box
WALL_JUMP_SPEED = 260.0  # [px/s] away from it
WALL_JUMP_TIME = 0.16  # [s] in which the keys cannot turn back, or one wall could be climbed
WALL_RETENTION = 0.06  # [s] a run into a corner is not lost if the corner is passed by then
# What throws him
SPRING_SPEED = 640.0  # [px/s] 113 px: over a ledge of 5 tiles with room to see it
STOMP_SPEED = 250.0  # [px/s] with jump held it rises like a jump
LIFT_TIME = 0.10  # [s] a platform's speed is still added to a jump after it was left
LIFT_X, LIFT_Y = 500.0, 260.0  # [px/s] at most, so that no platform becomes a cannon
THROWN = (190.0, 230.0)  # [px/s] away and up, where a hurt costs nothing else
THROWN_TIME = 0.25  # [s] in which the keys cannot turn back
DROP_TIME = 0.12  # [s] planks are open for: 8 px, more than a plank and less than to the next
DROP_SPEED = 80.0  # [px/s] the step down
THUD = 90.0  # [px] a fall from that high is heard: more than his own jump


def steps(seconds):
    """A time as whole steps: counted, never summed, so that every run agrees on the last one."""
    return round(seconds / STEP_SECONDS)


def approach(value, target, change):
    """The value moved towards a target by at most `change`."""
    return min(value + change, target) if value < target else max(value - change, target)
