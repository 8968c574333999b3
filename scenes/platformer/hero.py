"""The hero: running, jumping, falling, climbing and pushing, with the parameters of feel.py."""

from collections.abc import Sequence
from math import sqrt
from typing import cast

from game.scene import STEP_SECONDS
from physics import Body, Character, Polygon
from scenes.platformer.blasting import Rubble
from scenes.platformer.bridge import Bridge
from scenes.platformer.feel import (
    AIR_CONTROL,
    APEX_SPEED,
    BUFFER,
    CEILING_GRACE,
    CLIMB_ALIGN,
    CLIMB_SPEED,
    CORNER,
    COYOTE,
    DROP_SPEED,
    DROP_TIME,
    FALL_SPEED,
    FAST_FALL_GAIN,
    FAST_FALL_SPEED,
    GRAVITY,
    HEIGHT,
    JUMP_BOOST,
    JUMP_HOLD,
    JUMP_SPEED,
    LIFT_TIME,
    LIFT_X,
    LIFT_Y,
    OVERSPEED_DRAG,
    POP_REACH,
    POP_SPEED,
    PUSH,
    PUSH_REACH,
    PUSH_SPEED,
    RUN_ACCELERATION,
    RUN_SPEED,
    SLIDE_SPEED,
    SLIDE_TIME,
    SPRING_SPEED,
    STOMP_SPEED,
    THROWN,
    THROWN_TIME,
    THUD,
    WALL_JUMP_SPEED,
    WALL_JUMP_TIME,
    WALL_REACH,
    WALL_RETENTION,
    WIDTH,
    approach,
    steps,
)
from scenes.platformer.level import HERO_FILTER
from scenes.platformer.things import Crate, Trigger

TIMERS = ("coyote", "drop", "locked", "kept", "lift")


class Hero:
    """The hero: a kinematic character with speeds [px/s] and timers [steps].

    news: names of the events of the last step, such as "jump" or "land", for sounds, dust and goals.
    """

    def __init__(self, world, level, position):
        self.world, self.level = world, level
        self.character = Character(
            world, Polygon.box(WIDTH, HEIGHT), position, filter=HERO_FILTER, user="hero", push=PUSH
        )
        self.crates: Sequence[Crate | Rubble] = ()  # bodies that he can push
        # Boxes (left, top, right, bottom) of everything solid but tiles; set before each step.
        self.solids: Sequence[tuple] = ()
        self.bridges: Sequence[Bridge] = ()  # one-way, as planks are
        self.ladders = {}  # body id -> trigger of the ladders that he touches
        self.facing = 1
        self.news = []
        self.place(position)

    def place(self, position):
        """Move the hero to a position (x, y) [px], at rest, and reset all timers."""
        self.character.move_to(position)
        self.character.move(0.0, 0.0)  # clears a squeeze that was not reported yet
        self.before = self.character.position
        self.vx = self.vy = self.rise_speed = self.lift_x = self.lift_y = self.kept_vx = self.slope = 0.0
        self.buffer = self.coyote = self.rise = self.drop = self.locked = self.kept = self.lift = 0
        self.grip = steps(SLIDE_TIME)
        self.locked_way = self.wall = self.sliding = 0
        self.grounded = self.pushing = self.crushed = False
        self.pushed: Crate | Rubble | None = None  # the crate that he runs against
        self.peak = self.before[1]  # highest point since he left the ground [px]
        self.riding: Body | None = None
        self.ladder: Trigger | None = None
        self.gazing = 0  # -1 looks up, 1 ducks
        self.news.clear()

    @property
    def box(self):
        """Box (left, top, right, bottom) of the hero in integer pixels."""
        x, y = self.character.position
        left, top = round(x - WIDTH / 2), round(y - HEIGHT / 2)
        return left, top, left + WIDTH, top + HEIGHT

    def step(self, inputs):
        """Move the hero for one step according to the input."""
        self.news.clear()
        self.before = self.character.position
        way = inputs.held("right") - inputs.held("left") if self.locked == 0 else self.locked_way
        held, down, up = inputs.held("jump"), inputs.held("down"), inputs.held("up")
        self.listen(inputs)
        self.gazing = (down - up) if self.grounded and not way else 0
        if self.ladder is None:
            self._grab(up, down)
        if self.ladder is not None:
            self._climb(way, down - up, down)
        else:
            self._run(way)
            self._fall(way, held, down)
            if self.buffer:
                self._jump(way, down)
        for timer in TIMERS:
            setattr(self, timer, max(getattr(self, timer) - 1, 0))
        self._travel()

    def listen(self, inputs):
        """Record a press of jump, which then stays valid for BUFFER seconds.

        The method is also called while the picture is frozen, so that no press is lost.
        """
        self.buffer = steps(BUFFER) if inputs.pressed("jump") else max(self.buffer - 1, 0)

    def rest(self):
        """Move the hero for one step without input, after he has reached the goal. He slows down and falls."""
        self.news.clear()
        self.before = self.character.position
        self.ladder, self.gazing = None, 0
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
            # The limit grows from FALL_SPEED to FAST_FALL_SPEED, so that a tap of down has little effect.
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
        if self.grounded and down and self.on_boards():
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
        near = [
            side
            for side in (self.facing, -self.facing)
            if any(self._blocked(side * reach, 0) for reach in range(1, WALL_REACH + 1))
        ]
        if near:
            self.locked_way = self.facing = -near[0]
            self.locked = steps(WALL_JUMP_TIME)
            self.vx = self.locked_way * WALL_JUMP_SPEED
            self.kept = 0
            self._rise(JUMP_SPEED)
            self.news.append("wall_jump")

    def _rise(self, speed):
        self.vy = self.rise_speed = -speed
        self.rise = steps(JUMP_HOLD) + 1  # the step of the press itself does not count
        self.buffer = self.coyote = 0
        self.grounded = False
        self.ladder = None
        self.grip = steps(SLIDE_TIME)

    def on_boards(self):
        """Return whether the hero stands on one-way ground (planks or a bridge).

        The keys down and jump let him drop through such ground.
        """
        left, _, right, bottom = self.box
        return self.level.on_plank(left, bottom, WIDTH) or any(one.bears(left, right, bottom) for one in self.bridges)

    # --- ladders ---------------------------------------------------------------------------------------------------

    def _grab(self, up, down):
        """Hold on to a ladder that the hero touches, if one of the keys is held.

        up: whether the key up is held, which grabs a ladder from beside or below; down: whether the key down is held,
        which grabs it from its top.
        """
        if up == down or self.vy < 0.0:
            return
        bottom = self.box[3]
        for ladder in self.ladders.values():
            if (up and bottom > ladder.top) or (down and self.grounded and bottom == ladder.top):
                self.ladder = ladder
                self.grounded = self.pushing = False
                self.pushed = None
                self.sliding = 0
                return

    def _climb(self, way, turn, down):
        """Climb for one step, or leave the ladder.

        way: -1 left, 1 right, 0 none; turn: -1 up, 1 down, 0 none; down: whether the key down is held.
        """
        if self.buffer:
            self.ladder, self.coyote = None, 0 if down else 1
            self.vx = self.vy = 0.0
            if down:
                self.buffer = 0  # down and jump: let go without a jump
            else:
                self._jump(way, False)
            return
        ladder = self.ladder
        if ladder is None or ladder.body.id not in self.ladders or (way and not turn):
            self.ladder, self.coyote = None, steps(COYOTE)  # the ladder has ended, or he steps off it
            self.vx, self.vy = way * RUN_SPEED * 0.5, 0.0
            return
        if way:
            self.facing = way
        aside = ladder.x - self.character.position[0]
        self.vx = max(-CLIMB_ALIGN, min(aside, CLIMB_ALIGN)) / STEP_SECONDS
        self.vy = turn * CLIMB_SPEED
        if turn < 0:
            self.vy = max(self.vy, (ladder.top - self.box[3]) / STEP_SECONDS)
        self.drop = 2 if turn > 0 else 0  # going down, he passes the one-way ground at the ladder's top

    def _leave_ladder(self, moved, ladder):
        """Leave the ladder if the hero has reached its foot or its top. moved: result of his last Character.move()."""
        if self.vy > 0.0 and moved.grounded:
            self.ladder, self.drop, self.grounded = None, 0, True
        elif self.box[3] <= ladder.top:
            self.ladder, self.grounded = None, True
        if self.ladder is None:
            self.vx = self.vy = 0.0

    # --- what happens to him -----------------------------------------------------------------------------------------

    def launch(self):
        """Throw the hero up by a spring. His height of flight does not depend on the keys that are held."""
        self._rise(SPRING_SPEED)
        self.rise = 0
        self.news.append("launch")

    def bounce(self):
        """Let the hero bounce off an enemy's back."""
        self._rise(STOMP_SPEED)
        self.news.append("stomp")

    def throw(self, way):
        """Throw the hero up and to the side `way` (-1 left, 1 right). Called for hits that cost no life."""
        self._rise(THROWN[1])
        self.rise, self.kept, self.drop = 0, 0, 0
        self.locked, self.locked_way, self.vx = steps(THROWN_TIME), way, way * THROWN[0]
        self.news.append("thrown")

    # --- the way through the world -----------------------------------------------------------------------------------

    def _travel(self):
        # vx is the speed along the ground, so that a slope needs less motion along x.
        along = 1.0 / sqrt(1.0 + self.slope * self.slope) if self.grounded else 1.0
        dx, dy = self.vx * along * STEP_SECONDS, self.vy * STEP_SECONDS
        if self.ladder is None and self._nearly_up():
            dy -= POP_SPEED * STEP_SECONDS
        moved = self.character.move(dx, dy, drop=self.drop > 0)
        self.crushed = moved.squeezed and not self._slip_out()
        self.wall, self.slope, self.riding = moved.wall, moved.slope, cast(Body | None, moved.riding)
        if self.ladder is not None:
            self._leave_ladder(moved, self.ladder)
            self.peak = self.character.position[1]
            return
        if self.vy < 0.0 and moved.y == 0 and dy <= -1.0:
            self._bump(dy)
        if moved.x == 0 and moved.wall and moved.wall * self.vx > 0.0:
            if not self.kept and not self.grounded:
                self.kept_vx, self.kept = self.vx, steps(WALL_RETENTION)
            if self.pushed is None or not self.pushed.slides(moved.wall):
                self.vx = 0.0
        self._stand(moved.grounded and self.vy >= 0.0)

    def _stand(self, grounded):
        if grounded:
            if not self.grounded:
                self.news.append("land" if self.character.position[1] - self.peak < THUD else "thud")
            self.vy, self.coyote, self.grip = 0.0, steps(COYOTE), steps(SLIDE_TIME)
            self._remember_lift()
        y = self.character.position[1]
        self.peak = y if grounded else min(self.peak, y)
        self.grounded = grounded

    def _remember_lift(self):
        """Record the velocity of the platform, crate or belt that carries the hero.

        A jump within LIFT_TIME adds this velocity.
        """
        vx, vy = self.riding.velocity if self.riding is not None else (0.0, 0.0)
        vx += self.character.surface_speed
        if (vx, vy) != (0.0, 0.0):
            self.lift_x, self.lift_y = vx, vy
            self.lift = steps(LIFT_TIME)

    def _nearly_up(self):
        """Return whether the hero rises through a plank or bridge while his feet are just below its top."""
        if self.vy > 0.0 or self.grounded:
            return False
        left, _, right, bottom = self.box
        boards = (self.level.plank_within, *(one.holds for one in self.bridges))
        return any(within(left, right, bottom, POP_REACH) for within in boards)

    def _bump(self, dy):
        """React to a blocked upward motion: move the hero past a near corner of the ceiling, or else stop his rise.

        dy: the motion that was blocked [px].
        """
        sides = (1, -1) if self.vx == 0.0 else (1 if self.vx > 0.0 else -1,)
        for reach in range(1, CORNER + 1):
            for side in sides:
                if not self._blocked(side * reach, 0) and not self._blocked(side * reach, -1):
                    self.character.move(side * reach, 0.0)
                    self.character.move(0.0, dy)
                    return
        self.vy = 0.0
        if self.rise <= steps(JUMP_HOLD) + 1 - steps(CEILING_GRACE):
            self.rise = 0
        self.news.append("bump")

    def _slip_out(self):
        """Move a squeezed hero to the nearest free position at his left or right, at most CORNER px away.

        Return whether there was such a position.
        """
        x, y = self.character.position
        for reach in range(1, CORNER + 1):
            for side in (-1, 1):
                if not self._blocked(side * reach, 0):
                    self.character.move_to((x + side * reach, y))
                    return True
        return False

    def _blocked(self, dx, dy):
        """Return whether the hero's box, moved by (dx, dy) integer pixels, would overlap anything solid."""
        left, top, right, bottom = self.box
        left, top, right, bottom = left + dx, top + dy, right + dx, bottom + dy
        return self.level.blocks(left, top, WIDTH, HEIGHT) or any(
            left < box[2] and box[0] < right and top < box[3] and box[1] < bottom for box in self.solids
        )

    def _crate_beside(self, way):
        left, top, right, bottom = self.box
        first, last = (right, right + PUSH_REACH) if way > 0 else (left - PUSH_REACH, left)
        for crate in self.crates:
            box = crate.box
            if box[0] < last and first < box[2] and top < box[3] and box[1] < bottom:
                return crate
        return None

    def state(self):
        """Return the part of Scene.state() that describes the hero outside the physics world, a flat tuple."""
        return (
            self.vx,
            self.vy,
            self.rise_speed,
            self.lift_x,
            self.lift_y,
            self.kept_vx,
            self.slope,
            self.buffer,
            self.coyote,
            self.rise,
            self.drop,
            self.locked,
            self.kept,
            self.lift,
            self.grip,
            self.locked_way,
            self.wall,
            self.sliding,
            self.facing,
            self.grounded,
            self.peak,
            *sorted(self.ladders),
            self.ladder.body.id if self.ladder is not None else -1,
        )
