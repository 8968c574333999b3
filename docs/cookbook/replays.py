import random

from hitbox.physics import Circle, Polygon, World


def play(inputs):
    """Play the whole game, which depends on a seed and the inputs alone."""
    world = World(seed=7)
    world.add_body(Polygon.box(400, 20), position=(0, 100), kind="static")
    ball = world.add_body(Circle(8), position=(0, 82))
    for push in inputs:
        ball.apply_force((push * ball.mass, 0))
        world.step()  # always the same dt: never the time that passed on the clock
    return world.digest(), ball.position


recorded = [random.choice([-400, 0, 400]) for _ in range(200)]  # the keys, frame by frame
first, second = play(recorded), play(recorded)
print("the replay ends at", second[1], "- as the run did:", first == second)
assert first == second and play([0, *recorded])[0] != first[0]
