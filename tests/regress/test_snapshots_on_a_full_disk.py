"""On a full disk Snapshot.save keeps the existing file; before the fix the old snapshot was lost with the new one."""

import pytest

from physics import Circle, Snapshot, World


def test_the_old_file_stays_until_the_new_one_is_whole(tmp_path, monkeypatch):
    path, world = tmp_path / "kept.npz", World()
    body = world.add_body(Circle(5), position=(3, 4))
    world.snapshot().save(path)
    before = path.read_bytes()

    def half(file, **arrays):
        file.write(b"PK half of it")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("physics.snapshot.np.savez_compressed", half)
    with pytest.raises(OSError, match="No space left"):
        world.snapshot().save(path)
    assert path.read_bytes() == before and [each.name for each in tmp_path.iterdir()] == ["kept.npz"]
    body.move_to((70, 80))
    world.restore(Snapshot.load(path))
    assert body.position == (3, 4)
