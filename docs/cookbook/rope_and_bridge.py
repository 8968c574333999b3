from hitbox.physics import Circle, Effects, Polygon, Revolute, World

world = World(Effects.rigid_bodies().with_(joints=True))

links = world.add_bodies(Polygon.box(20, 4), [(10 + 20 * k, 0) for k in range(20)])
ball = world.add_body(Circle(16), position=(416, 0), mass=100 * world.body(links[0]).mass)
ends = [None, *links], [*links, ball]  # None: the world
world.add_joints(Revolute, *ends, at=[(20 * k, 0) for k in range(21)])

planks = world.add_bodies(Polygon.box(30, 6), [(15 + 30 * k, 300) for k in range(12)])
world.add_joints(Revolute, [None, *planks], [*planks, None], at=[(30 * k, 300) for k in range(13)])

for _ in range(240):
    world.step()

apart = world.joints["separation"].max()
print(f"{len(world.joints)} joints, at most {apart:.3f} px apart, the ball at {ball.position}")
assert apart < 0.1
