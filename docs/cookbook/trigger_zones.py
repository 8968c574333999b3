from hitbox.physics import Circle, Polygon, World

world = World(gravity=(0, 0))
door = world.add_body(Polygon.box(40, 40), position=(100, 0), kind="static", sensor=True, user="door")
sight = Circle(40).with_(sensor=True)  # a body that also sees
guard = world.add_body(Circle(8), sight, position=(300, 0), user="guard")
hero = world.add_body(Circle(8), velocity=(120, 0), user="hero")

log = []
for _ in range(150):
    world.step()
    for name, events in (("enters", world.events.sensor_begin), ("leaves", world.events.sensor_end)):
        for event in events:
            others = {world.body(event["body_a"]).user, world.body(event["body_b"]).user} - {"hero"}
            log.append(f"hero {name} {others.pop()}")

print(log)
assert log[:3] == ["hero enters door", "hero leaves door", "hero enters guard"]
