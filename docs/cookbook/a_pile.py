from hitbox.physics import Material, Polygon, World

world = World()
wood = Material(density=0.5, friction=0.6, restitution=0.1)
world.add_body(Polygon.box(600, 20), position=(0, 200), kind="static")
for row in range(8):
    for column in range(8 - row):
        world.add_body(Polygon.box(20, 20), position=(22 * column + 11 * row, 180 - 20.5 * row), material=wood)

frames = 0
while any(body.awake for body in world if body.kind == "dynamic"):
    world.step()
    frames += 1

print(f"{len(world) - 1} crates at rest after {frames} frames; asleep they cost nothing until somebody touches them")
top = world.body(len(world) - 1)
assert frames < 300 and abs(top.position.y - 40) < 2
