"""The plane shooter: rules. Every hit is read from the events of the step, and each is pixels that share a place."""

import numpy as np

from game.loop import STEP_SECONDS
from game.scene import Goal, Scene
from physics import Effects
from scenes.shooter.blows import Blows
from scenes.shooter.bullets import Bullets, outside
from scenes.shooter.cast import FIRED, INCOMING, steps
from scenes.shooter.close_call import close_calls
from scenes.shooter.enemies import KINDS, Fleet, draw_turned
from scenes.shooter.loot import Loot
from scenes.shooter.pilot import Pilot
from scenes.shooter.plane import MOST_LIVES, Plane
from scenes.shooter.score import Score
from scenes.shooter.spectacle import Spectacle
from scenes.shooter.view import the_view
from scenes.shooter.waves import Director

FREEZE = 4                    # steps that the game stands still when the player is hit: 67 ms are felt, not noticed
RESTART_AFTER = steps(1.2)    # steps of game over before a key starts anew: nobody skips it by firing
SURVIVE = 3600                # steps that the bot is to survive
DROP_EVERY = 22               # kills between two power-ups that nobody carried


class Shooter(Scene):
    """Keys move the plane; filters say who may meet; masks say who did."""

    name = "shooter"
    title = "Shooter"
    about = "Endless waves of planes over the sea. What your eye calls a miss is a miss: pixels decide every hit."
    effects = Effects(sensors=True)
    pieces = ("masks", "circles", "boxes", "queries")
    features = ("pixel masks decide every hit", "filters: bullets never pair with bullets or with their own side",
                "a near miss, boxes without pixels, is worth points", "bullets are rows, added and removed in batches")
    actions = (("arrows", "fly"), ("Space", "fire"), ("Shift", "focus"))
    tiers = ("pixels", "obb", "aabb", "circle")
    broadphase = "hash"

    def build(self):
        """An empty sky, and you."""
        draw_turned()
        world = self.add_world()
        self.incoming, self.shots = Bullets(world, INCOMING), Bullets(world, FIRED)
        self.fleet, self.loot = Fleet(world, self.tier), Loot(world)
        self.plane = Plane(world, self.tier)
        self.blows = Blows(world)
        self.director, self.score = Director(), Score(KINDS)
        self.pilot, self.spectacle = Pilot(), Spectacle(self)
        self.near = set()            # bodies whose box overlaps the player's now, without a hit
        self.gone = []               # bodies that go when the next step begins
        self.hit_by = []             # what hit the player, while all stands still
        self.freeze = self.over = self.since_drop = self.unknown = 0
        self.survived = False

    def set_tier(self, name):
        """Test all sprites at another tier, also those that come later."""
        super().set_tier(name)
        self.fleet.tier = self.plane.tier = name

    # --- what enemies ask for ------------------------------------------------------------------------------------------

    @property
    def target(self):
        """Where the player is, or was last [px]."""
        return self.plane.x, self.plane.y

    @property
    def pace(self):
        """How hard it is now."""
        return self.director.pace

    # --- the step ------------------------------------------------------------------------------------------------------

    def update(self, inputs):
        """All choose their velocities, the world steps, and what happened is read from it."""
        if self.over > RESTART_AFTER and (inputs.pressed("confirm") or inputs.pressed("fire")):
            self.restart()
            return
        self.spectacle.step(STEP_SECONDS)
        if self.freeze:
            self._stand_still()
            return
        self._sweep()
        self._choose(inputs)
        self.world.step()
        self._read_events()
        self.over += self.plane.lives == 0
        self.survived |= self.frame + 1 >= SURVIVE and not self.over

    def _stand_still(self):
        """No time passes: for a moment everybody sees which pixels met. Then the plane is lost."""
        self.freeze -= 1
        self.world.step(0.0)
        if self.freeze == 0:
            self._lose_life()

    def _choose(self, inputs):
        plane, wave = self.plane, self.director.number
        plane.step(inputs, self.shots)
        if plane.fired:
            self.spectacle.player_fires(plane)
        self.director.step(self.fleet, self.random)
        if self.director.number != wave:
            self.spectacle.wave(self.director.number)
        self.fleet.step(self)
        self.loot.step(self.frame, plane)
        self.shots.launch(self.tier)
        self.incoming.launch(self.tier)

    def _read_events(self):
        """Who hit whom in this step. What goes stays until the next step begins: hits can be looked at."""
        begun = self.world.events.begin
        self.blows = Blows(self.world)
        a, b = begun["body_a"], begun["body_b"]
        self._shots_that_hit(begun, a, b)
        me = self.plane.body
        if me is None:
            self.near = set()
            return
        self._take_loot(self.world.events.sensor_begin)
        hit_by = np.concatenate([b[a == me.id], a[b == me.id]])
        # A plane that a shot brought down in this very step hits nobody any more: in doubt, for the player.
        self.hit_by = hit_by[~np.isin(hit_by, self.gone)].tolist()
        if self.hit_by:
            self.near = set()
            self.freeze = FREEZE
            self.spectacle.player_hit(self.plane, self.hit_by, FREEZE)
        else:
            self._count_near_misses(me.id)

    def _shots_that_hit(self, begun, a, b):
        shot_a, shot_b = np.isin(a, self.shots.ids), np.isin(b, self.shots.ids)
        rows = np.flatnonzero(shot_a | shot_b)
        shots, struck = np.where(shot_a, a, b)[rows], np.where(shot_a, b, a)[rows]
        # One shot strikes one plane: of several in the same step, that of the smaller id.
        _, first = np.unique(shots, return_index=True)
        for each in first.tolist():
            enemy = self.fleet.planes.get(int(struck[each]))
            if enemy is None or enemy.health <= 0:
                continue
            self.gone.append(int(shots[each]))
            enemy.health -= 1
            blow = self.blows.on(enemy.id, int(shots[each]))
            if enemy.health > 0:
                self.spectacle.struck(enemy, begun["point_x"][rows[each]].item(), begun["point_y"][rows[each]].item(), blow)
            else:
                self._destroy(enemy, blow)

    def _destroy(self, enemy, blow):
        self.gone.append(enemy.id)
        self.spectacle.destroyed(enemy, self.score.kill(enemy), blow)
        self.since_drop += 1
        if enemy.carries or self.since_drop >= DROP_EVERY:
            self.since_drop = 0
            self.loot.drop(enemy.x, max(enemy.y, 8.0), self.frame, self.tier)
            self.spectacle.loot_left(enemy.x, enemy.y)
        if self.score.earned_life() and self.plane.lives < MOST_LIVES:
            self.plane.lives += 1
            self.spectacle.life_won(self.plane)

    def _take_loot(self, met):
        for identity in sorted({*met["body_a"].tolist(), *met["body_b"].tolist()} & self.loot.born.keys()):
            bonus = self.score.take(self.plane.strengthen())
            self.spectacle.loot_taken(self.plane.x, self.plane.y, str(bonus) if bonus else "POWER UP")
            self.gone.append(identity)

    def _lose_life(self):
        """The plane is lost, with what rammed it and all bullets in the air."""
        self.score.hit()
        me = self.plane.body.id
        self.spectacle.player_lost(self.plane, self.blows.on(me, *self.hit_by))
        self.gone.append(self.plane.lose_life())
        for identity in self.hit_by:
            enemy = self.fleet.planes.get(identity)
            if enemy is not None and enemy.kind != "gunship":
                self._destroy(enemy, self.blows.on(identity, me))
        bodies, rows = self.world.bodies, self.incoming.places()
        self.spectacle.bullets_burnt(zip(bodies["x"][rows].tolist(), bodies["y"][rows].tolist(), strict=True))
        self.gone += self.incoming.ids.tolist()

    def _count_near_misses(self, me):
        now = close_calls(self.world, me)
        passed = sorted(self.near - now - set(self.gone))
        self.near = now
        for identity in passed:
            if identity not in self.fleet.planes and identity not in self.incoming.ids:
                continue
            x, y = self.world.body(identity).position
            self.score.near_miss()
            self.spectacle.near_miss(x, y, self.plane.x, self.plane.y)

    def _sweep(self):
        """Remove, in one batch, all that was hit and all that has left the sky."""
        bodies = self.world.bodies
        strays = bodies["id"][outside(bodies["x"], bodies["y"])]
        gone = np.unique(np.concatenate([self.gone, strays]).astype(np.int64))
        self.gone.clear()
        groups = (self.shots, self.incoming, self.fleet, self.loot)
        for group in groups:
            group.forget(gone)
        self.world.remove_bodies(gone)
        known = sum(len(group) for group in groups) + (self.plane.body is not None)
        self.unknown = max(self.unknown, abs(len(self.world.bodies) - known))

    # --- what the judge wants to know ----------------------------------------------------------------------------------

    def check(self):
        """A minute of play by the bot: all kinds fought, something taken, something missed, nothing left behind."""
        score, fleet = self.score, self.fleet
        # Where boxes decide, a box that overlaps is a hit: there is nothing to miss nearly.
        boxes_decide = self.tier == "aabb" or not self.narrowphase
        return [
            *(Goal(f"shot down a {kind}", due, score.kills[kind] > 0, f"{score.kills[kind]}")
              for kind, due in (("dart", 600), ("saucer", 1200), ("gunship", 2400))),
            Goal("a power-up taken", 2400, score.taken > 0, f"{score.taken}"),
            Goal("a near miss: boxes overlap, pixels do not", 3000, score.close > 0 or boxes_decide, f"{score.close}"),
            Goal("survived a minute", SURVIVE, self.survived, f"{self.plane.lives} lives left, {score.hits} hits"),
            Goal("no enemy stays for ever", 1, fleet.longest < steps(40), f"the longest {fleet.longest / 60:.0f} s"),
            Goal("every body in the world is in the game", 1, self.unknown == 0, f"{self.unknown} are not"),
        ]

    def bot(self):
        """The scripted player."""
        return self.pilot.keys(self)

    def state(self):
        """All that is not in the world."""
        planes = [value for plane in self.fleet.planes.values() for value in plane.state()]
        return (self.frame, self.freeze, self.over, self.since_drop, self.survived, self.unknown, self.fleet.longest,
                *self.plane.state(), *self.score.state(), *self.director.state(), *planes, *self.loot.born,
                *self.shots.ids.tolist(), *self.incoming.ids.tolist(), *sorted(self.near), *self.gone, *self.hit_by)

    def draw(self, canvas, alpha):
        """The picture."""
        the_view().draw(self, canvas, alpha)
