"""The lander's rules. The damage by an impact follows from the contact impulse that the solver reports."""

from game.scene import STEP_SECONDS, Scene, Slider
from physics import Effects
from scenes.lander.course import Course
from scenes.lander.feel import BLAST, CRASH_BLAST, DRAG, FILTER_NAMES, GRAVITY, SHIP_MASS
from scenes.lander.gaze import Gaze
from scenes.lander.goals import goals
from scenes.lander.ground import Ground
from scenes.lander.gun import Gun, blown
from scenes.lander.line import Line
from scenes.lander.moon import the_moon
from scenes.lander.pilot import Pilot
from scenes.lander.score import Score
from scenes.lander.ship import Ship
from scenes.lander.spectacle import Spectacle
from scenes.lander.view import the_view
from scenes.lander.weather import Weather
from scenes.lander.yard import Yard


class Lander(Scene):
    """The lander, a scene with one world. The player steers the ship."""

    name = "lander"
    title = "Lander"
    about = "Three sites on a frozen moon: a canyon, a cave that you blast open, a mesa in the storm. Land softly."
    effects = Effects(
        response=True,
        gravity=True,
        drag=True,
        wind=True,
        rotation=True,
        friction=True,
        restitution=True,
        stacking=True,
        continuous=True,
        sleeping=True,
        sensors=True,
        joints=True,
        carving=True,
    )
    pieces = ("masks", "circles", "boxes", "capsules")
    features = (
        "the ship's own pixels are its body, so are moon, pads, cargo and rocks",
        "ground of 4,096 x 1,024 pixels with caves and overhangs, one body",
        "shells and wrecks carve craters; what comes loose falls, rolls and can be carried away",
        "damage by the impulse of each knock",
        "cargo on a rope that bends around rock and tears",
        "gravity, thin air and gusts",
    )
    filter_names = FILTER_NAMES
    actions = (("Arrows", "turn, thrust"), ("Space", "fire"), ("X", "line"))
    broadphase = "tree"
    sliders = (Slider("gravity", 20, 70, GRAVITY, "px/s2"),)
    music = "lander"
    ranked_by = "points"
    assists = ("invincible",)

    def build(self):
        """Build the moon with its pads, cargo and rocks, and a ship on the base."""
        self.moon = the_moon()
        world = self.add_world(gravity=(0.0, self.values["gravity"]), drag=DRAG)
        self.ground = Ground(world, self.moon)
        self.yard = Yard(world, self.moon)
        self.ship = Ship(world, self.moon)
        self.gun, self.line = Gun(world), Line(world)
        self.weather = Weather(self.random, self.moon)
        self.course, self.score = Course(self.moon), Score()
        self.pilot, self.gaze = Pilot(), Gaze(self.camera, self.ship, self.moon)
        self.spectacle = Spectacle(self)
        self.gone = []  # ids of bodies that are removed when the next step begins

    def change_slider(self, name, value):
        """Set the slider `name` to `value`. The slider of the gravity changes the world's gravity at once."""
        super().change_slider(name, value)
        if self.world.effects.gravity:
            self.world.gravity = (0.0, self.values["gravity"])

    # --- the step ----------------------------------------------------------------------------------------------------

    def update(self, inputs):
        """Remove bodies that are due, steer the ship, step the world, and read its events."""
        self._sweep()
        ship = self.ship
        if ship.here and not self.course.over:
            self._steer(inputs)
        elif not ship.here and ship.wait():
            self.spectacle.arrived()
        self.weather.step(self.frame * STEP_SECONDS, ship.x, ship.y)
        self.weather.blow(self.world, *self._in_the_air())
        self.gone += self.gun.step()
        self.world.step()
        self.line.read()
        if self.line.torn:
            self.spectacle.line_torn()
        self._read_events()
        ship.read()
        self.course.step(self)
        self.gaze.step(STEP_SECONDS)
        self.spectacle.step(STEP_SECONDS)

    def _sweep(self):
        for identity in dict.fromkeys(self.gone):
            self._forget(identity)
            self.gun.shells.pop(identity, None)
            self.world.remove_body(identity)
        self.gone = []

    def _steer(self, inputs):
        ship = self.ship
        ship.steer(inputs)
        if ship.fires(inputs):
            self.gun.fire(ship)
            self.score.fired += 1
            self.spectacle.fired()
        if inputs.pressed("bomb"):
            self.spectacle.line_used(self.line.toggle(ship, self.yard.light()))

    def _in_the_air(self):
        """Return the bodies that gusts push: the ship, unless it rests on the ground, and the line's load."""
        ship, load = self.ship, self.line.load
        flying = ship.here and (ship.thrusting or not ship.quiet)
        return [body for body, blown_at in ((ship.body, flying), (load, load is not None)) if blown_at]

    def _read_events(self):
        events, me = self.world.events, self.ship.body.id if self.ship.here else None
        if me is not None:
            begun = others(events.begin, me)
            if begun - self.ship.touching:
                self.course.touched(self.ship.speed)  # the speed before this step
            self.ship.touching |= begun
            self.ship.touching -= others(events.end, me)
            for identity in sorted(others(events.sensor_begin, me) & self.yard.cans.keys()):
                self._take_can(identity)
        self.yard.meet(events.sensor_begin, events.sensor_end)
        self._knocks(events.hits)
        for identity, (x, y) in self.gun.bursts(events.begin).items():
            if identity not in self.gone:
                self.gone.append(identity)
                self.blast(x, y, BLAST)
        held = -1 if self.line.load is None else self.line.load.id
        for identity in self.yard.delivered(held):
            self._deliver(identity)
        if self.ship.here and self.ship.hull <= 0.0:
            self._crash()

    def _knocks(self, hits):
        """Process the impacts of a step on ship, cargo and rocks. hits: the step's hit events.

        The damage depends on the change of velocity [px/s], which is impulse / mass.
        """
        columns = (hits[name].tolist() for name in ("body_a", "body_b", "point_x", "point_y", "normal_impulse"))
        for a, b, x, y, impulse in zip(*columns, strict=True):
            for identity in (a, b):
                if self.ship.here and identity == self.ship.body.id:
                    self._hurt(impulse / SHIP_MASS, x, y)
                elif identity in self.yard.cargo:
                    self._shake(identity, impulse / self.yard.cargo[identity].body.mass, x, y)
                elif identity in self.yard.rubble.pieces:
                    self.spectacle.rock_knocked(x, y, impulse)

    def _hurt(self, change, x, y):
        cost = self.ship.knock(change)
        if self.assist["invincible"]:
            self.ship.hull = max(self.ship.hull, 1.0)
        self.spectacle.ship_knocked(x, y, change, cost)

    def _shake(self, identity, change, x, y):
        piece = self.yard.cargo[identity]
        cost = piece.knock(change)
        self.spectacle.cargo_knocked(piece, x, y, change, cost)
        if piece.whole <= 0.0 and identity not in self.gone:
            self.gone.append(identity)
            del self.yard.cargo[identity]
            self.spectacle.cargo_lost(piece)

    # --- events of the game ------------------------------------------------------------------------------------------

    def pad_below(self):
        """Return the Pad on which the ship stands, or None."""
        return next((self.yard.pads[each] for each in sorted(self.ship.touching) if each in self.yard.pads), None)

    def blast(self, x, y, radius):
        """Make an explosion at (x, y) [px]: carve a crater of `radius` [px], and push and damage near bodies."""
        self.spectacle.blast(x, y, radius)
        rubble = self.yard.rubble
        for identity in rubble.carve(x, y, radius):
            self._forget(identity)
        rubble.add_ground(self.ground.carve(x, y, radius))
        for body in self.yard.loose():
            vx, vy, speed = blown(body, x, y)
            if speed:
                body.apply_impulse((vx * body.mass, vy * body.mass))
                if body.id in self.yard.cargo:
                    self._shake(body.id, speed, body.center.x, body.center.y)
        if self.ship.here:
            vx, vy, speed = blown(self.ship.body, x, y)
            if speed:
                self.ship.body.apply_impulse((vx * SHIP_MASS, vy * SHIP_MASS))
                self._hurt(speed, self.ship.x, self.ship.y)

    def _forget(self, identity):
        """Remove the references of line and ship to the body `identity`, which is about to be removed."""
        self.line.drop(identity)
        self.ship.touching.discard(identity)

    def give_up(self):
        """Destroy the ship, which is stranded without fuel."""
        self.spectacle.stranded()
        self.ship.hull = 0.0
        self._crash()

    def _crash(self):
        ship = self.ship
        x, y = ship.body.center
        self.gone.append(ship.lose())
        self.line.let_go()
        self.score.lost += 1
        self.spectacle.ship_lost(x, y)
        self.blast(x, y, CRASH_BLAST)

    def _take_can(self, identity):
        if identity not in self.gone:
            x, y = self.yard.cans.pop(identity)
            self.gone.append(identity)
            self.ship.refuel()
            self.spectacle.can_taken(x, y, self.score.take_can())

    def _deliver(self, identity):
        piece = self.yard.cargo.pop(identity)
        self.gone.append(identity)
        self.spectacle.delivered(piece, self.score.deliver(piece.whole))

    # --- self-check, bot and replay ----------------------------------------------------------------------------------

    def check(self):
        """Return the goals that the bot must reach, a list of Goal, such as landings at all three sites."""
        return goals(self)

    def bot(self):
        """Return the actions that the bot holds in the next step, a frozenset of names."""
        return self.pilot.keys(self)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple. The world is hashed separately."""
        parts = (self.ship, self.course, self.score, self.gun, self.line, self.weather, self.yard, self.ground)
        return (
            self.frame,
            *self.assist.values(),
            *self.values.values(),
            *(value for part in parts for value in part.state()),
            *self.gone,
        )

    def draw(self, canvas, alpha):
        """Draw the scene on the canvas. alpha: position (0..1) between the last two steps."""
        the_view().draw(self, canvas, alpha)


def others(rows, identity):
    """Return the ids of all bodies that form a pair with the body `identity`, as a set.

    rows: a table of events, which contains the pairs.
    """
    a, b = rows["body_a"], rows["body_b"]
    return {*b[a == identity].tolist(), *a[b == identity].tolist()}
