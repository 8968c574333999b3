"""Key frames do not contain unused table rows, and store a long byte stream as its differences
if it changed a little.
"""

import numpy as np

from game.run.chunks import Chunks, bytes_of
from game.run.key_frame import KeyFrame, bytes_held
from tests.game.arena import Arena

FEW = 16_384  # bytes


def test_rows_behind_the_end_of_a_table_are_not_kept():
    """Table rows behind the last used one are not stored.

    In the shooter, tables had room for 1,500 bodies with 27 in use: 20 MB for ten seconds.
    """
    scene = Arena()
    before = bytes_held([KeyFrame(scene)])
    rng = np.random.default_rng(1)
    crowd = scene.world.add_bodies(scene.disc.shapes[0], rng.random((2000, 2)), rng.random((2000, 2)))
    scene.world.remove_bodies(crowd)
    tables = (scene.world._bodies, scene.world._shapes)
    assert all(len(table.data) >= 2000 and table.count == 2 for table in tables)
    key = KeyFrame(scene)
    kept = scene.world._bodies.rows.copy()
    assert bytes_held([key]) < before + len(scene.world.pairs.proxies) * scene.world.pairs.proxies.itemsize + FEW
    key.restore()
    tables = (scene.world._bodies, scene.world._shapes)
    assert all(len(table.data) >= 2000 and table.count == 2 for table in tables), "there is room as before"
    assert all((scene.world.bodies[name] == kept[name]).all() for name in ("id", "x", "vx", "inverse_mass"))


def test_a_long_stream_that_changes_a_little_is_kept_as_what_differs():
    """A long stream of bytes that changes a little is stored as its differences.

    zlib finds a repetition only within somewhat less than 32 kB. In chunks of 32 kB the same position of the previous
    chunk would be out of its reach.
    """
    stream = np.random.default_rng(1).integers(0, 255, 100_000, np.uint8)
    chunks, new = Chunks([memoryview(stream.tobytes())], [0]), 0
    for turn in range(12):
        stream[7919 * turn % 100_000 : 7919 * turn % 100_000 + 20] += 1
        chunks = Chunks([memoryview(stream.tobytes())], [0], chunks)
        for chunk in chunks.new:
            chunk.pack()
            new += len(chunk.data)
        assert bytes(chunks.contents()[0]) == stream.tobytes()
    assert new < FEW and bytes_of([chunks]) < 2.5 * len(stream)
