from hitbox.physics import Circle, Drive, Effects, Polygon, Revolute, Spring, Wheel, World

world = World(Effects.rigid_bodies().with_(joints=True))
world.add_body(Polygon.box(2000, 20), position=(800, 60), kind="static")

leaf = world.add_body(Polygon.box(40, 6), position=(-180, -40))
door = world.add_joint(Revolute(None, leaf, at=(-200, -40), limits=(-1.5, 1.5)))
door.motor = Drive(-3, max=1e8)  # opens upwards

chassis = world.add_body(Polygon.box(60, 14), position=(0, 30))
wheels = [world.add_body(Circle(9), position=(x, 40)) for x in (-20, 20)]
axles = [world.add_joint(Wheel(chassis, w, at=w.position, spring=Spring(4, 0.7))) for w in wheels]
for axle in axles:
    axle.motor = Drive(20, max=1e7)

for _ in range(180):
    world.step()

turn, travel = wheels[0].angular_velocity, axles[0].translation  # a joint Wheel reports its suspension
print(f"the door is open by {door.angle:.2f} rad, the car drives at {chassis.velocity.x:.0f} px/s")
print(f"a wheel turns at {turn:.1f} rad/s, its spring is pressed by {-travel:.1f} px")
assert abs(door.angle + 1.5) < 0.02 and chassis.velocity.x > 100
