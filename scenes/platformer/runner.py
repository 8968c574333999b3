"""The platformer's bot. It follows hints in the map, and presses keys by rules.

A hint is a point in the map and the way to reach it: run (with jumps at obstacles), jump at once, climb, kick from
wall to wall, ride a platform, drop through a plank, push, fall, throw a bomb, or jump by a spring. The rules find the
right moment: when a platform is at its end, where an enemy will be, whether there is ground ahead.
"""

from math import sqrt

from scenes.platformer.blasting import CARRIED, WAITING
from scenes.platformer.feel import GRAVITY, RUN_SPEED

NEAR_X, NEAR_Y, NEAR_UP = 9, 8, 18  # [px] beside, below and above a hint (on a crate) that count as reached
EDGE = 10  # [px] before an edge at which the bot jumps
STEP = 18  # [px] ground that is lower by no more than this is not a gap
HOLD = 40  # steps that jump is held
FLIGHT = 0.63  # [s] from a full jump's start to an enemy's back
REACH = (100, 128)  # [px] range of a full jump in that time
CLOSE, FAST_CLOSE = 34, 54  # [px] distance at which the bot jumps over an enemy on the ground, over a flying one
CRATE_AHEAD, BESIDE_CRATE = 150, 60  # [px] distance within which a flying crate is waited for; distance kept from it
CRATE_FLIES = 40.0  # [px/s] vertical speed of a crate that is thrown or falls
PATIENCE = 240  # steps for which the bot waits for flying crates on the way to one hint
RUN_UP = 62  # [px] run-up needed for a jump over a hedgehog
PAUSE, LONGEST_PAUSE = 37, 90  # steps of waiting before a new life: PAUSE more for each life, modulo LONGEST_PAUSE
DOCK = 1.5  # [px] distance from an end of its path within which a platform counts as docked
THROW_FROM, AWAY = 62, 96  # [px] distance from the hint at which a bomb is thrown; least distance from it afterwards
KICK_SPEED = -90.0  # [px/s] vy above which the bot kicks off a wall (up is negative)


class Runner:
    """The bot, which follows the hints of the map, points along the hero's path.

    next: index of the current hint; kept: value of `next` at the last checkpoint.
    """

    def __init__(self):
        self.next = self.kept = 0
        self.lives = -1
        self.start_again()

    def remember(self):
        """Record the current hint as the start of the next life. Called at a checkpoint."""
        self.kept = self.next

    def start_again(self):
        """Begin a new life at the hint of the last checkpoint, after a pause.

        The pause differs from life to life, because the same steps at the same time would end in the same loss.
        """
        self.next = self.kept
        self.lives += 1
        self.pause = self.lives * PAUSE % LONGEST_PAUSE
        self.hold = 0  # remaining steps for which jump is held
        self.fresh = True  # the hint has just become the current one
        self.boarded = None  # the platform that the hero rides
        self.thrown = False  # a spring has thrown the hero towards this hint
        self.dropped = False
        self.patience = PATIENCE  # remaining steps of waiting for a flying crate

    def keys(self, scene):
        """Return the actions that the bot holds in the next step, a frozenset of names such as "left" and "jump"."""
        hints = scene.level.hints
        if scene.phase != "playing" or self.next >= len(hints) or self.pause:
            self.pause = max(self.pause - 1, 0)
            return frozenset()
        while self.next < len(hints) and self._there(scene, hints[self.next]):
            self.next += 1
            self.fresh, self.boarded, self.thrown, self.dropped = True, None, False, False
            self.patience = PATIENCE
        if self.next >= len(hints):
            return frozenset()
        hint = hints[self.next]
        keys, jump = getattr(self, "_" + hint.properties["act"])(scene, scene.hero, hint)
        self.fresh = False
        return self._press(scene.hero, set(keys), jump)

    def _press(self, hero, keys, jump):
        """Return the actions `keys` as a frozenset, with "jump" added while it is to be held. jump: whether to start a
        jump.

        Jump is held while the hero rises. It is released for one step before the next press, because only a new press
        jumps.
        """
        if jump and self.hold == 0:
            self.hold = HOLD
        elif self.hold and (hero.vy >= 0.0 or self.hold == 1) and self.hold < HOLD - 1:
            self.hold = 0
        if self.hold:
            self.hold -= 1
            keys.add("jump")
        return frozenset(keys)

    def _there(self, scene, hint):
        hero, act = scene.hero, hint.properties["act"]
        x, feet = hero.character.position[0], hero.box[3]
        near = abs(x - _middle(hint)) <= NEAR_X and -NEAR_UP <= feet - _foot(hint) <= NEAR_Y
        if act == "throw":
            return scene.feats.done["walls blown"] > 0
        if act == "push":
            return abs(x - _middle(hint)) <= NEAR_X
        return near and hero.grounded

    # --- one method for each kind of hint: return (keys, whether to jump) --------------------------------------------

    def _run(self, scene, hero, hint):
        way = _way(hero, hint)
        if not hero.grounded:
            return _keys(self._landing_aside(scene, hero) or way), False
        left, _, right, feet = hero.box
        below = _foot(hint) > feet + NEAR_Y and abs(_middle(hint) - (left + right) / 2) < 24
        if below and hero.on_boards():
            return {"down"}, True
        if self._needs_a_run_up(scene, hero, way):
            return _keys(-way), False
        if self._waits_at_edge(scene, hero, hint, way):
            return frozenset(), False
        crate = self._flying_crate(scene, hero, way)
        if crate is not None and self.patience:
            self.patience -= 1
            return _keys(-way if abs(crate - hero.character.position[0]) < BESIDE_CRATE else 0), False
        return _keys(way), self._must_jump(scene, hero, hint, way)

    def _needs_a_run_up(self, scene, hero, way):
        """Return whether the hero must step back for a run-up, because a jump now would end on a hedgehog.

        This is so if a hedgehog is near ahead and the hero is slow. way: direction of the run, -1 or 1.
        """
        x, feet = hero.character.position[0], hero.box[3]
        return (
            hero.vx * way < 120.0
            and not hero.wall
            and any(
                not enemy.stompable
                and abs(enemy.bottom - feet) < 10
                and 0 < (enemy.character.position[0] - x) * way < RUN_UP
                for enemy in scene.things.enemies.values()
            )
        )

    def _waits_at_edge(self, scene, hero, hint, way):
        """Return whether to wait at an edge, because a step down would end on or near a hedgehog.

        way: direction of the run, -1 or 1.
        """
        x, feet = hero.character.position[0], hero.box[3]
        if _foot(hint) < feet + STEP or self._ground(scene, x + 16 * way, feet):
            return False
        return any(
            not enemy.stompable
            and STEP < enemy.bottom - feet < 120
            and -20 < (enemy.place_after(0.4) - x) * way < RUN_UP
            for enemy in scene.things.enemies.values()
        )

    def _flying_crate(self, scene, hero, way):
        """Return the x [px] of a large crate ahead that flies and may land on the hero; None if there is none.

        way: direction of the run, -1 or 1.
        """
        x, feet = hero.character.position[0], hero.box[3]
        for crate in scene.things.crates:
            ahead = (crate.body.position[0] - x) * way
            flies = abs(crate.body.velocity[1]) > CRATE_FLIES and crate.box[1] < feet
            if flies and crate.size[0] > 16 and -crate.size[0] < ahead < CRATE_AHEAD:
                return crate.body.position[0]
        return None

    def _landing_aside(self, scene, hero):
        """Return the direction (-1, 1) in which to steer in the air in order not to land on a hedgehog; 0 if none is
        there.
        """
        x, feet = hero.character.position[0], hero.box[3]
        for enemy in scene.things.enemies.values():
            depth = enemy.top - feet
            if enemy.stompable or not 0 < depth < 120 or hero.vy < -60.0:
                continue
            time = (sqrt(hero.vy * hero.vy + 2.0 * GRAVITY * depth) - hero.vy) / GRAVITY
            lands, there = x + hero.vx * time, enemy.place_after(time)
            if abs(lands - there) < 26:
                # Land past the hedgehog if that is nearly reached, else short of it.
                return 1 if lands > there + 6 * (1 if hero.vx > 0.0 else -1) else -1
        return 0

    def _jump(self, scene, hero, hint):
        way = _way(hero, hint, 3)
        if hero.grounded:
            return _keys(way), self.fresh or self._must_jump(scene, hero, hint, way) or hero.wall == way != 0
        return _keys(way), False

    def _climb(self, scene, hero, hint):
        x, feet = hero.character.position[0], hero.box[3]
        turn = "down" if _foot(hint) > feet else "up"
        if hero.ladder is not None:
            return {turn}, False
        if abs(x - _middle(hint)) > 3:
            way = _way(hero, hint, 3)
            return _keys(way), hero.grounded and self._must_jump(scene, hero, hint, way)
        return {turn}, False

    def _kick(self, scene, hero, hint):
        if hero.grounded:
            return _keys(hero.facing), hero.wall == hero.facing
        up = hero.box[3] <= _foot(hint) + 2
        if up:
            return _keys(_way(hero, hint, 3)), False
        way = hero.wall or hero.facing
        return _keys(way), hero.wall != 0 and hero.locked == 0 and hero.vy > KICK_SPEED

    def _drop(self, scene, hero, hint):
        x = hero.character.position[0]
        if hero.grounded and not self.dropped:
            if abs(x - _middle(hint)) > 6:
                return _keys(_way(hero, hint, 3)), False
            self.dropped = True
            return {"down"}, True
        return _keys(_way(hero, hint, 3)), False

    def _push(self, scene, hero, hint):
        return _keys(_way(hero, hint)), False

    def _fall(self, scene, hero, hint):
        return _keys(_way(hero, hint, 3)), False

    def _spring(self, scene, hero, hint):
        self.thrown = hero.vy < -300.0 or (self.thrown and not hero.grounded)
        if self.thrown:
            # If the throw ends at a wall below the hint, the hero goes on by kicks off the wall.
            return self._kick(scene, hero, hint) if hero.wall or hero.locked else (_keys(_way(hero, hint, 3)), False)
        spring = min(
            scene.things.of("spring"),
            key=lambda one: abs(one.x - hero.character.position[0]) + abs(one.foot[1] - hero.box[3]),
        )
        way = 1 if spring.x > hero.character.position[0] else -1
        if not hero.grounded:
            return _keys(self._landing_aside(scene, hero) or way), False
        return _keys(way), hero.wall == way or self._enemy_ahead(scene, hero, way)

    def _throw(self, scene, hero, hint):
        """Return (keys, whether to jump) for a hint "throw".

        The hero takes the bomb, throws it near the hint, and stays away until it has exploded.
        """
        bomb = min(scene.things.bombs, key=lambda one: abs(one.home[0] - _middle(hint)))
        x = hero.character.position[0]
        if bomb.phase == CARRIED:
            if abs(x - _middle(hint)) > THROW_FROM:
                return _keys(_way(hero, hint)), False
            return _keys(_way(hero, hint)) | {"focus"}, False
        if bomb.phase == WAITING:
            return _keys(_way_to(hero, bomb.home[0], 2)), hero.wall != 0
        return _keys(0 if abs(x - bomb.place[0]) > AWAY else 1 if x > bomb.place[0] else -1), False

    def _ride(self, scene, hero, hint):
        x, feet = hero.character.position[0], hero.box[3]
        if self.boarded is None:
            return self._board(scene, hero, hint)
        platform = self.boarded
        # The hero leaves the platform at the end of its path that is nearer to the hint.
        there = _nearest_end(platform, _middle(hint), _foot(hint))
        left, _, right, _ = platform.box
        on_it = left - 4 <= x <= right + 4 and feet <= platform.box[1] + 4
        if not on_it and hero.grounded and hero.riding is None:
            return self._run(scene, hero, hint)  # the hero stands beside the platform, on either side
        if _docked(platform, there):
            way = _way(hero, hint)
            return _keys(way), hero.grounded and (hero.wall == way or self._must_jump(scene, hero, hint, way))
        if not hero.grounded:
            return _keys(_way_to(hero, (left + right) / 2, 6)), False
        jump = self._enemy_near(scene, hero)
        middle = (left + right) / 2
        if hero.riding is not None and hero.riding.user == "crate":
            return frozenset(), jump
        return _keys(_way_to(hero, middle, 10)), jump or (hero.wall != 0 and abs(x - middle) > 10)

    def _board(self, scene, hero, hint):
        x, feet = hero.character.position[0], hero.box[3]
        platform = min(
            scene.things.platforms,
            key=lambda one: min(
                abs(x - one.start[0]) + abs(feet - one.start[1]), abs(x - one.end[0]) + abs(feet - one.end[1])
            ),
        )
        end = _nearest_end(platform, x, feet)
        left = end[0] - platform.size[0] / 2
        right = end[0] + platform.size[0] / 2
        way = 1 if end[0] > x else -1
        if left <= x <= right and hero.grounded and hero.riding is not None:
            self.boarded = platform
            return self._ride(scene, hero, hint)
        if not hero.grounded and left - 40 < x < right + 40:
            return _keys(_way_to(hero, self._place_on(scene, platform, x), 5)), False
        gap = left - x if way > 0 else x - right
        if not _soon(platform, end, scene.ticks, 30):
            if gap > 28:
                return _keys(way), hero.grounded and self._must_jump(scene, hero, hint, way)
            return _keys(-way if gap < 12 and hero.grounded else 0), hero.grounded and self._enemy_near(scene, hero)
        return _keys(way), hero.grounded and (hero.wall == way or self._must_jump(scene, hero, hint, way))

    def _place_on(self, scene, platform, x):
        """Return the x [px] at which to land on a platform: on its large crate, on its enemy, or else at its centre.

        x: not used.
        """
        left, top, right, _ = platform.box
        for crate in scene.things.crates:
            at, _ = crate.body.position
            if crate.size[0] > 16 and left < at < right and abs(crate.box[3] - top) < 4:
                return at
        for enemy in scene.things.enemies.values():
            at = enemy.character.position[0]
            if enemy.stompable and left < at < right and abs(enemy.bottom - top) < 4:
                return at
        return (left + right) / 2

    # --- obstacles and enemies ---------------------------------------------------------------------------------------

    def _must_jump(self, scene, hero, hint, way):
        """Return whether to jump because of a wall, spikes, an enemy, or a gap.

        A gap counts unless the hint is lower than the hero. way: direction of the run, -1 or 1; 0 if the hero stands.
        """
        if not way:
            return self._enemy_near(scene, hero)
        left, _, right, bottom = hero.box
        if hero.wall == way and not (hero.pushing and hero.vx != 0.0 and hint.properties["act"] == "push"):
            return True
        level_or_up = _foot(hint) <= bottom + NEAR_Y
        beyond = abs(_middle(hint) - hero.character.position[0]) > EDGE + 6
        edge = right + EDGE if way > 0 else left - EDGE
        if level_or_up and beyond and not self._ground(scene, edge, bottom):
            return True
        if self._spikes(scene, hero, way):
            return True
        return self._enemy_ahead(scene, hero, way)

    def _ground(self, scene, x, bottom):
        """Return whether there is ground at x [px], at most STEP px lower than y = bottom."""
        level = scene.level
        if level.drop_to_ground(x, bottom - 4, STEP + 4) < STEP + 4 or level.kind_at(x, bottom + 2) == "one_way":
            return True
        return any(box[0] <= x <= box[2] and -4 <= box[1] - bottom <= STEP for box in scene.hero.solids)

    def _spikes(self, scene, hero, way):
        left, _, right, bottom = hero.box
        for trigger in scene.things.of("spikes"):
            area = trigger.thing
            ahead = area.x - right if way > 0 else left - area.x - area.width
            if -4 < ahead < EDGE + 4 and -8 < area.y - bottom < 40:
                return True
        return False

    def _enemy_ahead(self, scene, hero, way):
        """Return whether to jump now: onto an enemy ahead that can be stomped, or over any other enemy ahead.

        way: direction of the run, -1 or 1.
        """
        x, bottom = hero.character.position[0], hero.box[3]
        for enemy in scene.things.enemies.values():
            there = (enemy.character.position[0] - x) * way
            if not -4 < bottom - enemy.bottom + 12 < 36 or there < 0:
                continue
            then = (enemy.place_after(FLIGHT) - x) * way
            if enemy.stompable and REACH[0] < then < REACH[1] and abs(hero.vx) > 0.6 * RUN_SPEED:
                return True
            if there < (CLOSE if enemy.kind != "bat" else FAST_CLOSE):
                return True
        return False

    def _enemy_near(self, scene, hero):
        """Return whether an enemy within CLOSE px of the hero, at his height, moves towards him."""
        x, bottom = hero.character.position[0], hero.box[3]
        return any(
            0.0 < (x - enemy.character.position[0]) * enemy.way < CLOSE and abs(enemy.bottom - bottom) < 10
            for enemy in scene.things.enemies.values()
        )


def _middle(hint):
    return hint.x + hint.width / 2


def _foot(hint):
    return hint.y + hint.height


def _nearest_end(platform, x, y):
    """Return the end (x, y) [px] of a platform's path that is nearer to the point (x, y) [px]."""
    return min((platform.start, platform.end), key=lambda end: abs(x - end[0]) + abs(y - end[1]))


def _way_to(hero, x, slack):
    away = x - hero.character.position[0]
    return 0 if abs(away) <= slack else 1 if away > 0 else -1


def _way(hero, hint, slack=0):
    return _way_to(hero, _middle(hint), slack)


def _keys(way):
    return {"right"} if way > 0 else {"left"} if way < 0 else set()


def _docked(platform, place):
    x, y = platform.body.position
    return abs(x - place[0]) < DOCK and abs(y - place[1]) < DOCK


def _soon(platform, place, tick, within):
    """Return whether a platform is at the end `place` (x, y) [px] of its path, or near this end and approaching it.

    tick: number of the current step; within: number of steps over which the platform must come nearer.
    """
    here = platform.place_at(tick)
    far = abs(here[0] - place[0]) + abs(here[1] - place[1])
    then = platform.place_at(tick + within)
    return far < 2.0 * DOCK or (far < 20.0 and abs(then[0] - place[0]) + abs(then[1] - place[1]) < far)
