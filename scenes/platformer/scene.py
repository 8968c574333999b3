"""The platformer's rules for lives, pick-ups, enemies, bombs and the goal, which read the events of each step."""

from math import hypot

from game.scene import STEP_SECONDS, Result, Scene
from physics import Effects
from physics.settings import SLEEP_TIME
from scenes.platformer.blasting import REACH, WAITING
from scenes.platformer.contents import BELOW, Contents
from scenes.platformer.feats import Feats
from scenes.platformer.feel import GRAVITY, HEIGHT, steps
from scenes.platformer.hero import Hero
from scenes.platformer.level import FILTER_NAMES, level_of
from scenes.platformer.look import Look
from scenes.platformer.runner import Runner
from scenes.platformer.view import hero_frame, level_view

MOURNING = 0.6  # [s] from the hurt to the next life: long enough to see the reason, short enough to try again
MERCY = 1.2  # [s] in which enemies do not hurt after a new life or a throw back
APPLAUSE = 1.6  # [s] from the goal to its result
HIT_STOP = 4  # [steps] for which the picture is frozen when the hero is hurt: 67 ms
STOMP_STOP = 3  # [steps] for which the picture is frozen when he stomps an enemy
STRIKE = 60.0  # [px/s] slower impacts are ignored: a crate that is pushed or rocks (two steps of gravity)
CRUSHING = 120000.0  # [density px3/s] impulse from which a crate crushes: the large crate after a fall of one tile
STOMP_DEPTH = 9  # [px] below an enemy's top at which feet still stomp it
COIN_WORTH, SECRET_WORTH = 100, 1000
PLAYING, HURT, WON = "playing", "hurt", "won"


class Platformer(Scene):
    """The platformer, a scene with one world. The player moves the hero."""

    name = "platformer"
    title = "Platformer"
    about = (
        "From the meadow through the cave to the keep at dusk: run, climb, ride, push and stomp your way to the flag."
    )
    effects = Effects(
        response=True,
        gravity=True,
        rotation=True,
        friction=True,
        stacking=True,
        continuous=True,
        sleeping=True,
        sensors=True,
        one_way=True,
        conveyor=True,
        carving=True,
    )
    pieces = ("boxes", "circles", "tiles", "masks", "one-way masks", "characters", "queries")
    features = (
        "whole-pixel motion with slopes, planks, ladders and lifts",
        "a rope bridge that is open from below and walked by its curve",
        "coyote time, buffering, corner correction",
        "crates stack, topple, are pushed, ridden, thrown and carried by belts",
        "hits sound, shake and hurt by their impulse",
        "pick-ups are sensor events",
        "a bomb carves a wall of pixels; its rubble is pushed and climbed",
        "four secrets, a ghost of the best run",
    )
    filter_names = FILTER_NAMES
    actions = (("Arrows", "run, climb"), ("Space", "jump"), ("Down + Space", "through planks"), ("Shift", "throw"))
    broadphase = "hash"
    music = "platformer"
    ranked_by = "seconds"
    assists = ("invincible", "hit_stop")
    takes_level = True
    level_suffix = ".tmj"
    life_after = steps(MOURNING)

    def build(self):
        """Build the world with the level, its objects and the hero."""
        self.level = level_of(self.level_file)
        self.add_world(gravity=(0.0, GRAVITY))
        self.level.add_to(self.world)
        start = self.level.map.one("hero_start")
        self.spawn = (start.x + start.width / 2, start.y + start.height - HEIGHT / 2)
        self.hero = Hero(self.world, self.level, self.spawn)
        self.things = Contents(self.world, self.level, self.random)
        self.world.bodies["sleep_time"] = SLEEP_TIME  # bodies at rest in the first step count as having rested before
        self.checkpoints = self.things.of("checkpoint")
        self.touched = set()  # ids of the enemies in contact
        self.phase, self.since, self.mercy, self.stop = PLAYING, 0, 0, 0
        self.coins = self.secrets = self.deaths = 0
        self.clock = 0  # [steps] time of the run, including the pauses after hurts, without frozen steps
        self.ticks = 0  # number of steps of the world
        self.safe = self.spawn  # last position on static ground, to which an invincible hero returns from spikes
        self.feats = Feats(self)
        self.runner = Runner()
        self.look = Look(self)

    def update(self, inputs):
        """Move the hero and the objects of the level, step the world, and read its events."""
        if self.stop:
            self.stop -= 1
            self.hero.listen(inputs)
            self.look.hold()
            return
        self.look.begin_step()
        self._move_things()
        self._move_hero(inputs)
        self.world.step()
        self.ticks += 1
        self._read_events()
        self.feats.count()
        self.since += 1
        if self.phase == HURT and self.since >= self.life_after:
            self._start_life()
        elif self.phase == WON and self.since == steps(APPLAUSE):
            self.result = self._result()
        if self.phase != WON:
            x, _ = self.hero.character.position
            self.trail.append((x, self.look.foot, *hero_frame(self)))
        self.look.step(STEP_SECONDS)

    def _move_things(self):
        for word, thing in self.things.step(self.ticks, self.hero.character.position):
            if word == "squeezed":
                self._flatten(thing)
            elif word == "burst":
                self._burst(thing)
            else:
                self.look.show(word, thing)

    def _move_hero(self, inputs):
        hero, things = self.hero, self.things
        hero.crates = (*things.crates, *things.rubble)
        hero.solids, hero.bridges = things.solid_boxes, things.bridges
        self.clock += self.phase != WON
        if self.phase == PLAYING:
            hero.step(inputs)
            self._handle_bombs(inputs)
            if hero.grounded and hero.riding is None and hero.character.surface_speed == 0.0:
                self.safe = hero.character.position
        elif self.phase == WON:
            hero.rest()
        else:
            hero.news.clear()
            hero.before = hero.character.position
        self.look.hear(hero.news)
        if self.phase != PLAYING:
            return
        if hero.crushed or hero.box[1] > self.level.size[1] + BELOW:
            self._lose()

    def _handle_bombs(self, inputs):
        """Let the hero take a bomb that he reaches. At a press of `focus`, he throws or lays down the bomb that he
        carries.
        """
        hero, bomb = self.hero, self.things.carried
        if bomb is None:
            for each in self.things.bombs:
                if each.phase == WAITING and each.is_reached(hero.box):
                    each.take()
                    self.look.show("taken", each)
                    break
        elif bomb.carry(hero.character.position):
            self.look.show("back", bomb)
        elif inputs.pressed("focus"):
            bomb.throw(hero.facing, hero.vx, inputs.held("down"))
            self.look.show("thrown", bomb)

    def _burst(self, bomb):
        """Apply the explosion of a bomb: walls break, and near enemies are flattened. A near hero is thrown back
        unhurt.
        """
        x, y = bomb.place
        loose, hit = self.things.blast(x, y)
        self.feats.done["walls blown"] += bool(loose)
        self.look.burst(x, y, loose, hit)
        for enemy in list(self.things.enemies.values()):
            if hypot(enemy.character.position[0] - x, enemy.character.position[1] - y) < REACH:
                self._flatten(enemy)
        me = self.hero.character.position
        if self.phase == PLAYING and hypot(me[0] - x, me[1] - y) < REACH:
            self.hero.throw(1 if me[0] >= x else -1)
            self.look.hear(("thrown",))

    # --- events of the world -----------------------------------------------------------------------------------------

    def _read_events(self):
        events, things, me = self.world.events, self.things, self.hero.character.body.id
        for identity in sorted(others(events.sensor_end, me)):
            self.hero.ladders.pop(identity, None)
            if identity in things.lairs:
                things.lairs[identity].seen = False
        for identity in sorted(others(events.sensor_begin, me)):
            if identity in things.lairs:
                things.lairs[identity].seen = True
            elif identity in things.triggers:
                self._touch(things.triggers[identity])
        self._read_springs(events.sensor_begin)
        things.press_stones(self.hero.riding if self.phase == PLAYING else None, events.begin)
        self.touched |= others(events.begin, me) & things.enemies.keys()
        self.touched -= others(events.end, me)
        for identity in sorted(self.touched):
            if identity in things.enemies:
                self._meet(things.enemies[identity])
        for hit in events.hits[events.hits["speed"] > STRIKE]:
            self._strike(hit, me)
        self.mercy = max(self.mercy - 1, 0)

    def _read_springs(self, begun):
        """Throw up the crates that have landed on a spring. `begun`: sensor begin events of the step."""
        things = self.things
        for pair in zip(begun["body_a"].tolist(), begun["body_b"].tolist(), strict=True):
            for crate, spring in (pair, pair[::-1]):
                if crate in things.crate_ids and spring in things.triggers:
                    things.crate_ids[crate].launch()
                    things.triggers[spring].touched = self.ticks
                    self.look.threw(things.triggers[spring])
                    self.feats.done["crates thrown"] += 1

    def _strike(self, hit, me):
        """Process an impact of a crate. A strong impact from above flattens an enemy or hurts the hero.

        hit: row of the step's hit events; me: body id of the hero.
        """
        impulse, pair = float(hit["normal_impulse"]), (int(hit["body_a"]), int(hit["body_b"]))
        enemies = self.things.enemies
        self.look.struck(float(hit["point_x"]), float(hit["point_y"]), impulse)
        for identity, other, down in ((*pair, -hit["normal_y"]), (*reversed(pair), hit["normal_y"])):
            if impulse < CRUSHING or down < 0.7 or other in enemies:
                continue
            if identity in enemies:
                self.feats.done["crushed"] += 1
                self._flatten(enemies[identity])
            elif identity == me:
                self._hurt(self.hero.facing)

    def _flatten(self, enemy):
        if enemy.body.id in self.things.enemies:
            self.touched.discard(enemy.body.id)
            self.look.squashed(enemy)
            self.things.remove(enemy)

    def _touch(self, trigger):
        kind = trigger.kind
        trigger.touched = self.ticks
        if kind == "ladder":
            self.hero.ladders[trigger.body.id] = trigger
        elif self.phase != PLAYING:
            return
        elif kind == "goal":
            self.phase, self.since = WON, 0
            self.look.won(trigger)
        elif kind == "spikes":
            self._impale()
        elif kind in ("coin", "secret"):
            self.coins += kind == "coin"
            self.secrets += kind == "secret"
            self.things.take(trigger)
            self.look.took(trigger)
        elif kind == "spring":
            self.hero.launch()
            self.feats.done["springs"] += 1
            self.look.hear(("launch",))
        elif kind == "checkpoint" and not trigger.lit:
            trigger.lit = True
            x, bottom = trigger.foot
            self.spawn = (x, bottom - HEIGHT / 2)
            self.runner.remember()
            self.look.lit(trigger)

    def _meet(self, enemy):
        """Process a contact of the hero with an enemy: he stomps it, or it hurts him."""
        hero = self.hero
        if self.phase != PLAYING:
            return
        # The depth of the hero's feet one step before, because a fast fall must not count as a hit from the side.
        depth = hero.box[3] - hero.vy * STEP_SECONDS - enemy.top
        if enemy.stompable and hero.vy > 0.0 and depth <= STOMP_DEPTH:
            self._flatten(enemy)
            hero.bounce()
            self.stop = STOMP_STOP if self.assist["hit_stop"] else 0
            self.feats.done["stomps"] += 1
            self.look.hear(("stomp",))
        elif not self.mercy:
            self._hurt(1 if hero.character.position[0] >= enemy.character.position[0] else -1)

    def _hurt(self, away):
        """Let the hero lose a life. If the assist `invincible` is on, throw him to the side `away` (-1, 1) instead."""
        if self.phase != PLAYING or (self.mercy and self.assist["invincible"]):
            return
        if self.assist["invincible"]:
            self.mercy = steps(MERCY)
            self.hero.throw(away)
            self.look.hear(("thrown",))
        else:
            self._lose()

    def _impale(self):
        """Process a touch of spikes. The hero loses a life; if `invincible` is on, he is moved to safe
        ground instead.
        """
        if not self.assist["invincible"]:
            self._lose()
            return
        self.look.vanished()
        self.hero.place(self.safe)
        self.mercy = steps(MERCY)
        self.look.hear(("thrown",))

    def _lose(self):
        self.phase, self.since = HURT, 0
        self.deaths += 1
        self.stop = HIT_STOP if self.assist["hit_stop"] else 0
        self.look.hurt()

    def _start_life(self):
        self.phase, self.since, self.mercy = PLAYING, 0, steps(MERCY)
        self.hero.place(self.spawn)
        self.hero.facing = 1
        self.touched.clear()
        self.things.go_home()
        self.runner.start_again()
        self.look.arrive()

    def _result(self):
        things = self.things
        hurts = "not hurt" if not self.deaths else "hurt once" if self.deaths == 1 else f"hurt {self.deaths} times"
        return Result(
            True,
            self.coins * COIN_WORTH + self.secrets * SECRET_WORTH,
            self.clock * STEP_SECONDS,
            (
                f"coins {self.coins} of {things.coins_in_all}",
                f"secrets {self.secrets} of {things.secrets_in_all}",
                hurts,
            ),
        )

    # --- self-check, bot, replay, picture ----------------------------------------------------------------------------

    def check(self):
        """Return the goals that the bot must reach in the level, a list of Goal with deadlines."""
        return self.feats.goals()

    def bot(self):
        """Return the actions that the bot holds in the next step, a frozenset of names."""
        return self.runner.keys(self)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple. The world is hashed separately."""
        return (
            self.frame,
            self.ticks,
            self.phase,
            self.since,
            self.mercy,
            self.stop,
            self.coins,
            self.secrets,
            self.deaths,
            self.clock,
            *self.spawn,
            *self.safe,
            *self.hero.state(),
            *self.things.state(),
            *sorted(self.touched),
        )

    def draw(self, canvas, alpha):
        """Draw the scene. alpha: position (0..1) between the last two steps."""
        level_view(self.level).draw(self, canvas, 1.0 if self.stop else alpha)


def others(rows, identity):
    """Return the ids of all bodies that form a pair with the body `identity`, as a set.

    rows: a table of events, which contains the pairs.
    """
    a, b = rows["body_a"], rows["body_b"]
    return {*b[a == identity].tolist(), *a[b == identity].tolist()}
