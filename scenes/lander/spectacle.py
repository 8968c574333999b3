"""Visual effects and sounds of the lander. They never influence the game rules."""

from math import cos, pi, sin

from scenes.lander.feel import HARMLESS, HULL, LOW_FUEL, WARN_HEIGHT, WARN_SPEED, steps
from scenes.shooter.fireworks import BLUE, DUST, FIRE, GOLD, SPARK, VAPOUR, Fireworks

SNOW = ((246, 250, 255), (214, 226, 246), (160, 178, 214), (98, 112, 156))
ICE = ((240, 255, 255), (170, 240, 246), (90, 190, 220), (44, 110, 160))
STONE = ((150, 158, 190), (104, 112, 148), (70, 76, 110), (44, 46, 74))
BELL = 13.0  # [px] from the ship's middle to the engine's bell
DOWNWASH = 64.0  # [px] distance from the bell within which the exhaust raises dust from the ground
HUM = 7  # steps between two starts of the engine's sound
BEEPS = steps(1.1)  # steps between two beeps at low fuel
ALARMS = steps(0.34)  # steps between two sounds of the alarm
KNOCK = 9.0  # [px/s] change of velocity below which an impact is silent
SMOKES = 45.0  # hull below which the ship smokes
TINT = {"good": (170, 255, 190), "gold": (255, 226, 120), "bad": (255, 140, 120), "cold": (150, 226, 255)}


class Spectacle:
    """Visible and audible effects of the lander.

    works: moving decoration (explosions, debris, texts); other attributes are timers. Each method from act_begins() on
    shows one kind of event by pictures and sound.
    """

    def __init__(self, scene):
        self.scene = scene
        self.works = Fireworks(scene.particles)
        self.random = scene.particles.random
        self.time = 0.0
        self.gusted = 0.0  # [px] distance that the wind has carried the snow
        self.act_since = 0  # steps since the act began
        self.lit = 0  # remaining steps in which the ship is white after an impact
        self.pulse = self.gain = 0.0  # pulse of the score when it grows, of a bar when it is filled, 1..0
        self.shelter = 0.0  # 0 outside .. 1 deep in a cave
        self.height = WARN_HEIGHT  # [px] from the ship's feet to the ground, up to a limit

    def step(self, dt):
        """Make one step of `dt` [s] of all effects."""
        scene, ship = self.scene, self.scene.ship
        self.time += dt
        self.act_since += 1
        self.gusted += scene.weather.wind * dt
        self.lit = max(self.lit - 1, 0)
        self.pulse, self.gain = max(0.0, self.pulse - 4.0 * dt), max(0.0, self.gain - 3.0 * dt)
        inside = scene.moon.is_inside(ship.x, ship.y)
        self.shelter += ((1.0 if inside else 0.0) - self.shelter) * 0.04
        if ship.here:
            self._engine(ship)
            self._warnings(ship)
            if ship.hull < SMOKES and scene.frame % 9 == 0:
                self.works.burst(
                    "smoke", ship.x, ship.y - 4, self.random.uniform(-6, 6) + scene.weather.wind * 0.1, -20.0
                )
        self.works.step(dt)

    def _engine(self, ship):
        """Emit the engine's fire, and dust from ground that the exhaust reaches.

        Also measure the ship's height above the ground.
        """
        scene = self.scene
        x, y = ship.nose
        self.height = scene.ground.clear_way(ship.x, ship.y + 17.0, 0.0, 1.0, WARN_HEIGHT)
        if not ship.thrusting:
            if ship.turning and scene.frame % 2 == 0:
                self._jet(ship, -ship.turning)
            return
        if scene.frame % HUM == 0:
            scene.play("thrust", self._at(ship.x), 0.42)
        foot_x, foot_y = ship.x - BELL * x, ship.y - BELL * y
        scene.particles.burst(
            foot_x,
            foot_y,
            2,
            FIRE,
            speed=(90, 190),
            life=(0.12, 0.34),
            angle=ship.angle + pi / 2,
            spread=0.5,
            size=(1, 2),
            carry=(ship.vx, ship.vy),
            drag=2.5,
        )
        far = scene.ground.clear_way(foot_x, foot_y, -x, -y, DOWNWASH)
        if far < DOWNWASH:
            at_x, at_y = foot_x - x * far, foot_y - y * far
            strength = 1.0 - far / DOWNWASH
            for side in (-1, 1):
                scene.particles.burst(
                    at_x,
                    at_y - 1,
                    1 + round(3 * strength),
                    SNOW if not scene.moon.is_inside(at_x, at_y - 8) else STONE,
                    speed=(20, 40 + 150 * strength),
                    life=(0.25, 0.9),
                    angle=(-0.35 if side > 0 else pi + 0.35),
                    spread=0.9,
                    size=(1, 2),
                    drag=2.4,
                    carry=(scene.weather.wind * 0.2, 0.0),
                )

    def _jet(self, ship, side):
        """Emit a puff of one of the small jets that rotate the ship. side: side of the ship, -1 left, 1 right."""
        across, down = cos(ship.angle), sin(ship.angle)
        self.scene.particles.burst(
            ship.x + 9 * side * across + 6 * down,
            ship.y + 9 * side * down - 6 * across,
            1,
            VAPOUR,
            speed=(50, 90),
            life=(0.1, 0.25),
            angle=ship.angle + (0.0 if side > 0 else pi),
            spread=0.5,
            size=(1, 1),
            carry=(ship.vx, ship.vy),
        )

    def _warnings(self, ship):
        scene = self.scene
        if scene.course.over:
            return
        if ship.fuel < LOW_FUEL and scene.frame % BEEPS == 0 and not scene.course.rest:
            scene.play("low_fuel", volume=0.5)
        if self.sinking and scene.frame % ALARMS == 0:
            scene.play("alarm", volume=0.45)

    @property
    def sinking(self):
        """True if the ship sinks too fast near the ground, so that the alarm sounds."""
        return self.scene.ship.here and self.scene.ship.vy > WARN_SPEED and self.height < WARN_HEIGHT

    def _at(self, x):
        """Return the canvas x of a world x [px], for the stereo position of a sound."""
        return x - self.scene.camera.x

    # --- the course --------------------------------------------------------------------------------------------------

    def act_begins(self):
        """Start the announcement of the next landing site."""
        self.act_since = 0

    def landed(self, pad, last):
        """Show a landing on a pad. last: whether this is the last landing site."""
        scene = self.scene
        self.pulse = 1.0
        for share in (-0.45, -0.2, 0.2, 0.45):
            self.works.sparks(pad.x + share * pad.width, pad.y - 2, 18, GOLD, 170)
        self.works.ring(scene.ship.x, pad.y, 120.0 if last else 70.0)
        scene.flash.start(0.4 if last else 0.2, (255, 236, 190))
        scene.play("touchdown", volume=0.9)

    def served(self, rest):
        """Show that the ship is refuelled, repaired or rearmed on a pad. rest: number of steps at rest on the pad."""
        self.gain = 1.0
        if rest % 12 == 0:
            self.scene.play("blip", self._at(self.scene.ship.x), 0.16)

    def arrived(self):
        """Show that the next ship has appeared on the pad."""
        ship = self.scene.ship
        self.works.ring(ship.x, ship.y, 50.0)
        self.works.sparks(ship.x, ship.y, 30, BLUE, 130)
        self.scene.play("powerup", volume=0.5)

    # --- knocks ------------------------------------------------------------------------------------------------------

    def ship_knocked(self, x, y, change, cost):
        """Show an impact of the ship at (x, y) [px]. A harder impact gives more and louder effects.

        change: change of the ship's velocity [px/s]; cost: loss of hull.
        """
        if change < KNOCK:
            return
        scene = self.scene
        strength = min(change / 120.0, 1.0)
        scene.particles.burst(
            x,
            y,
            round(4 + 16 * strength),
            SNOW,
            speed=(15, 50 + 90 * strength),
            life=(0.2, 0.7),
            angle=-pi / 2,
            spread=2.6,
            gravity=60.0,
        )
        if cost > 0.0:
            self.lit = 5
            self.works.sparks(x, y, round(8 + 30 * strength), SPARK, round(120 + 160 * strength))
            self.works.word(f"-{cost:.0f} HULL", scene.ship.x, scene.ship.y - 26, TINT["bad"])
            scene.camera.shake(0.15 + 0.4 * strength)
            scene.play("clank", self._at(x), 0.35 + 0.6 * strength)
        else:
            scene.play("land", self._at(x), 0.3 + 0.5 * min(change / HARMLESS, 1.0))

    def cargo_knocked(self, piece, x, y, change, cost):
        """Show an impact of a piece of cargo at (x, y) [px].

        change: change of the cargo's velocity [px/s]; cost: loss of its condition (of 100).
        """
        if change < KNOCK:
            return
        self.scene.particles.burst(
            x, y, 4, SNOW, speed=(10, 50), life=(0.2, 0.5), angle=-pi / 2, spread=2.4, gravity=60.0
        )
        self.scene.play("crate", self._at(x), min(0.15 + change / 160.0, 0.8))
        if cost > 1.0:
            self.works.sparks(x, y, 8, SPARK, 110)
            self.works.word(f"CARGO {piece.whole:.0f}%", piece.body.center.x, piece.body.center.y - 16, TINT["bad"])

    def rock_knocked(self, x, y, impulse):
        """Show an impact of a rock or of a piece of ground at (x, y) [px], in proportion to its impulse."""
        strength = min(impulse / 30000.0, 1.0)
        if strength > 0.05:
            self.scene.particles.burst(
                x, y, round(3 + 9 * strength), STONE, speed=(10, 40 + 50 * strength), life=(0.2, 0.6), gravity=80.0
            )
            self.scene.play("crumble", self._at(x), 0.12 + 0.5 * strength)

    # --- gun, line, bursts -------------------------------------------------------------------------------------------

    def fired(self):
        """Show that a shell leaves the ship's nose."""
        ship = self.scene.ship
        x, y = ship.nose
        self.works.burst("muzzle_flash", ship.x + 19 * x, ship.y + 19 * y, ship.vx, ship.vy)
        self.scene.play("heavy_laser", self._at(ship.x), 0.4)

    def blast(self, x, y, radius):
        """Show an explosion at (x, y) [px]: fire, a shock wave, stones. radius: radius of the crater [px]."""
        large = radius > 20.0
        self.works.burst("explosion_large" if large else "explosion_small", x, y)
        self.works.ring(x, y, 4.0 * radius)
        self.works.sparks(x, y, 18, FIRE, 170)
        self.scene.particles.burst(
            x, y, 26, STONE, speed=(30, 150), life=(0.3, 1.0), size=(1, 3), gravity=120.0, drag=1.0
        )
        self.scene.particles.burst(x, y, 8, DUST, speed=(8, 40), life=(0.5, 1.3), size=(2, 3), drag=2.0)
        self.scene.camera.shake(0.4 if large else 0.22)
        self.scene.play("blast", self._at(x), 0.8)

    def line_used(self, outcome):
        """Show the result of Line.toggle(): "caught", "let go" or "missed"."""
        ship = self.scene.ship
        if outcome == "caught":
            center = self.scene.line.load.center
            self.works.sparks(center.x, center.y, 10, BLUE, 80)
            self.works.word("HOOKED", ship.x, ship.y - 26, TINT["cold"])
        elif outcome == "missed":
            self.works.word("NOTHING IN REACH", ship.x, ship.y - 26, TINT["bad"])
        self.scene.play("hook", self._at(ship.x), 0.5 if outcome != "missed" else 0.2)

    def line_torn(self):
        """Show that the line has torn."""
        ship = self.scene.ship
        self.works.word("LINE TORN", ship.x, ship.y - 26, TINT["bad"])
        self.scene.play("chain_break", self._at(ship.x), 0.6)

    # --- won and lost ------------------------------------------------------------------------------------------------

    def can_taken(self, x, y, worth):
        """Show that the ship has taken a can of fuel at (x, y) [px]. worth: points for the can."""
        self.gain = self.pulse = 1.0
        self.works.sparks(x, y, 26, GOLD, 130)
        self.works.ring(x, y, 30.0)
        self.works.word(f"FUEL +{worth}", x, y - 16, TINT["gold"])
        self.scene.play("powerup", self._at(x), 0.6)

    def delivered(self, piece, worth):
        """Show that a piece of cargo has been delivered. worth: points for the delivery."""
        x, y = piece.body.center
        self.pulse = 1.0
        self.works.sparks(x, y, 40, BLUE, 150)
        self.works.ring(x, y, 44.0)
        self.works.word(f"CARGO {piece.whole:.0f}% +{worth}", x, y - 20, TINT["good"])
        self.scene.play("life", self._at(x), 0.7)

    def cargo_lost(self, piece):
        """Show that a piece of cargo has been destroyed."""
        x, y = piece.body.center
        self.works.burst("explosion_small", x, y)
        self.works.sparks(x, y, 30, FIRE, 160)
        self.works.word("CARGO LOST", x, y - 20, TINT["bad"])
        self.scene.play("explosion", self._at(x), 0.7)

    def stranded(self):
        """Show that the ship is stranded: out of fuel and not on a pad."""
        self.works.word("OUT OF FUEL", self.scene.ship.x, self.scene.ship.y - 30, TINT["bad"])

    def ship_lost(self, x, y):
        """Show the explosion of the ship at (x, y) [px]."""
        works = self.works
        works.chain(x, y, 18, 16, 5, 0.10)
        works.sparks(x, y, 70, FIRE, 230)
        works.sparks(x, y, 30, SPARK, 300)
        works.puffs(x, y, 8)
        for number in range(12):
            works.piece((5, 0)[number % 2], x, y, self.random.uniform(-120, 120), self.random.uniform(-150, 20), 1.3)
        self.scene.flash.start(0.7, (255, 170, 120))
        self.scene.camera.shake(0.7)
        self.scene.play("big_explosion", self._at(x), 0.9)
        self.scene.play("hurt", self._at(x), 0.5)

    @property
    def battered(self):
        """True if less than two fifths of the hull are left."""
        return self.scene.ship.hull < 0.4 * HULL
