from hitbox.physics import Circle, Distance, Effects, Polygon, Spring, Target, World

world = World(Effects.rigid_bodies().with_(joints=True))
crate = world.add_body(Polygon.box(20, 20), position=(0, 0))
drag = world.add_joint(Target(crate, at=(5, 5), spring=Spring(6), max_force=40 * crate.mass * 313))

hero = world.add_body(Circle(8), position=(300, 100))
line = world.add_joint(Distance(None, hero, at_a=(400, 0), at_b=hero.position, limits=(0, 140)))

for frame in range(120):
    drag.point = (frame, -frame / 2)  # pygame.mouse.get_pos(), in the world's pixels
    line.limits = (0, 140 - frame / 2)  # hauls the hero in
    world.step()

print(f"crate at {crate.position}, hero on {line.translation:.0f} px of line, pulling with {line.force:.0f}")
assert line.translation < 81 and abs(crate.position.x - 119) < 20
drag.remove()  # let go
