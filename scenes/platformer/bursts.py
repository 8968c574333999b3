"""Particles of the platformer: dust, grit, sparks and confetti. They never influence the game rules.

Every function takes the scene's Particles and a world position (x, y) [px]. Speeds are in px/s, lifetimes in s.
"""

from math import pi

DUST = ((214, 200, 190), (160, 142, 140), (104, 90, 100))
GRIT = ((190, 196, 214), (128, 128, 158), (74, 70, 100))
GOLDEN = ((255, 255, 235), (255, 226, 120), (240, 164, 50), (150, 84, 40))
EMBER = ((255, 244, 190), (255, 178, 70), (214, 84, 40), (90, 40, 52))
MOTES = {
    "meadow": ((255, 226, 150), (226, 150, 110), (130, 84, 120)),
    "cave": ((190, 255, 240), (90, 190, 200), (50, 90, 130)),
    "keep": ((255, 214, 190), (214, 130, 140), (110, 70, 120)),
}
CONFETTI = (
    ((255, 92, 92), (180, 50, 80)),
    ((120, 220, 232), (60, 130, 190)),
    ((255, 222, 110), (214, 140, 60)),
    ((190, 236, 120), (90, 160, 80)),
)
GEM = ((255, 255, 255), (170, 255, 236), (80, 200, 220), (60, 90, 170))
BLOOD = ((255, 255, 255), (255, 150, 150), (190, 50, 80), (80, 30, 60))
UP, DOWN = -pi / 2, pi / 2  # [rad] headings


def dust(particles, x, y, count, speed):
    """Emit `count` particles of dust at the feet of a body at (x, y) [px]. speed: (lowest, highest) [px/s]."""
    particles.burst(x, y, count, DUST, speed=speed, life=(0.15, 0.4), angle=UP, spread=2.8, drag=3.0, gravity=40.0)


def slide(particles, x, y, side):
    """Emit the dust of the hero at (x, y) [px] while he slides down a wall. side: side of the wall, -1 left, 1 right.

    particles: the scene's Particles.
    """
    x, y, heading = x + 5 * side, y + 4, DOWN * (1 + side)
    particles.burst(x, y, 2, DUST, speed=(5, 26), life=(0.2, 0.4), angle=heading, spread=1.6, gravity=60.0)


def wall_jump(particles, x, y, away):
    """Emit the dust of the hero at (x, y) [px] when he jumps off a wall. away: direction of the jump, -1 left, 1
    right.

    particles: the scene's Particles.
    """
    x, y, heading = x - 6 * away, y + 4, 0.0 if away > 0 else pi
    particles.burst(x, y, 10, DUST, speed=(20, 90), life=(0.2, 0.45), angle=heading, spread=1.8, gravity=120.0)


def launch(particles, x, y):
    """Emit sparks at (x, y) [px] when a spring is released. particles: the scene's Particles."""
    particles.burst(x, y, 10, GOLDEN, speed=(40, 150), life=(0.2, 0.5), angle=UP, spread=1.4)


def squash(particles, x, y):
    """Emit dust at (x, y) [px] when an enemy is flattened. particles: the scene's Particles."""
    particles.burst(x, y, 14, DUST, speed=(30, 110), life=(0.2, 0.5), angle=UP, spread=2.6, gravity=200.0)


def knock(particles, x, y, force):
    """Emit the dust of an impact at (x, y) [px]. A greater `force` (0..1) gives more and faster particles."""
    count, speed, life = 2 + round(16 * force), (10, 30 + 80 * force), (0.2, 0.3 + 0.4 * force)
    particles.burst(x, y, count, DUST, speed=speed, life=life, angle=UP, spread=2.6, gravity=60.0)


def trickle(particles, box):
    """Emit one piece of grit from the underside of a crumbling stone that shakes.

    particles: the scene's Particles; box: (left, top, right, bottom) of the stone [px].
    """
    left, _, right, bottom = box
    x = left + (right - left) * particles.random.uniform(0, 1)
    particles.burst(
        x, bottom, 1, GRIT, speed=(4, 18), life=(0.2, 0.5), angle=DOWN, spread=0.8, size=(1, 1), gravity=240.0
    )


def rubble(particles, x, y):
    """Emit small pieces at (x, y) [px] when a crumbling stone breaks. particles: the scene's Particles."""
    particles.burst(x, y, 18, GRIT, speed=(20, 90), life=(0.3, 0.7), spread=6.28, gravity=200.0)


def mote(particles, view, act):
    """Emit one floating speck in the colours of the act named `act`.

    particles: the scene's Particles; view: (left, top, width, height) [px], the rectangle in which the speck appears.
    """
    left, top, width, height = view
    x = left + width * particles.random.uniform(0, 1)
    y = top + height * particles.random.uniform(0.2, 1)
    particles.burst(x, y, 1, MOTES[act], speed=(4, 14), life=(1.5, 3.2), size=(1, 1), drag=0.2, gravity=-3.0)


def ember(particles, x, y):
    """Emit one spark that rises from a flame at (x, y) [px]. particles: the scene's Particles."""
    particles.burst(
        x, y - 1, 1, EMBER, speed=(6, 20), life=(0.3, 0.8), angle=UP, spread=1.2, size=(1, 1), gravity=-30.0
    )


def kindle(particles, x, y):
    """Emit sparks at (x, y) [px] when a lantern is lit. particles: the scene's Particles."""
    particles.burst(x, y, 26, EMBER, speed=(20, 110), life=(0.3, 0.9), drag=3.0, gravity=-20.0)


def coin(particles, x, y):
    """Emit sparkles at (x, y) [px] when a coin is taken. particles: the scene's Particles."""
    particles.burst(x, y, 9, GOLDEN, speed=(20, 90), life=(0.25, 0.6), size=(1, 1), gravity=120.0)


def gem(particles, x, y):
    """Emit two rings of particles, a slow and a fast one, at (x, y) [px] when a secret is found."""
    for speed in ((30, 60), (90, 150)):
        particles.burst(x, y, 26, GEM, speed=speed, life=(0.5, 1.2), drag=1.8)


def hurt(particles, x, y):
    """Emit particles at (x, y) [px] when the hero is hurt. particles: the scene's Particles."""
    particles.burst(x, y, 24, BLOOD, speed=(30, 170), life=(0.25, 0.7))


def vanish(particles, x, y):
    """Emit a puff at (x, y) [px], where the hero was before he was moved back to safe ground.

    particles: the scene's Particles.
    """
    particles.burst(x, y, 20, GEM, speed=(20, 110), life=(0.25, 0.6))


def confetti(particles, x, y):
    """Emit confetti at (x, y) [px] when the level is won. particles: the scene's Particles."""
    for ramp in CONFETTI:
        particles.burst(x, y, 34, ramp, speed=(60, 240), life=(0.8, 2.0), angle=UP, spread=2.2, drag=1.6, gravity=150.0)


def fuse(particles, x, y):
    """Emit the sparks of a burning fuse at (x, y) [px]. particles: the scene's Particles."""
    particles.burst(x, y, 2, EMBER, speed=(20, 80), life=(0.1, 0.3), angle=UP, spread=3.0, size=(1, 1), gravity=120.0)


def blast(particles, x, y):
    """Emit the particles of an explosion at (x, y) [px]: fast fire, falling grit, and dust that lasts longer."""
    particles.burst(x, y, 50, EMBER, speed=(60, 280), life=(0.25, 0.7), drag=3.0)
    particles.burst(x, y, 40, GRIT, speed=(50, 220), life=(0.4, 0.9), angle=UP, spread=5.0, gravity=420.0)
    particles.burst(x, y, 40, DUST, speed=(10, 70), life=(0.7, 1.6), drag=2.2, gravity=-8.0)
