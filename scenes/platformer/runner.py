"""The scripted player: looks ahead at tiles and things, and presses keys. It knows the rules of the moves, not the level.

Rules, in order: wait for a platform until it is docked and stay on it until the other side; jump off walls when
falling; on the ground jump at what is in the way, over what hurts, onto walkers; drop through planks for coins below.
"""

from scenes.platformer.hero import HEIGHT

LEAP = 18                    # [px] before an edge or spikes it jumps
NEAR_WALKER = 30             # [px] the last chance to jump over a walker
FLIGHT = 0.63                # [s] from a full jump's start to a walker's back
REACH = (112, 127)           # [px] how far a full jump carries in that time
DOCK = 1.5                   # [px] a platform that near its end is docked
SHAFT = 56                   # [px] walls that near can be kicked in turn
JUMP_HEIGHT = 57             # [px]
BELOW = 110                  # [px] coins that far under a plank are worth a drop
PATIENCE = 6                 # steps of standing at a wall before it jumps: a crate may still give way


class Runner:
    """Remembers little: how long it has been stopped, which coins it dropped for, whether jump is still to be released."""

    def __init__(self):
        self.stopped = 0
        self.dropped_for = set()
        self.hold = 0
        self.spring = None         # the one it walks back to

    def keys(self, scene):
        """The actions of the next step."""
        if scene.phase != "playing":
            return frozenset()
        hero = scene.hero
        self.stopped = self.stopped + 1 if hero.grounded and hero.wall and hero.vx == 0.0 else 0
        if self.stopped == PATIENCE and hero.wall > 0:
            self.spring = self._spring_behind(scene)
        way, waits = self._way(scene)
        if hero.grounded and not waits and self._drops(scene):
            return frozenset(("down", "jump"))
        jump = self._wants_jump(scene, waits)
        if jump and not self.hold:
            self.hold = 40
        self.hold = max(self.hold - 1, 0)
        keys = {way} if way else set()
        # Held while it rises; up for one step before the next press, since only a fresh press jumps.
        if self.hold and (jump or not hero.grounded):
            keys.add("jump")
        else:
            self.hold = 0
        return frozenset(keys)

    # --- where to ------------------------------------------------------------------------------------------------------

    def _way(self, scene):
        """(key to hold, whether it waits for a platform)."""
        hero = scene.hero
        left, _, right, bottom = hero.box
        if self.spring is not None:
            if hero.vy < -300.0:
                self.spring = None
            else:
                return ("left" if self.spring.x < (left + right) / 2 else "right"), False
        if hero.grounded and self._over_edge(scene) and self._lands_badly(scene):
            return None, True
        for platform in scene.things.platforms:
            box = platform.box
            if hero.riding == platform.body:
                return self._ride(platform, hero)
            start_left = platform.start[0] - platform.size[0] / 2
            start_top = platform.start[1] - platform.size[1] / 2
            before = start_left - 40 < right <= start_left + 20 and abs(bottom - start_top) < 8
            under = start_left < (left + right) / 2 < start_left + platform.size[0] and bottom > start_top + 16
            if under and platform.end[1] < platform.start[1]:
                return "left", False         # fallen into its pit: out again on the near side
            if before and hero.grounded and not self._docked(platform, platform.start):
                return (None if right < start_left - 12 else "left"), True
            if left >= box[0] - 30 and right <= box[0] + 20 and hero.grounded and abs(bottom - box[1]) < 3:
                return "right", True
        return "right", False

    def _spring_behind(self, scene):
        """A spring on this floor, when the wall ahead is higher than a jump."""
        left, top, right, bottom = scene.hero.box
        if all(scene.level.blocks(right, top - rise, 1, HEIGHT) for rise in (16, 32, 48, JUMP_HEIGHT)):
            for trigger in scene.things.of("spring"):
                if left - 96 < trigger.x < left and abs(trigger.foot[1] - bottom) < 4:
                    return trigger
        return None

    def _ride(self, platform, hero):
        x, _ = hero.character.position
        middle, _ = platform.body.position
        if self._docked(platform, platform.end):
            return "right", True
        if abs(x - middle) < 8:
            return None, True
        return ("right" if x < middle else "left"), True

    def _docked(self, platform, place):
        x, y = platform.body.position
        return abs(x - place[0]) < DOCK and abs(y - place[1]) < DOCK

    # --- what to do there ------------------------------------------------------------------------------------------------

    def _wants_jump(self, scene, waits):
        hero = scene.hero
        if not hero.grounded:
            if self.hold and hero.vy < 0.0:
                return True
            return hero.wall != 0 and hero.locked == 0 and (hero.vy > 30.0 or hero.wall < 0) and self._in_shaft(scene)
        if waits:
            return self._walker_comes(scene)
        return (self.stopped >= PATIENCE and self.spring is None) or self._over_edge(scene) or self._onto_walker(scene)

    def _in_shaft(self, scene):
        """Whether kicks lead up: a wall on either hand, and no ledge at the hands already."""
        left, top, right, _ = scene.hero.box
        blocks = scene.level.blocks
        if scene.hero.wall > 0 and not blocks(right, top - 8, 1, HEIGHT):
            return False
        return (any(blocks(left - reach, top, 1, HEIGHT) for reach in range(1, SHAFT, 8))
                and any(blocks(right + reach, top, 1, HEIGHT) for reach in range(0, SHAFT, 8)))

    def _over_edge(self, scene):
        """Spikes just ahead and below."""
        _, top, right, bottom = scene.hero.box
        for trigger in scene.things.of("spikes"):
            area = trigger.thing
            if area.x - LEAP < right < area.x + area.width and -8 < area.y - bottom < 80:
                return True
        return False

    def _onto_walker(self, scene):
        hero = scene.hero
        _, top, right, bottom = hero.box
        x = hero.character.position[0]
        for walker in scene.things.walkers.values():
            there = walker.character.position[0]
            if abs(walker.bottom - bottom) > 24 or there < x:
                continue
            then = walker.place_after(FLIGHT)
            if REACH[0] < then - x < REACH[1] or there - right < NEAR_WALKER:
                return hero.vx > 100.0 or there - right < NEAR_WALKER
        return False

    def _walker_comes(self, scene):
        """A walker from either side while he stands: he jumps it, and comes down on it or behind it."""
        x, bottom = scene.hero.character.position[0], scene.hero.box[3]
        return any(0.0 < (x - walker.character.position[0]) * walker.way < NEAR_WALKER and abs(walker.bottom - bottom) < 8
                   for walker in scene.things.walkers.values())

    def _lands_badly(self, scene):
        """Whether a leap from here ends beside a walker instead of on it."""
        x, bottom = scene.hero.character.position[0], scene.hero.box[3]
        for walker in scene.things.walkers.values():
            ahead = walker.place_after(FLIGHT) - x
            if abs(walker.bottom - bottom) < 24 and (REACH[0] - 40 < ahead < REACH[0] or REACH[1] < ahead < REACH[1] + 60):
                return True
        return False

    def _drops(self, scene):
        """Whether coins hang under the plank it stands on; once for each."""
        left, _, right, bottom = scene.hero.box
        if not scene.level.on_plank(left, bottom, right - left):
            return False
        below = [identity for identity, trigger in scene.things.triggers.items()
                 if trigger.kind == "coin" and identity not in self.dropped_for
                 and left - 10 < trigger.x < right + 26 and 0 < trigger.y - bottom < BELOW]
        self.dropped_for.update(below)
        return bool(below)
