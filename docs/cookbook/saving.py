import tempfile
from pathlib import Path

from hitbox.physics import Circle, Polygon, Snapshot, World


def run(world, frames):
    for _ in range(frames):
        world.step()
    return world.digest()


world = World()
world.add_body(Polygon.box(400, 20), position=(0, 100), kind="static")
for k in range(6):
    world.add_body(Circle(8), position=(3 * k, 20 - 18 * k))
run(world, 30)

with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "save.npz"
    world.snapshot().save(path)
    later = run(world, 60)
    other = World()  # of the same effects and pixels_per_meter; everything else comes with the snapshot
    other.restore(Snapshot.load(path))

print("the loaded world goes on to the same bit:", run(other, 60) == later)
assert other.digest() == later
