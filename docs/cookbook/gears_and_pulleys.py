from hitbox.physics import Circle, Drive, Effects, Gear, Polygon, Prismatic, Pulley, Ratchet, Revolute, World

world = World(Effects.rigid_bodies().with_(joints=True))

small, large = world.add_body(Circle(20)), world.add_body(Circle(40), position=(60, 0))
rack = world.add_body(Polygon.box(10, 120), position=(105, 0))
axles = [world.add_joint(Revolute(None, wheel, at=wheel.position)) for wheel in (small, large)]
rail = world.add_joint(Prismatic(None, rack, at=rack.position, axis=(0, 1)))
world.add_joint(Gear(axles[0], axles[1], ratio=40 / 20))  # teeth of B over those of A
world.add_joint(Gear(axles[1], rail, ratio=1 / 40))  # rack and pinion: 1 / radius
axles[0].motor = Drive(2, max=1e8)

crate = world.add_body(Polygon.box(20, 20), position=(300, 100))
weight = world.add_body(Circle(12), position=(400, 100), mass=2 * crate.mass)
over = {"at_a": crate.position, "at_b": weight.position, "ground_a": (300, 0), "ground_b": (400, 0)}
rope = world.add_joint(Pulley(crate, weight, **over, ratio=3))  # the weight pulls a third as far

lever = world.add_body(Polygon.box(60, 6), position=(-170, 0))
world.add_joint(Revolute(None, lever, at=(-200, 0)))
pawl = world.add_joint(Ratchet(None, lever, ratchet=-0.2))  # goes up only, in teeth of 0.2 rad
lever.velocity, lever.angular_velocity = (0, -120), -4

for _ in range(60):
    world.step()

print(f"wheels at {axles[0].speed:.2f} and {axles[1].speed:.2f} rad/s lift the rack by {-rail.translation:.1f} px")
print(f"the rope pulls with {rope.force / weight.mass / 313.6:.2f} times the weight, the lever is at {lever.angle:.2f}")
assert abs(axles[1].angle * 2 + axles[0].angle) < 0.01 and abs(rail.translation - 40 * -axles[1].angle) < 0.5
assert crate.position.y > 100 > weight.position.y and pawl.limits[1] <= -0.4
