from math import cos, sin

from hitbox.physics import Circle, Filter, Polygon, World

WALL, ENEMY, FRIEND = 1, 2, 4

world = World(gravity=(0, 0))
world.add_body(Circle(8), position=(60, 0), filter=Filter(FRIEND), user="friend")
world.add_body(Circle(8), position=(120, 3), filter=Filter(ENEMY), user="enemy")
world.add_body(Polygon.box(10, 200), position=(300, 0), kind="static", filter=Filter(WALL), user="wall")

muzzle, reach = (0, 0), (1000, 0)
hit = world.ray_cast(muzzle, reach, filter=Filter(mask=WALL | ENEMY))  # categories in the mask stop it
everybody = [each.body.user for each in world.ray_cast_all(muzzle, reach)]

print(f"hit {hit.body.user} at {hit.point}; the ray would pass {everybody}")
hit.body.apply_impulse(-hit.normal * 5000, hit.point)
assert hit.body.user == "enemy" and hit.body.velocity.x > 0 and everybody == ["friend", "enemy", "wall"]

fan = [(1000 * cos(angle / 50), 1000 * sin(angle / 50)) for angle in range(-20, 21)]
seen = world.ray_casts([muzzle] * len(fan), fan)  # many rays in one call, one row each; body -1: no hit
assert set(seen["body"].tolist()) == {-1, 0, 2}
