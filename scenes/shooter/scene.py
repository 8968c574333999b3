"""The plane shooter's rules, which read hits, grazes, bomb blasts and pick-ups from the contact events of each step."""

import numpy as np
import pygame

from game.drawing.canvas import CANVAS_SIZE
from game.scene import STEP_SECONDS, Scene, Slider
from physics import Effects
from scenes.shooter.blows import Blow, Blows, push
from scenes.shooter.bomb import DAMAGE, LEADER_DAMAGE, SHELTER, Bomb
from scenes.shooter.bullets import Bullets, outside
from scenes.shooter.cast import FILTER_NAMES, FIRED, GROUND_SPEED, INCOMING, steps
from scenes.shooter.director import Director
from scenes.shooter.ending import Ending
from scenes.shooter.fleet import KINDS, Fleet, draw_turned
from scenes.shooter.goals import stage_goals
from scenes.shooter.hits import Hits, partners
from scenes.shooter.loot import Loot
from scenes.shooter.pilot import Pilot
from scenes.shooter.plane import MOST_LIVES, Plane
from scenes.shooter.score import Score
from scenes.shooter.spectacle import Spectacle
from scenes.shooter.stage import load_stage
from scenes.shooter.view import the_view
from scenes.shooter.wreckage import DRAG, STRIKE, Wreckage

FREEZE = 3  # steps that the game is frozen after a hit of the player or the end of a phase: 50 ms
LAST_MOMENT = 6  # steps after a hit in which a bomb still saves the plane
SWEEP_EVERY = 8  # steps between two checks for bodies outside the sky: removal costs per batch
ROOM = 1800  # number of bullets for which the tables have memory from the start
DROP_EVERY = 45  # kills between two power-ups that no enemy carried


class Shooter(Scene):
    """The shooter, a scene with one world.

    Collision filters define which bodies can collide; masks and circles decide whether they do.
    """

    name = "shooter"
    title = "Shooter"
    about = (
        "One stage, five kinds of planes, a boss. What your eye calls a miss is a miss: exact shapes decide every hit."
    )
    effects = Effects(rotation=True, drag=True, wind=True, sensors=True, carving=True)
    pieces = ("masks", "exact masks", "circles", "boxes", "queries")
    features = (
        "pixel masks and a small core: both are tested, you choose which hurts",
        "sensors: grazing, pick-ups, and a bomb that grows through the bullets",
        "filters: bullets never pair with bullets or with their own side",
        "carving: heavy planes break along cracks, and their pieces tumble",
        "bullets are rows, added and removed in batches: 1,500 at once",
    )
    filter_names = FILTER_NAMES
    actions = (("arrows", "fly"), ("Space", "fire"), ("Shift", "focus"), ("X", "bomb"))
    tiers = ("pixels", "obb", "aabb", "circle")
    broadphase = "sweep"  # bullets are spread over the whole sky: four times as fast as a grid with 1,500 of them
    sliders = (Slider("hurts", 0, 1, 0, choices=("core", "hull")),)
    hits_of = ""  # words before the numbers of hits, where the picture shows other hits too
    music = "shooter"
    field = pygame.Rect((0, 0), CANVAS_SIZE)  # part of the canvas that shows the game, for its texts and icons
    ranked_by = "points"
    assists = ("invincible", "hit_stop")
    takes_level = True
    level_suffix = ".json"

    def build(self):
        """Build the world with the player's plane, and all objects of the game. The director adds the enemies later."""
        draw_turned()
        self.music = type(self).music
        stage = load_stage(self.level_file)
        world = self.add_world(drag=DRAG, wind=(0.0, GROUND_SPEED), gravity=(0.0, 0.0))
        self.incoming, self.shots = Bullets(world, INCOMING), Bullets(world, FIRED)
        self.incoming.make_room(ROOM)
        self.fleet, self.loot, self.bomb = Fleet(world, self.tier), Loot(world), Bomb(world)
        self.plane = Plane(world, self.tier)
        self.wreckage = Wreckage(world)
        self.blows, self.hits = Blows(world), Hits()
        self.director, self.score, self.ending = Director(stage), Score(KINDS), Ending()
        self.pilot, self.spectacle = Pilot(), Spectacle(self)
        self.scrolled = self.scrolled_before = 0.0  # [px] motion of the ground, now and a step ago
        self.gone = []  # bodies to be removed when the next step begins
        self.hit_by = []  # ids of the bodies that hit the player; the plane is lost when `stricken` reaches 0
        self.hit_blow = Blow()  # strength of that hit
        self.freeze = self.stricken = self.since_drop = self.unknown = self.most_bullets = 0
        self.beaten = {"midboss": False, "boss": False}

    def set_tier(self, name):
        """Set the collision tier of all sprites, including those that are added later.

        name: kind of collision shape: "pixels", "obb", "aabb" or "circle".
        """
        super().set_tier(name)
        self.fleet.tier = self.plane.tier = name

    @property
    def target(self):
        """Position (x, y) [px] of the player's plane or, between two lives, the position at which it was lost."""
        return self.plane.x, self.plane.y

    @property
    def difficulty(self):
        """Current Difficulty of the stage."""
        return self.director.difficulty

    @property
    def hurts(self):
        """Part of the player's plane whose hits cost a life: "core" or "hull"."""
        return ("core", "hull")[int(self.values["hurts"])]

    @property
    def invincible(self):
        """True if hits do not destroy the player's plane, which the player chooses in the settings."""
        return self.assist["invincible"]

    @property
    def hit_stop(self):
        """True if the game is frozen for a moment after a hit, which the player chooses in the settings."""
        return self.assist["hit_stop"]

    @property
    def own_hits(self):
        """{part: number of hits so far} for three parts of the player's plane: "core", "hull" and "box"."""
        return self.hits.count

    @property
    def own_body(self):
        """Body id of the hull of the player's plane, or None while the plane cannot be hit."""
        return None if self.plane.ghost or self.plane.body is None else self.plane.body.id

    def update(self, inputs):
        """Let all objects choose their velocities, step the world, and read its events."""
        self.scrolled_before = self.scrolled
        self.spectacle.step(STEP_SECONDS)
        if self.ending.step(self, inputs):
            self.world.step(0.0)
            return
        if self.stricken:
            self._last_moment(inputs)
        if self.freeze:
            # No time passes, so that the contact is visible for a moment.
            self.freeze -= 1
            self.world.step(0.0)
            return
        self._sweep()
        self._choose(inputs)
        self.world.step()
        self._read_events()

    def _last_moment(self, inputs):
        """Make one of the steps between a hit and the loss of the plane, in which a bomb still saves it.

        After the last of these steps, the plane is lost.
        """
        self.stricken -= 1
        if inputs.pressed("bomb") and self.plane.bombs and self.bomb.body is None:
            self.stricken, self.freeze, self.hit_by = 0, 0, []
            self._drop_bomb()
        elif self.stricken == 0:
            self._lose_life()

    def _choose(self, inputs):
        plane = self.plane
        plane.step(inputs, self.shots)
        if plane.fired:
            self.spectacle.player_fires(plane)
        if inputs.pressed("bomb") and plane.here and not plane.entering and plane.bombs and self.bomb.body is None:
            self._drop_bomb()
        over = self.bomb.step()
        if over is not None:
            self.gone.append(over)
        self.director.step(self)
        self.fleet.step(self)
        self.loot.step(self.frame, plane)
        for identity, piece in self.wreckage.step():
            self.gone.append(identity)
            self.spectacle.piece_down(identity, piece)
        self.shots.launch()
        self.incoming.launch()
        self.scrolled += GROUND_SPEED * STEP_SECONDS
        self.most_bullets = max(self.most_bullets, len(self.incoming))
        if self.score.step(quiet=not len(self.fleet)):
            self.spectacle.chain_broken(plane)

    def _drop_bomb(self):
        plane = self.plane
        plane.bombs -= 1
        self.score.bombs += 1
        plane.shelter(SHELTER)
        self.bomb.drop(plane.x, plane.y)
        self.spectacle.bomb_dropped(self.bomb)

    def _read_events(self):
        """Read the events of the step. Bodies that are hit are removed only when the next step begins, for
        inspection.
        """
        parts = self.plane.bodies
        self.blows = Blows(self.world, {parts["core"].id: parts["hull"].mass} if parts else None)
        begun, met = self.world.events.begin, self.world.events.sensor_begin
        if len(begun):
            self._shots_that_hit(begun, begun["body_a"], begun["body_b"])
        if self.wreckage.pieces:
            self._pieces_that_strike(begun)
        if self.bomb.body is not None:
            self._blast(partners(met, self.bomb.body.id))
        if not self.plane.here:
            return
        self._take_loot(partners(met, self.plane.bodies["ring"].id))
        grazed = self.hits.read(self.world, self.plane, self.incoming, self.fleet)
        # An enemy or bullet that is destroyed in the same step does not hit the player.
        hit_by = [identity for identity in self.hits.now[self.hurts] if not self._is_lost(identity)]
        if hit_by and not self.stricken:
            self._hit(hit_by)
        elif len(grazed) and not self.stricken:
            self.spectacle.grazed(self.plane, self.world, grazed, self.score.graze(len(grazed)))

    def _is_lost(self, identity):
        """Return whether the body `identity` will be removed, or will break, when the next step begins."""
        return identity in self.gone or self.wreckage.is_marked(identity)

    def _hit(self, hit_by):
        if self.invincible:
            self.gone += [identity for identity in hit_by if identity not in self.fleet.planes]
            self.spectacle.hit_taken(self.plane)
            return
        self.hit_by, self.stricken = hit_by, LAST_MOMENT
        self.hit_blow = self.blows.on(self.plane.bodies[self.hurts].id, *hit_by)
        self.stop_time()
        self.spectacle.player_hit(self.plane, hit_by, LAST_MOMENT)

    def stop_time(self):
        """Freeze the game for FREEZE steps, unless `hit_stop` is off."""
        self.freeze = FREEZE if self.hit_stop else 0

    def _shots_that_hit(self, begun, a, b):
        shot_a, shot_b = self.shots.has(a), self.shots.has(b)
        rows = np.flatnonzero(shot_a | shot_b)
        shots, struck = np.where(shot_a, a, b)[rows], np.where(shot_a, b, a)[rows]
        # A shot strikes only one plane. If it touches several in one step, the first contact (smaller id) counts.
        _, first = np.unique(shots, return_index=True)
        for each in first.tolist():
            enemy = self.fleet.planes.get(int(struck[each]))
            if enemy is None or enemy.health <= 0.0:
                continue
            self.gone.append(int(shots[each]))
            place = begun["point_x"][rows[each]].item(), begun["point_y"][rows[each]].item()
            self._damage(enemy, self.blows.on(enemy.id, int(shots[each])), place)

    def _damage(self, enemy, blow, place, times=1.0):
        """Reduce the health of an enemy by the strength of the Blow `blow` multiplied by `times`, and show the result.

        place: the contact point (x, y) [px]. Health is measured in plain shots.
        """
        if enemy.leads and enemy.sheltered:
            self.spectacle.glanced(enemy, *place)
            return
        enemy.health -= blow.strength * times
        if enemy.health > 0.0:
            self.spectacle.struck(enemy, place[0], place[1], blow)
        elif enemy.leads:
            self.end_phase(enemy, beaten=True)
        else:
            self._destroy(enemy, blow, place)

    def _pieces_that_strike(self, begun):
        """Damage the small planes that are struck by pieces of wreckage. begun: the step's begin events."""
        for piece, enemy, place in self.wreckage.strikes(begun, self.fleet):
            if enemy.health > 0.0:
                self._damage(enemy, self.blows.on(enemy.id, piece), place, STRIKE)

    def _blast(self, met):
        """Remove the bullets and damage the planes that the bomb touches. met: ids of the bodies in contact with the
        bomb.
        """
        known = self.fleet.planes.keys() | self.gone
        self._burn([identity for identity in met if identity not in known])
        for identity in sorted(set(met) & self.fleet.planes.keys()):
            enemy = self.fleet.planes[identity]
            if enemy.health > 0.0 and self.bomb.strikes(identity):
                blow = push(enemy.x - self.bomb.x, enemy.y - self.bomb.y)
                self._damage(enemy, blow, (enemy.x, enemy.y), LEADER_DAMAGE if enemy.leads else DAMAGE)

    def _burn(self, bullets):
        """Remove bullets, and show sparks and add points for each of them. bullets: list of body ids."""
        if not len(bullets):
            return
        self.gone += bullets
        self.score.burn(len(bullets))
        rows, bodies = self.world.rows(bullets), self.world.bodies
        self.spectacle.bullets_burnt(bodies["x"][rows], bodies["y"][rows])

    def _destroy(self, enemy, blow, place):
        enemy.health = 0.0
        if enemy.heavy:
            self.wreckage.mark(enemy, place[0], place[1], blow)
        else:
            self.gone.append(enemy.id)
        self.spectacle.destroyed(enemy, self.score.kill(enemy), blow)
        if self.director.shot_down(enemy):
            self.spectacle.wave_done(enemy, self.score.whole_wave())
        self.since_drop += 1
        carries = enemy.carries
        if not carries and self.since_drop >= DROP_EVERY:
            self.since_drop, carries = 0, "power"
        if carries:
            self.loot.drop(carries, enemy.x, max(enemy.y, 8.0), self.frame)
            self.spectacle.loot_left(enemy.x, enemy.y)
        self._reward()

    def _reward(self):
        if self.score.earned_life() and self.plane.lives < MOST_LIVES:
            self.plane.lives += 1
            self.spectacle.life_won(self.plane)

    def _take_loot(self, met):
        for identity in sorted(set(met) & self.loot.items.keys()):
            what = self.loot.items[identity].what
            worth = self.score.take(self.plane.gain(what))
            self.spectacle.loot_taken(self.plane, what, worth)
            self.gone.append(identity)

    def _lose_life(self):
        """Take a life from the player: remove the player's plane and all enemy bullets.

        A small plane that has rammed the player is destroyed.
        """
        self.score.hit()
        self.spectacle.player_lost(self.plane, self.hit_blow)
        if self.plane.power > 1:
            self.loot.drop("power", self.plane.x, self.plane.y, self.frame, tossed=True)
        self.gone += self.plane.lose_life()
        for identity in self.hit_by:
            enemy = self.fleet.planes.get(identity)
            if enemy is not None and not enemy.heavy and enemy.health > 0.0:
                back = Blow(-self.hit_blow.x, -self.hit_blow.y, self.hit_blow.mass)
                self._destroy(enemy, back, (enemy.x, enemy.y))
        self.hit_by = []
        self.clear_bullets()

    def clear_bullets(self):
        """Remove all enemy bullets, and add points for each of them."""
        known = set(self.gone)
        self._burn([identity for identity in self.incoming.ids.tolist() if identity not in known])

    # --- leaders -----------------------------------------------------------------------------------------------------

    def warn(self, event):
        """Announce the mid-boss or boss of an Event, with its music and a warning."""
        self.music = "boss"
        self.spectacle.warning(event)

    def end_phase(self, leader, beaten):
        """End a phase of a boss fight. leader: the boss or mid-boss.

        beaten: True if the leader's health is gone, False if its time ran out.
        """
        left = leader.clock / max(steps(leader.phase.seconds), 1)
        worth = self.score.phase(leader.phase.bonus, left) if beaten else 0
        last = leader.last
        leader.end_phase(beaten)
        self.clear_bullets()
        self.stop_time()
        self.beaten[leader.kind] = last and beaten
        self.plane.shelter(steps(1.5 if not last else 4.0))
        self.spectacle.phase_over(leader, last, worth)
        self._reward()

    def bury(self, leader):
        """Break a burnt-out boss or mid-boss into pieces, and drop its item."""
        self.wreckage.mark(leader, leader.x, leader.y, Blow())
        self.spectacle.leader_gone(leader)
        self.loot.drop("life" if leader.kind == "midboss" else "power", leader.x, leader.y, self.frame)

    def leader_gone(self, event):
        """End the fight with a boss or mid-boss that is no longer in the game.

        After the boss, the stage ends. event: Event of the boss or mid-boss.
        """
        self.music = "shooter"
        if event.event == "boss":
            self.ending.clear(self)

    # --- bodies ------------------------------------------------------------------------------------------------------

    def _sweep(self):
        """Break the planes that are marked to break, and remove all bodies that were hit or are outside the picture."""
        for plane, x, y in self.wreckage.break_due(self.fleet):
            self.spectacle.broke(plane, x, y)
        bodies = self.world.bodies
        gone = np.array(self.gone, np.int64)
        if self.frame % SWEEP_EVERY == 0:
            gone = np.concatenate([gone, bodies["id"][outside(bodies["x"], bodies["y"])]])
        self.gone.clear()
        if not len(gone):
            return
        gone = np.unique(gone)
        groups = (self.shots, self.incoming, self.fleet, self.loot, self.wreckage)
        for group in groups:
            group.forget(gone)
        self.world.remove_bodies(gone)
        known = sum(len(group) for group in groups) + len(self.plane.bodies) + (self.bomb.body is not None)
        self.unknown = max(self.unknown, abs(len(self.world.bodies) - known))

    # --- self-check, bot and replay ----------------------------------------------------------------------------------

    def check(self):
        """Return the goals that the bot must reach in the stage, a list of Goal."""
        return stage_goals(self)

    def bot(self):
        """Return the actions that the bot holds in the next step, a frozenset of names."""
        return self.pilot.keys(self)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple. The world is hashed separately."""
        planes = [value for plane in self.fleet.planes.values() for value in plane.state()]
        parts = (self.plane, self.score, self.director, self.hits, self.bomb, self.loot, self.ending, self.wreckage)
        return (
            self.frame,
            self.freeze,
            self.stricken,
            self.since_drop,
            self.unknown,
            self.most_bullets,
            self.scrolled,
            self.fleet.longest,
            self.hurts,
            self.music,
            *self.assist.values(),
            *self.beaten.values(),
            *planes,
            *(value for part in parts for value in part.state()),
            self.shots.state(),
            self.incoming.state(),
            *self.gone,
            *self.hit_by,
            self.hit_blow.x,
            self.hit_blow.y,
            self.hit_blow.mass,
        )

    def draw(self, canvas, alpha):
        """Draw the scene on the canvas. alpha: position (0..1) between the last two steps."""
        the_view().draw(self, canvas, alpha)
