from hitbox.physics import Circle, Polygon, World

PIXELS = 32  # of the screen for a metre

world = World(pixels_per_meter=1)  # lengths in metres, gravity 9.8 m/s2; every tolerance scales with it
world.add_body(Polygon.box(20, 1), position=(0, 10.5), kind="static")
ball = world.add_body(Circle(0.25), position=(0, 0))

while ball.position.y < 9.7 and world.time < 5:
    world.step()

print(f"fell {ball.position.y:.2f} m in {world.time:.2f} s; on the screen at {ball.position * PIXELS}")
assert abs(world.time - (2 * 9.75 / 9.8) ** 0.5) < 0.05
