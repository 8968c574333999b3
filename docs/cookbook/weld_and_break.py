import math

from hitbox.physics import Effects, Polygon, Weld, World

world = World(Effects.rigid_bodies().with_(joints=True))
hand = world.add_body(Polygon.box(10, 10), kind="kinematic")
box = world.add_body(Polygon.box(20, 20), position=(0, 20))
weight = box.mass * 313.6
grip = world.add_joint(Weld(hand, box, at=(0, 8), breaks=(3 * weight, None), user="grip"))

for frame in range(121):
    hand.set_target((59 - 59 * math.cos(math.pi * frame / 120), 0))
    world.step()
print(f"carried to {box.position}, the grip holds {grip.force / weight:.2f} times the weight")
assert grip in world and abs(box.position.x - 118) < 1

box.apply_force((0, 4 * weight))
world.step()
for broken in world.events.broken:
    print(f"joint {broken['joint']} broke by its {broken['reason']}")
assert grip not in world and len(world.events.broken) == 1
