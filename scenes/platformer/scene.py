"""The platformer: a hero, one level, and the rules between them."""

from game.loop import STEP_SECONDS
from game.scene import Goal, Scene
from physics import Effects
from scenes.platformer.hero import GRAVITY, HEIGHT, WIDTH, Hero, steps
from scenes.platformer.level import load_level
from scenes.platformer.look import Look
from scenes.platformer.runner import Runner
from scenes.platformer.things import Things
from scenes.platformer.view import level_view

MOURNING = 0.6               # [s] from the hurt to the next life: long enough to see why, short enough to try again
MERCY = 1.2                  # [s] in which walkers do not hurt a new life
APPLAUSE = 1.2               # [s] from the goal to its result
STRIKE = 60.0                # [px/s] slower is a crate that is pushed or rocks: two steps of gravity
CRUSHING = 120000.0          # [density px3/s] the large crate after a fall of a tile
STOMP_DEPTH = 9              # [px] feet this far below a walker's top still stomp it
PLAYING, HURT, WON = "playing", "hurt", "won"
CHECKPOINTS_DUE = (900, 1200, 1500, 2100, 2700, 3300)     # steps
FEATS = ("jumps", "wall_jumps", "drops", "springs", "stomps", "pushed", "ridden", "sloped", "slid")


class Platformer(Scene):
    """Keys move the hero; what he touches is read from the events of the step."""

    name = "platformer"
    title = "Platformer"
    about = "One level at dusk: run, jump, slide and kick off walls, ride, push and stomp your way to the flag."
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, continuous=True,
                      sleeping=True, sensors=True, one_way=True)
    pieces = ("boxes", "circles", "tiles", "masks", "characters")
    features = ("whole-pixel motion with slopes, planks and moving platforms", "coyote time, buffering, corner correction",
                "crates stack, topple, are pushed and ridden", "hits sound, shake and hurt by their impulse",
                "pick-ups are sensor events")
    actions = (("Arrows", "run"), ("Space", "jump"), ("Down + Space", "through planks"))
    broadphase = "hash"
    life_after = steps(MOURNING)

    def build(self):
        """The level and all in it."""
        self.level = load_level()
        self.add_world(gravity=(0.0, GRAVITY))
        self.level.add_to(self.world)
        start = self.level.map.one("hero_start")
        self.spawn = (start.x + start.width / 2, start.y + start.height - HEIGHT / 2)
        self.hero = Hero(self.world, self.level, self.spawn)
        self.things = Things(self.world, self.level, self.random)
        self.checkpoints = self.things.of("checkpoint")
        self.walkers_touched = set()
        self.phase, self.since, self.mercy = PLAYING, 0, 0
        self.coins = self.deaths = self.clock = self.inside_solid = 0
        self.feats = dict.fromkeys(FEATS, 0)
        self.furthest = 0.0
        self.runner = Runner()
        self.look = Look(self)

    def update(self, inputs):
        """Things move, the hero moves, the world steps, and what happened is read from it."""
        if self.phase == WON and self.since > steps(APPLAUSE) and (inputs.pressed("confirm") or inputs.pressed("jump")):
            self.restart()
            return
        self.look.begin_step()
        self._move_things()
        self._move_hero(inputs)
        self.world.step()
        self._read_events()
        self._count()
        self.since += 1
        if self.phase == HURT and self.since >= self.life_after:
            self._start_life()
        self.look.step(STEP_SECONDS)

    def _move_things(self):
        things = self.things
        for platform in things.platforms:
            platform.aim(self.frame)
        for walker in things.walkers.values():
            walker.step()

    def _move_hero(self, inputs):
        hero, things = self.hero, self.things
        hero.crates = things.crates
        hero.solids = things.crate_boxes + things.platform_boxes
        if self.phase == PLAYING:
            hero.step(inputs)
            self.clock += 1
        elif self.phase == WON:
            hero.rest()
        else:
            hero.news.clear()
            hero.before = hero.character.position
        self.look.hear(hero.news)
        if hero.crushed and self.phase == PLAYING:
            self._hurt()

    def _read_events(self):
        events, me = self.world.events, self.hero.character.body.id
        for identity in sorted(_others(events.sensor_begin, me)):
            self._touch(self.things.triggers[identity])
        self.walkers_touched |= _others(events.begin, me) & self.things.walkers.keys()
        self.walkers_touched -= _others(events.end, me)
        for identity in sorted(self.walkers_touched):
            self._meet(identity)
        for hit in events.hits[events.hits["speed"] > STRIKE]:
            self._strike(hit, me)
        self.mercy = max(self.mercy - 1, 0)

    def _strike(self, hit, me):
        """A crate hit something: how hard, its impulse says. A walker under it is flat, a hero under it is hurt."""
        impulse, pair = float(hit["normal_impulse"]), (int(hit["body_a"]), int(hit["body_b"]))
        self.look.struck(float(hit["point_x"]), float(hit["point_y"]), impulse)
        for identity, other, down in ((*pair, -hit["normal_y"]), (*reversed(pair), hit["normal_y"])):
            if impulse < CRUSHING or down < 0.7 or other in self.things.walkers:
                continue
            if identity in self.things.walkers:
                self._flatten(identity)
            elif identity == me and not self.mercy:
                self._hurt()

    def _flatten(self, identity):
        self.walkers_touched.discard(identity)
        self.look.squashed(self.things.walkers[identity])
        self.things.squash(identity)

    def _touch(self, trigger):
        trigger.touched = self.frame
        if trigger.kind == "goal" and self.phase == PLAYING:
            self.phase, self.since = WON, 0
            self.look.won(trigger)
        elif trigger.kind == "spikes":
            self._hurt()
        elif self.phase != PLAYING:
            return
        elif trigger.kind == "coin":
            self.coins += 1
            self.things.take(trigger)
            self.look.took_coin(trigger)
        elif trigger.kind == "spring":
            self.hero.launch()
            self.feats["springs"] += 1
            self.look.hear(("launch",))
        elif trigger.kind == "checkpoint" and not trigger.lit:
            trigger.lit = True
            x, bottom = trigger.foot
            self.spawn = (x, bottom - HEIGHT / 2)
            self.look.lit(trigger)

    def _meet(self, identity):
        """A walker's back is a step, its sides hurt."""
        hero, walker = self.hero, self.things.walkers[identity]
        if self.phase != PLAYING:
            return
        if hero.vy > 0.0 and hero.box[3] - walker.top <= STOMP_DEPTH:
            self._flatten(identity)
            hero.bounce()
            self.feats["stomps"] += 1
            self.look.hear(("stomp",))
        elif not self.mercy:
            self._hurt()

    def _hurt(self):
        if self.phase == PLAYING:
            self.phase, self.since = HURT, 0
            self.deaths += 1
            self.look.hurt()

    def _start_life(self):
        self.phase, self.since, self.mercy = PLAYING, 0, steps(MERCY)
        self.hero.place(self.spawn)
        self.hero.facing = 1
        self.things.go_home()
        self.look.arrive()

    # --- what the judge wants to know ----------------------------------------------------------------------------------

    def _count(self):
        hero, feats = self.hero, self.feats
        left, top, _, _ = hero.box
        self.inside_solid += self.level.blocks(left, top, WIDTH, HEIGHT)
        self.furthest = max(self.furthest, hero.character.position[0])
        for word, feat in (("jump", "jumps"), ("wall_jump", "wall_jumps"), ("drop", "drops")):
            feats[feat] += word in hero.news
        feats["pushed"] += any(abs(c.body.position[0] - c.home[0]) > 16 for c in self.things.crates)
        feats["ridden"] += any(hero.riding == platform.body for platform in self.things.platforms)
        feats["sloped"] += hero.grounded and hero.slope != 0.0
        feats["slid"] += hero.sliding != 0

    def check(self):
        """All that the level teaches, by when the bot is past it."""
        feats, lit = self.feats, [trigger.lit for trigger in self.checkpoints]
        reached = [Goal(f"checkpoint {number}", due, number <= len(lit) and lit[number - 1], f"at x {self.furthest:.0f}")
                   for number, due in enumerate(CHECKPOINTS_DUE, 1)]
        return [
            Goal("never inside a solid tile", 1, self.inside_solid == 0, f"{self.inside_solid} steps"),
            Goal("walked a slope", 480, feats["sloped"] > 20, f"{feats['sloped']} steps"),
            *reached,
            Goal("stomped or passed a walker", 900, feats["stomps"] > 0 or lit[0], f"{feats['stomps']} stomps"),
            Goal("dropped through a plank", 1200, feats["drops"] > 0),
            Goal("thrown by a spring", 1500, feats["springs"] > 0),
            Goal("pushed a crate", 1800, feats["pushed"] > 0),
            Goal("rode a platform", 2400, feats["ridden"] > 60, f"{feats['ridden']} steps"),
            Goal("kicked off walls", 3400, feats["wall_jumps"] > 2, f"{feats['wall_jumps']}"),
            Goal("coins", 3600, self.coins >= 40, f"{self.coins} of {self.things.coins_in_all}"),
            Goal("reached the goal", 3600, self.phase == WON, f"{self.phase} at x {self.furthest:.0f}"),
        ]

    def bot(self):
        """The scripted player."""
        return self.runner.keys(self)

    def state(self):
        """All that is not in the world."""
        return (self.frame, self.phase, self.since, self.mercy, self.coins, self.deaths, self.clock, *self.spawn,
                *self.hero.state(), *self.things.state(), *sorted(self.walkers_touched))

    def draw(self, canvas, alpha):
        """The picture."""
        level_view(self.level).draw(self, canvas, alpha)


def _others(rows, identity):
    """The bodies that share an event with `identity`."""
    a, b = rows["body_a"], rows["body_b"]
    return {*b[a == identity].tolist(), *a[b == identity].tolist()}
