"""Visual effects and sounds of the shooter. They never influence the game rules."""

from math import pi

from scenes.shooter.cast import GROUND_SPEED, WIDTH
from scenes.shooter.fireworks import BLUE, DUST, FIRE, FOAM, GOLD, SPARK, VAPOUR, Fireworks
from scenes.shooter.ground import is_water
from scenes.shooter.plane import TOP_POWER

SMOKE_EVERY = 5  # steps between puffs of smoke of a large damaged plane
FLASH = 3  # steps that a plane stays white after a hit
LEAN_RATE = 0.06  # share of its distance from the plane's offset by which the parallax follows per step
NEWS = 130  # steps that the name of a wave is shown
BONUS_SHOWN = 120  # steps that the bonus of a phase is shown
PULSE_FADE, GAIN_FADE = 5.0, 2.0  # [1/s] rate of the pulses of the score and of the weapon's icon
HEALTH_RATE = 0.12  # share of its distance from the real health by which the leader's bar follows per step
SMALL, LARGE = 30, 160  # area in pixels: smaller pieces have no trail; larger ones smoke, and burst or splash more
BURNING = 0.8  # share of its fall during which a piece burns
SHOT_SOUND = 6  # least steps between two sounds of a leader's guns
GRAZE_WORDS = 45  # steps between two words about grazes
MOST_EMBERS = 100  # number of bullets that burn with sparks at once; more would hide the picture
# kind -> explosion, sound, volume, shake, sparks, pieces of debris
DEATHS = {
    "dart": ("explosion_small", "explosion", 0.55, 0.06, 16, 4),
    "saucer": ("explosion_small", "explosion", 0.7, 0.10, 24, 5),
    "hornet": ("explosion_small", "explosion", 0.55, 0.06, 16, 4),
    "turret": ("explosion_large", "explosion", 0.85, 0.18, 36, 7),
    "gunship": ("explosion_large", "big_explosion", 0.9, 0.38, 60, 5),
}
PAINT = {
    "dart": (1, 0),
    "saucer": (3, 4),
    "gunship": (2, 0),
    "hornet": (4, 0),
    "turret": (0, 2),
    "player": (5, 0),
    "midboss": (2, 0),
    "boss": (1, 0),
}  # frames of the debris
PRAISE = (150, 226, 255)  # colour of praise
WORDS = {"power": "POWER UP", "bomb": "BOMB", "life": "1UP"}


class Spectacle:
    """Visible and audible effects of the shooter.

    works: moving decoration (explosions, debris, texts); other attributes are timers. Each method from wave() on shows
    one kind of event by pictures and sound.
    """

    def __init__(self, scene):
        self.scene = scene
        self.works = Fireworks(scene.particles)
        self.random = scene.particles.random
        self.time = 0.0
        self.flashes = {}  # body id -> remaining white steps
        self.muzzle = 9  # steps since the last volley
        self.quiet = 0  # steps until a leader's guns are heard again
        self.hush = 0  # steps until a text for a graze is shown again
        self.news = 0  # remaining steps in which the name of the wave is shown
        self.pulse = self.gain = 0.0  # pulses of the score and of the weapon's icon, 1..0
        self.bonus = ["", 0, 0]  # bonus of a phase: title, points, remaining steps
        self.health = 0.0  # share 0..1 shown on the leader's bar, which follows the real health slowly
        self.lean = self.lean_before = 0.0  # [px] offset from the middle for the parallax, which follows the plane

    def step(self, dt):
        """Make one step of `dt` [s] of all effects."""
        scene = self.scene
        self.time += dt
        self.muzzle += 1
        self.quiet, self.hush = max(0, self.quiet - 1), max(0, self.hush - 1)
        self.lean_before = self.lean
        self.lean += (scene.plane.x - WIDTH / 2 - self.lean) * LEAN_RATE
        self.pulse, self.gain = max(0.0, self.pulse - PULSE_FADE * dt), max(0.0, self.gain - GAIN_FADE * dt)
        self.news, self.bonus[2] = max(0, self.news - 1), max(0, self.bonus[2] - 1)
        self.flashes = {identity: left - 1 for identity, left in self.flashes.items() if left > 1}
        leader = scene.fleet.leader
        share = leader.health / leader.full if leader is not None and leader.mode != "arrive" else 0.0
        self.health += (share - self.health) * HEALTH_RATE
        if not scene.freeze:
            self._trails()
        self.works.step(dt, still=scene.freeze > 0)

    def _trails(self):
        """Emit smoke from damaged planes, fire behind diving darts, and vapour behind fast planes."""
        particles, plane = self.scene.particles, self.scene.plane
        for enemy in self.scene.fleet.planes.values():
            if enemy.heavy and enemy.health < enemy.full / 2 and enemy.age % SMOKE_EVERY == 0:
                side = -15 if enemy.age % (2 * SMOKE_EVERY) else 15
                self.works.burst(
                    "smoke", enemy.x + side * (2 if enemy.leads else 1), enemy.y - 6, self.random.uniform(-8, 8), -26.0
                )
            elif enemy.kind == "hornet" and enemy.age % 3 == 0:
                particles.burst(enemy.x, enemy.y, 1, VAPOUR, speed=(0, 6), life=(0.3, 0.6), size=(1, 1))
            elif enemy.kind == "dart" and enemy.mode == "dive" and enemy.age % 2 == 0:
                particles.burst(enemy.x, enemy.y, 2, FIRE, speed=(0, 24), life=(0.15, 0.35), size=(1, 2))
        self._trail_pieces()
        if plane.here and abs(plane.velocity[0]) > 150.0 and int(self.time * 60) % 2 == 0:
            for side in (-13, 13):
                particles.burst(plane.x + side, plane.y + 6, 1, VAPOUR, speed=(0, 4), life=(0.2, 0.4), size=(1, 1))

    def _trail_pieces(self):
        """Emit flames and smoke behind falling pieces of wreckage."""
        world, pieces = self.scene.world, self.scene.wreckage.pieces
        for identity, piece in pieces.items():
            burns = piece.age < BURNING * piece.life
            if piece.age % (3 if burns else 8) or piece.mask.area < SMALL:
                continue
            x, y = world.body(identity).center
            if burns:
                self.scene.particles.burst(x, y, 2, FIRE, speed=(2, 16), life=(0.2, 0.55), size=(1, 2))
            if piece.age % 12 == 0 and piece.mask.area > LARGE:
                self.works.burst("smoke", x, y, 0.0, 10.0)

    def lean_at(self, alpha):
        """Return the sideways offset [px] of the parallax. alpha: position (0..1) between the last two steps."""
        return self.lean_before + (self.lean - self.lean_before) * alpha

    # --- the stage ---------------------------------------------------------------------------------------------------

    def wave(self, director):
        """Show the name of the director's new wave. From the second wave on, also play a sound."""
        self.news = NEWS
        if director.number > 1:
            self.scene.play("blip", volume=0.3)

    def wave_done(self, enemy, worth):
        """Show the points for a wave that was shot down completely. enemy: the last plane of the wave; worth: the
        points.
        """
        self.works.word(f"WAVE +{worth}", enemy.x, enemy.y - 34, PRAISE)

    def warning(self, event):
        """Announce a leader (mid-boss or boss) by an alarm and a shake of the camera."""
        self.scene.play("warning", volume=0.9)
        self.scene.camera.shake(0.2)

    # --- shots -------------------------------------------------------------------------------------------------------

    def player_fires(self, plane):
        """Show the muzzle flash of the player's plane, and play the sound of its guns."""
        self.muzzle = 0
        self.scene.play("heavy_laser" if plane.power == TOP_POWER else "laser", plane.x, 0.2)

    def enemy_fires(self, enemy):
        """Show the muzzle flash of an enemy plane, and play the sound of its guns."""
        self.works.burst("muzzle_flash", enemy.x, enemy.y + 8)
        self.scene.play("enemy_shot", enemy.x, 0.35)

    def leader_fires(self, leader):
        """Show the muzzle flash of a mid-boss or boss, with a sound, at most once in SHOT_SOUND steps."""
        if not self.quiet:
            self.quiet = SHOT_SOUND
            self.works.burst("muzzle_flash", leader.x, leader.y + 22)
            self.scene.play("enemy_shot", leader.x, 0.3)

    def dive(self, dart):
        """Show the start of a dart's dive by flames at its tail."""
        self.scene.particles.burst(
            dart.x, dart.y - 8, 14, FIRE, speed=(30, 120), life=(0.2, 0.5), angle=-pi / 2, spread=1.4
        )
        self.scene.play("enemy_shot", dart.x, 0.3)

    def struck(self, enemy, x, y, blow):
        """Show that a shot damages an enemy at the point (x, y) [px]. A harder Blow `blow` gives more sparks."""
        self.flashes[enemy.id] = FLASH
        self.works.burst("spark", x, y, 0.0, 20.0)
        self.scene.particles.burst(
            x,
            y,
            round(5 * blow.strength),
            SPARK,
            speed=(40, 160 * blow.strength),
            life=(0.1, 0.3),
            angle=pi / 2,
            spread=2.6,
            size=(1, 1),
        )
        self.scene.play("hit", x, min(0.25 * blow.strength, 1.0))

    def glanced(self, enemy, x, y):
        """Show a shot at an enemy that cannot be hurt at the moment. x, y: the contact point [px]."""
        self.scene.particles.burst(
            x, y, 3, BLUE, speed=(40, 120), life=(0.1, 0.25), angle=pi / 2, spread=2.6, size=(1, 1)
        )

    def destroyed(self, enemy, worth, blow):
        """Show the explosion of an enemy, and the points `worth`. blow: the Blow of the last hit.

        The debris gets a part of the enemy's velocity plus the velocity from the blow.
        """
        animation, sound, volume, shake, sparks, pieces = DEATHS[enemy.kind]
        x, y, works = enemy.x, enemy.y, self.works
        works.burst(animation, x, y, enemy.vx * 0.2, enemy.vy * 0.2 + 10)
        if enemy.kind == "gunship":
            works.chain(x, y, 22, 16, 6, 0.09)
            works.ring(x, y, 64.0)
            self.scene.flash.start(0.35, (255, 196, 120))
        elif enemy.kind == "turret":
            works.scar(x, y, 15)
            works.sparks(x, y, 24, DUST, 90)
            works.ring(x, y, 40.0)
        works.sparks(x, y, round(sparks * blow.strength), FIRE)
        works.sparks(x, y, sparks // 3, SPARK, 260)
        works.pieces(PAINT[enemy.kind], x, y, enemy.vx * 0.3, enemy.vy * 0.3, pieces, blow)
        works.puffs(x, y, 6 if enemy.heavy else 2)
        works.word(f"{worth}", x, y - 24, (255, 236, 170))
        self.pulse = 1.0
        self.scene.camera.shake(shake * blow.strength)
        self.scene.play(sound, x, min(volume * (0.8 + 0.2 * blow.strength), 1.0))

    def broke(self, plane, x, y):
        """Show that a plane breaks along cracks that cross at (x, y) [px]."""
        self.works.burst("spark", x, y)
        self.works.sparks(x, y, 18, SPARK, 220)
        self.scene.play("tear", x, 1.0 if plane.leads else 0.7)

    def piece_down(self, identity, piece):
        """Show that a piece of wreckage falls into water or on the ground. A larger piece gives more and louder
        effects.

        identity: body id of the piece; piece: its Piece.
        """
        x, y = self.scene.world.body(identity).center
        count, loud = min(4 + piece.mask.area // 12, 24), min(0.2 + piece.mask.area / 900, 0.7)
        if is_water(self.scene, x, y):
            self.works.burst("splash_large" if piece.mask.area > LARGE else "splash", x, y, 0.0, GROUND_SPEED)
            self.works.sparks(x, y, count, FOAM, 50)
            self.scene.play("splash", x, loud)
        else:
            self.works.scar(x, y, 4 + min(piece.mask.area // 60, 6))
            self.works.burst("explosion_small" if piece.mask.area > LARGE else "smoke", x, y, 0.0, GROUND_SPEED)
            self.works.sparks(x, y, count, DUST, 60)
            self.scene.play("land", x, loud)

    # --- the player --------------------------------------------------------------------------------------------------

    def player_hit(self, plane, hit_by, still):
        """Show that the player was hit: plane and bullet are white for `still` steps, in which a bomb can save the
        plane.

        hit_by: body ids of the bullets or planes that hit the player.
        """
        for identity in (plane.body.id, *hit_by):
            self.flashes[identity] = still + 1
        self.scene.camera.shake(0.35)
        self.scene.play("hurt", plane.x, 0.8)

    def hit_taken(self, plane):
        """Show that an invincible player was hit."""
        self.flashes[plane.body.id] = FLASH + 1
        self.works.sparks(plane.x, plane.y, 10, BLUE, 120)
        self.scene.play("hurt", plane.x, 0.4)

    def player_lost(self, plane, blow):
        """Show the explosion of the player's plane. blow: Blow of the hit that destroyed it."""
        x, y, works = plane.x, plane.y, self.works
        works.burst("explosion_large", x, y, 0.0, 12.0)
        works.chain(x, y, 16, 16, 4, 0.12)
        works.ring(x, y, 90.0)
        works.sparks(x, y, 60, FIRE, 200)
        works.sparks(x, y, 30, BLUE, 240)
        works.pieces(PAINT["player"], x, y, 0.0, 0.0, 10, blow)
        works.puffs(x, y, 6)
        self.scene.flash.start(0.7, (255, 150, 120))
        self.scene.camera.shake(0.5)
        self.scene.play("big_explosion", x, 0.8)

    def bomb_dropped(self, bomb):
        """Show the flash of a bomb that explodes."""
        self.works.ring(bomb.x, bomb.y, 150.0)
        self.works.sparks(bomb.x, bomb.y, 60, BLUE, 320)
        self.works.sparks(bomb.x, bomb.y, 30, GOLD, 220)
        self.scene.flash.start(0.8, (190, 226, 255))
        self.scene.camera.shake(0.45)
        self.scene.play("bomb", bomb.x, 0.9)

    def bullets_burnt(self, xs, ys):
        """Show sparks at the points (xs, ys), arrays [px], at which bullets were removed.

        If there are many points, only about MOST_EMBERS of them get sparks.
        """
        each = -(-len(xs) // MOST_EMBERS)
        self.works.embers(xs[::each], ys[::each])

    def grazed(self, plane, world, ids, worth):
        """Show sparks between the plane and the bullets that graze it. ids: body ids of the bullets; worth: points for
        them.
        """
        bodies = world.bodies
        for row in world.rows(ids).tolist():
            x, y = bodies["x"][row].item(), bodies["y"][row].item()
            self.works.burst("graze_spark", (x + plane.x) / 2, (y + plane.y) / 2)
            self.works.sparks((x + plane.x) / 2, (y + plane.y) / 2, 3, BLUE, 90)
        if not self.hush:
            self.hush = GRAZE_WORDS
            self.works.word(f"GRAZE +{worth}", plane.x, plane.y + 22, PRAISE)
        self.scene.play("graze", plane.x, 0.3)

    def chain_broken(self, plane):
        """Show that the chain of the score has broken."""
        self.works.word("CHAIN LOST", plane.x, plane.y - 26, (214, 190, 206))
        self.scene.play("chain_break", plane.x, 0.5)

    def loot_left(self, x, y):
        """Show that a pick-up appears at (x, y) [px]."""
        self.works.sparks(x, y, 14, GOLD, 90)

    def loot_taken(self, plane, what, worth):
        """Show that the player takes the pick-up `what`. worth: points if the plane could not use it, otherwise 0."""
        self.gain = 1.0
        self.works.sparks(plane.x, plane.y, 30, GOLD, 150)
        self.works.ring(plane.x, plane.y, 30.0)
        self.works.word(f"+{worth}" if worth else WORDS[what], plane.x, plane.y - 18, (255, 226, 120))
        self.scene.play("life" if what == "life" and not worth else "powerup", plane.x, 0.7)

    def life_won(self, plane):
        """Show an extra life."""
        self.works.word("1UP", plane.x, plane.y - 30, (170, 255, 190))
        self.works.ring(plane.x, plane.y, 44.0)
        self.scene.play("life", plane.x, 0.9)

    def went_on(self):
        """Show that the player continues after the last life."""
        self.scene.flash.start(0.5)
        self.scene.play("confirm", volume=0.8)

    # --- leaders -----------------------------------------------------------------------------------------------------

    def phase_over(self, leader, last, worth):
        """Show the end of a phase of a boss fight by explosions and a text.

        last: whether the whole fight ends; worth: bonus points, 0 if the time ran out.
        """
        x, y, works = leader.x, leader.y, self.works
        self.bonus = ["PHASE BONUS" if worth else "TIME OUT", worth, BONUS_SHOWN]
        works.ring(x, y, 220.0)
        works.chain(x, y, 52, 30, 8, 0.07)
        works.sparks(x, y, 80, FIRE, 260)
        works.puffs(x, y, 8)
        self.pulse = 1.0
        self.scene.flash.start(1.0 if last else 0.7)
        self.scene.camera.shake(0.6)
        self.scene.play("big_explosion", x, 0.9)

    def leader_burns(self, leader, whole):
        """Show explosions on a falling mid-boss or boss, more often in the second half of its fall.

        whole: duration of the fall [steps].
        """
        share = leader.since / whole
        every = 10 if share < 0.5 else 5
        if leader.since % every == 0:
            dx, dy = self.random.uniform(-54, 54), self.random.uniform(-30, 30)
            big = leader.since % (4 * every) == 0
            self.works.burst("explosion_large" if big else "explosion_small", leader.x + dx, leader.y + dy, 0.0, 16.0)
            self.works.sparks(leader.x + dx, leader.y + dy, 16, FIRE, 170)
            self.works.piece(PAINT[leader.kind][0], leader.x + dx, leader.y + dy, dx * 1.6, -60.0, 1.2)
            self.scene.camera.shake(0.12)
            self.scene.play("explosion", leader.x + dx, 0.5 + 0.4 * share)
            self.flashes[leader.id] = 2

    def leader_gone(self, leader):
        """Show the last and largest explosion of a mid-boss or boss, in which it breaks."""
        x, y, works = leader.x, leader.y, self.works
        works.burst("explosion_large", x, y)
        for dx, dy in ((-40, -10), (40, -8), (-20, 22), (22, 20), (0, -24)):
            works.burst("explosion_large", x + dx, y + dy, dx * 0.5, dy * 0.5, -0.04 * (abs(dx) // 20))
        works.chain(x, y, 70, 44, 14, 0.06)
        works.ring(x, y, 300.0)
        works.ring(x, y, 160.0)
        works.sparks(x, y, 160, FIRE, 380)
        works.sparks(x, y, 60, GOLD, 300)
        works.puffs(x, y, 14)
        for number in range(20):
            works.piece(
                PAINT[leader.kind][number % 2],
                x,
                y,
                self.random.uniform(-190, 190),
                self.random.uniform(-180, 120),
                self.random.uniform(0.8, 1.8),
            )
        self.scene.flash.start(1.0)
        self.scene.camera.shake(0.9)
        self.scene.play("big_explosion", x, 1.0)
