"""The hero: every number that makes a jump feel right, and the moves made of them.

The numbers are those of Celeste at twice its size, since its tiles are 8 px wide and ours 16. Half of the moves only
forgive: they do what the player meant, a few frames or pixels off from what was pressed.
"""

from math import sqrt

from game.loop import STEP_SECONDS
from physics import Character, Polygon
from scenes.platformer.level import HERO_FILTER

WIDTH, HEIGHT = 10, 20       # [px] slimmer than the sprite: what grazes the scarf is no hit

# Running
RUN_SPEED = 180.0            # [px/s] 11 tiles a second: the screen's width takes 2.7 s
RUN_ACCELERATION = 2000.0    # [px/s2] full speed after 5 frames: felt as at once, seen as a start
OVERSPEED_DRAG = 800.0       # [px/s2] a wall jump's or a platform's extra speed is lost slowly, it was earned
AIR_CONTROL = 0.65           # of both in the air: a jump can be steered but not undone
PUSH_SPEED = 88.0            # [px/s] a crate is heavy, and rubs off a fifth of it
PUSH_REACH = 4               # [px] a crate this near is still being pushed
PUSH = 3000.0                # [px/s2] one large crate, not two on each other
# Falling
GRAVITY = 1800.0             # [px/s2]
APEX_SPEED = 80.0            # [px/s] slower than this with jump held, gravity is half: time to aim the landing
FALL_SPEED = 320.0           # [px/s] what can still be read at a fall across the screen
FAST_FALL_SPEED = 480.0      # [px/s] with down held
FAST_FALL_GAIN = 600.0       # [px/s2] how quickly down gets there
# Jumping
JUMP_SPEED = 210.0           # [px/s] up; with the time below 57 px, 3.5 tiles
JUMP_BOOST = 80.0            # [px/s] along the way: a running jump is a long one, 7.7 tiles
JUMP_HOLD = 0.20             # [s] the speed is kept while jump is held: short and high jumps from one button
COYOTE = 0.10                # [s] a jump is still one from the ground after the edge: nobody sees the last pixel
BUFFER = 0.08                # [s] a press this early before the landing counts
CORNER = 8                   # [px] a head that hits a corner slips past it, and so does he when a corner squeezes him
# Walls
SLIDE_SPEED = 40.0           # [px/s] at first; the grip tires over SLIDE_TIME
SLIDE_TIME = 1.2             # [s]
WALL_REACH = 6               # [px] a wall that near can be kicked: the hand reaches further than the box
WALL_JUMP_SPEED = 260.0      # [px/s] away from it
WALL_JUMP_TIME = 0.16        # [s] in which the keys cannot turn back, or one wall could be climbed
WALL_RETENTION = 0.06        # [s] a run into a corner is not lost if the corner is passed by then
# What throws him
SPRING_SPEED = 640.0         # [px/s] 113 px: over a ledge of 5 tiles with room to see it
STOMP_SPEED = 250.0          # [px/s] with jump held it rises like a jump
LIFT_TIME = 0.10             # [s] a platform's speed is still added to a jump after it was left
LIFT_X, LIFT_Y = 500.0, 260.0  # [px/s] at most, so that no platform becomes a cannon
DROP_TIME = 0.12             # [s] planks are open for: 8 px, more than a plank and less than to the next
DROP_SPEED = 80.0            # [px/s] the step down
THUD = 90.0                  # [px] a fall from that high is heard: more than his own jump


def steps(seconds):
    """A time as whole steps: counted, never summed, so that every run agrees on the last one."""
    return round(seconds / STEP_SECONDS)


def approach(value, target, change):
    """The value moved towards a target by at most `change`."""
    return min(value + change, target) if value < target else max(value - change, target)


class Hero:
    """Speeds, timers [steps] and what happened in the last step (`news`: words for sound, dust and the judge)."""

    def __init__(self, world, level, position):
        self.world, self.level = world, level
        self.character = Character(world, Polygon.box(WIDTH, HEIGHT), position, filter=HERO_FILTER, user="hero", push=PUSH)
        self.crates = ()           # what he can push
        self.solids = ()           # boxes (left, top, right, bottom) of these and of platforms, refreshed before each step
        self.facing = 1
        self.news = []
        self.place(position)

    def place(self, position):
        """Stand still somewhere, as at a start."""
        self.character.move_to(position)
        self.character.move(0.0, 0.0)        # forgets a squeeze that was not told yet
        self.before = self.character.position
        self.vx = self.vy = self.rise_speed = self.lift_x = self.lift_y = self.kept_vx = self.slope = 0.0
        self.buffer = self.coyote = self.rise = self.drop = self.locked = self.kept = self.lift = 0
        self.grip = steps(SLIDE_TIME)
        self.locked_way = self.wall = self.sliding = 0
        self.grounded = self.pushing = self.crushed = False
        self.pushed = None                   # the crate beside him that he runs against
        self.peak = self.before[1]           # highest since he left the ground [px]
        self.riding = None
        self.news.clear()

    @property
    def box(self):
        """Left, top, right, bottom in whole pixels."""
        x, y = self.character.position
        left, top = round(x - WIDTH / 2), round(y - HEIGHT / 2)
        return left, top, left + WIDTH, top + HEIGHT

    def step(self, inputs):
        """One step of moves."""
        self.news.clear()
        self.before = self.character.position
        way = inputs.held("right") - inputs.held("left") if self.locked == 0 else self.locked_way
        held = inputs.held("jump")
        self.buffer = steps(BUFFER) if inputs.pressed("jump") else max(self.buffer - 1, 0)
        self._run(way)
        self._fall(way, held, inputs.held("down"))
        if self.buffer:
            self._jump(way, inputs.held("down"))
        for timer in ("coyote", "drop", "locked", "kept", "lift"):
            setattr(self, timer, max(getattr(self, timer) - 1, 0))
        self._travel()

    def rest(self):
        """A step without keys: he slows down and falls to the ground (the goal is reached)."""
        self.news.clear()
        self.before = self.character.position
        self._run(0)
        self._fall(0, False, False)
        self._travel()

    # --- the moves -------------------------------------------------------------------------------------------------

    def _run(self, way):
        control = 1.0 if self.grounded else AIR_CONTROL
        if self.kept and way * self.kept_vx > 0.0 and not self._blocked(1 if way > 0 else -1, 0):
            self.vx, self.kept = self.kept_vx, 0
        if way and self.locked == 0:
            self.facing = way
        self.pushed = self._crate_beside(way) if self.grounded and way else None
        self.pushing = self.pushed is not None
        speed = PUSH_SPEED if self.pushing else RUN_SPEED
        over = abs(self.vx) > speed and self.vx * way > 0.0
        rate = OVERSPEED_DRAG if over and not self.pushing else RUN_ACCELERATION
        self.vx = approach(self.vx, way * speed, rate * control * STEP_SECONDS)

    def _fall(self, way, held, down):
        self.sliding = 0
        if self.grounded:
            self.vy = 0.0
            return
        limit = FALL_SPEED
        if down:
            # From the plain limit it grows to the fast one: a tap of down is not yet a plunge.
            limit = min(max(FALL_SPEED, self.vy + FAST_FALL_GAIN * STEP_SECONDS), FAST_FALL_SPEED)
        elif way and way == self.wall and self.vy >= 0.0 and self.grip > 0:
            tired = 1.0 - self.grip / steps(SLIDE_TIME)
            limit = SLIDE_SPEED + (FALL_SPEED - SLIDE_SPEED) * tired
            self.grip -= 1
            self.sliding = way
        pull = GRAVITY * (0.5 if held and abs(self.vy) < APEX_SPEED else 1.0)
        self.vy = approach(self.vy, limit, pull * STEP_SECONDS)
        if self.rise:
            self.rise = self.rise - 1 if held else 0
            self.vy = min(self.vy, self.rise_speed) if self.rise else self.vy

    def _jump(self, way, down):
        left, _, _, bottom = self.box
        if self.grounded and down and self.level.on_plank(left, bottom, WIDTH):
            self.buffer, self.drop, self.grounded, self.coyote = 0, steps(DROP_TIME), False, 0
            self.vy = DROP_SPEED
            self.news.append("drop")
        elif self.grounded or self.coyote:
            self.vx += way * JUMP_BOOST
            self._rise(JUMP_SPEED)
            if self.lift:
                self.vx += max(-LIFT_X, min(self.lift_x, LIFT_X))
                self.vy = self.rise_speed = self.vy + max(-LIFT_Y, min(self.lift_y, 0.0))
            self.news.append("jump")
        else:
            self._wall_jump()

    def _wall_jump(self):
        near = [side for side in (self.facing, -self.facing)
                if any(self._blocked(side * reach, 0) for reach in range(1, WALL_REACH + 1))]
        if near:
            self.locked_way = self.facing = -near[0]
            self.locked = steps(WALL_JUMP_TIME)
            self.vx = self.locked_way * WALL_JUMP_SPEED
            self.kept = 0
            self._rise(JUMP_SPEED)
            self.news.append("wall_jump")

    def _rise(self, speed):
        self.vy = self.rise_speed = -speed
        self.rise = steps(JUMP_HOLD) + 1     # the step of the press itself does not count
        self.buffer = self.coyote = 0
        self.grounded = False
        self.grip = steps(SLIDE_TIME)

    def launch(self):
        """A spring throws him: always as high, whatever is held."""
        self._rise(SPRING_SPEED)
        self.rise = 0
        self.news.append("launch")

    def bounce(self):
        """Up from a walker's back."""
        self._rise(STOMP_SPEED)
        self.news.append("stomp")

    # --- the way through the world -----------------------------------------------------------------------------------

    def _travel(self):
        # The speed is along the ground: the same uphill, where each pixel along x is more than a pixel of way.
        along = 1.0 / sqrt(1.0 + self.slope * self.slope) if self.grounded else 1.0
        dx, dy = self.vx * along * STEP_SECONDS, self.vy * STEP_SECONDS
        moved = self.character.move(dx, dy, drop=self.drop > 0)
        self.crushed = moved.squeezed and not self._slip_out()
        if self.vy < 0.0 and moved.y == 0 and dy <= -1.0:
            self._bump(dy)
        if moved.x == 0 and moved.wall and moved.wall * self.vx > 0.0:
            if not self.kept and not self.grounded:
                self.kept_vx, self.kept = self.vx, steps(WALL_RETENTION)
            if not (self.pushing and self.pushed.slides(moved.wall)):
                self.vx = 0.0
        self.wall, self.slope, self.riding = moved.wall, moved.slope, moved.riding
        self._stand(moved.grounded and self.vy >= 0.0)

    def _stand(self, grounded):
        if grounded:
            if not self.grounded:
                self.news.append("land" if self.character.position[1] - self.peak < THUD else "thud")
            self.vy, self.coyote, self.grip = 0.0, steps(COYOTE), steps(SLIDE_TIME)
            if self.riding is not None and self.riding.velocity != (0.0, 0.0):
                self.lift_x, self.lift_y = self.riding.velocity
                self.lift = steps(LIFT_TIME)
        y = self.character.position[1]
        self.peak = y if grounded else min(self.peak, y)
        self.grounded = grounded

    def _bump(self, dy):
        """The head hit something: slip past its corner, or stop rising."""
        sides = (1, -1) if self.vx == 0.0 else (1 if self.vx > 0.0 else -1,)
        for reach in range(1, CORNER + 1):
            for side in sides:
                if not self._blocked(side * reach, 0) and not self._blocked(side * reach, -1):
                    self.character.move(side * reach, 0.0)
                    self.character.move(0.0, dy)
                    return
        self.vy = 0.0
        self.rise = 0
        self.news.append("bump")

    def _slip_out(self):
        """Squeezed by a corner only: out to the nearer side. Returns whether there was room."""
        x, y = self.character.position
        for reach in range(1, CORNER + 1):
            for side in (-1, 1):
                if not self._blocked(side * reach, 0):
                    self.character.move_to((x + side * reach, y))
                    return True
        return False

    def _blocked(self, dx, dy):
        """Whether the box, shifted by whole pixels, would be in something solid."""
        left, top, right, bottom = self.box
        left, top, right, bottom = left + dx, top + dy, right + dx, bottom + dy
        return self.level.blocks(left, top, WIDTH, HEIGHT) or any(
            left < box[2] and box[0] < right and top < box[3] and box[1] < bottom for box in self.solids)

    def _crate_beside(self, way):
        left, top, right, bottom = self.box
        first, last = (right, right + PUSH_REACH) if way > 0 else (left - PUSH_REACH, left)
        for crate in self.crates:
            box = crate.box
            if box[0] < last and first < box[2] and top < box[3] and box[1] < bottom:
                return crate
        return None

    def state(self):
        """All that the next step depends on and that is not in the world."""
        return (self.vx, self.vy, self.rise_speed, self.lift_x, self.lift_y, self.kept_vx, self.slope, self.buffer,
                self.coyote, self.rise, self.drop, self.locked, self.kept, self.lift, self.grip, self.locked_way,
                self.wall, self.sliding, self.facing, self.grounded, self.peak)
