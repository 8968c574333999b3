from hitbox.physics import Capsule, Circle, Effects, Polygon, Revolute, World

world = World(Effects.rigid_bodies().with_(joints=True))
for k in range(4):  # stairs
    world.add_body(Polygon.box(60, 20), position=(60 * k, 100 + 20 * k), kind="static")
world.add_body(Polygon.box(1600, 20), position=(0, 180), kind="static")

torso = world.add_body(Capsule((0, -14), (0, 14), 7), position=(0, 20))
head = world.add_body(Circle(8), position=(0, -10))
world.add_joint(Revolute(torso, head, at=(0, -2), limits=(-0.6, 0.6)))
for side in (-1, 1):
    for y, low, high in ((8, -2.5, 2.5), (34, -1.2, 1.2)):  # arms, legs
        at = (6 * side, y)
        limb = world.add_body(Capsule((0, 0), (0, 22), 4), position=at)
        world.add_joint(Revolute(torso, limb, at=at, limits=(low, high)))

torso.velocity = 60, 0
worst = 0
for _ in range(600):
    world.step()
    over = world.joints["lower"] - world.joints["angle"], world.joints["angle"] - world.joints["upper"]
    worst = max(worst, *(each.max() for each in over))

print(f"limits exceeded by at most {worst:.4f} rad, asleep: {not torso.awake}")
assert worst < 0.02 and not torso.awake
