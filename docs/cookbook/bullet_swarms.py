import numpy as np

from hitbox.physics import Circle, Effects, Filter, World

BULLET, ENEMY = 1, 2

world = World(Effects.detection())  # hits are reported, without response
angles = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
bullets = world.add_bodies(Circle(2), directions * 20, velocities=directions * 240, filter=Filter(BULLET, mask=ENEMY))
world.add_body(Circle(12), position=(150, 0), kind="static", filter=Filter(ENEMY, mask=BULLET))

shot = 0
for _ in range(60):
    world.step()
    begin = world.events.begin  # a structured array: no Python object per bullet
    hit = np.intersect1d(bullets, np.concatenate([begin["body_a"], begin["body_b"]]))
    world.remove_bodies(hit)
    shot += len(hit)
    far = world.bodies["id"][np.hypot(world.bodies["x"], world.bodies["y"]) > 220]
    world.remove_bodies(far)

print(shot, "bullets hit,", len(world) - 1, "are still flying")
assert 40 < shot < 90 and 0 <= len(world) - 1 < 2000 - shot
