from hitbox.physics import Polygon, World

STEEPEST = 0.7  # of the normal's y: 45 degrees

world = World()
world.add_body(Polygon.box(400, 20), position=(0, 110), kind="static")
crate = world.add_body(Polygon.box(20, 20), position=(0, 40))


def grounded(body):
    for contact in body.contacts:  # awake or asleep; normals point from body_a to body_b
        down = contact["normal_y"] if contact["body_a"] == body.id else -contact["normal_y"]
        if down > STEEPEST:
            return True
    return False


in_the_air = grounded(crate)
for _ in range(120):
    world.step()
print("at the start:", in_the_air, "- two seconds later:", grounded(crate))
assert not in_the_air and grounded(crate)
