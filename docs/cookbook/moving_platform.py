import math

from hitbox.physics import Polygon, World

world = World()
lift = world.add_body(Polygon.box(80, 10), position=(0, 100), kind="kinematic")
crate = world.add_body(Polygon.box(16, 16), position=(0, 86))

for frame in range(300):
    # Its place at the end of the step; it carries the bodies on it.
    lift.set_target((40 - 40 * math.cos(frame / 60), 100))
    world.step()

print(f"lift at {lift.position.x:.1f}, crate at {crate.position.x:.1f}")
assert abs(crate.position.x - lift.position.x) < 4 and abs(crate.position.y - 87) < 0.5
