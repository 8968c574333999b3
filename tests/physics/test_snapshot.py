"""Snapshots, files and digests: a restored world continues to the bit, and damaged files are refused with a reason."""

import copy
import io
import json
import zipfile

import numpy as np
import pytest

from physics import (
    JIT,
    BruteForce,
    Character,
    Circle,
    DynamicTree,
    Effects,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Snapshot,
    SpatialHashGrid,
    SweepAndPrune,
    TileGrid,
    World,
)

ALL = Effects(
    response=True,
    gravity=True,
    drag=True,
    wind=True,
    rotation=True,
    friction=True,
    restitution=True,
    continuous=True,
    sensors=True,
    persist=True,
    one_way=True,
)


def busy(seed=0, broadphase=None):
    """Return (world, character) with every kind of shape, body and effect."""
    rng = np.random.default_rng(seed)
    world = World(ALL, broadphase, drag=0.1, wind=(20, 0), seed=seed)
    world.add_body(TileGrid(np.ones((2, 20), bool), 16), position=(0, 160), kind="static")
    mask = PixelMask(rng.random((9, 12)) < 0.7)
    for k in range(20):
        shape = (Circle(5.0, (1, 0)), Polygon.box(9, 7), mask)[k % 3]
        world.add_body(
            shape,
            position=tuple(rng.uniform(20, 300, 2) * (1, 0.4)),
            velocity=tuple(rng.normal(0, 200, 2)),
            angular_velocity=float(rng.normal(0, 3)),
            sensor=k % 7 == 0,
            material=Material(restitution=0.5),
            filter=Filter(1 << (k % 4)),
            tier="circle" if k % 3 == 2 and k % 2 else None,
        )
    world.add_body(Polygon.box(48, 10), position=(60, 140), kind="kinematic", velocity=(30, -5))
    return world, Character(world, Polygon.box(10, 20), (60, 120))


def go(world, hero, steps):
    found = []
    for _ in range(steps):
        hero.move(0.7, 2.0)
        world.bodies["vx"][3] += world.random.normal()
        world.step()
        found.append((world.digest(), len(world.events.begin), len(world.events.end), len(world.events.persist)))
    return found


N = 40 if JIT else 10


def test_restored_world_goes_on_as_the_first_time():
    world, hero = busy()
    go(world, hero, 10)
    taken, digest = world.snapshot(), world.digest()
    first = go(world, hero, N)
    world.restore(taken)
    assert world.digest() == digest
    assert go(world, hero, N) == first


def test_snapshot_is_not_changed_by_the_world_that_goes_on():
    world, hero = busy()
    go(world, hero, 5)
    taken = world.snapshot()
    kept = {name: array.copy() for name, array in taken.arrays.items()}
    go(world, hero, 5)
    world.clear()
    assert all((taken.arrays[name] == array).all() for name, array in kept.items())


def test_snapshot_brings_back_what_was_removed_and_takes_away_what_was_added():
    world, hero = busy()
    world.step()
    taken, digest = world.snapshot(), world.digest()
    world.remove_bodies([1, 2, 3])
    added = world.add_body(Circle(3)).id
    world.restore(taken)
    assert world.digest() == digest and world.body(1).shapes and not (world.bodies["id"] == added).any()
    assert world.add_body(Circle(3)).id == added, "ids go on as they did"


def test_file_round_trip_into_a_world_built_anew(tmp_path):
    world, hero = busy()
    go(world, hero, 10)
    world.snapshot().save(tmp_path / "kept.npz")
    digest = world.digest()
    first = go(world, hero, N)
    other, _ = busy(seed=5, broadphase=DynamicTree())
    other.restore(Snapshot.load(tmp_path / "kept.npz"))
    assert other.digest() == digest and other.body(3).tier == world.body(3).tier
    assert go(other, _at(other, hero), N) == first


def _at(world, hero):
    """Return a copy of the character `hero` for another world; it controls the body with the same id there."""
    copy = object.__new__(type(hero))
    copy.world, copy.body = world, world.body(hero.body.id)
    return copy


@pytest.mark.parametrize("make", [BruteForce, SweepAndPrune, lambda: SweepAndPrune(axes="both"), DynamicTree])
def test_digest_is_the_same_under_every_broad_phase(make):
    one, other = busy(broadphase=SpatialHashGrid()), busy(broadphase=make())
    assert go(*one, N) == go(*other, N)


def test_digest_ignores_user_rows_times_and_minus_zero():
    worlds = [World(ALL, gravity=(0, 0)) for _ in range(2)]
    for world, zero in zip(worlds, (0.0, -0.0), strict=True):
        world.add_body(Circle(5), position=(zero, zero), velocity=(zero, zero))
    worlds[0].body(0).user = object()
    worlds[0].step(), worlds[1].step()
    assert worlds[0].digest() == worlds[1].digest() and len(worlds[0].digest()) == 32
    worlds[0].bodies["x"] = np.nextafter(0, 1)
    assert worlds[0].digest() != worlds[1].digest()


def test_digest_is_blake2b_of_what_matters_and_reading_it_changes_nothing():
    world, hero = busy()
    go(world, hero, 3)
    assert world.digest() == world.digest() and int(world.digest(), 16) >= 0
    other, twin = busy()
    go(other, twin, 3)
    assert other.digest() == world.digest()
    other.wind, other.broadphase = (0, 0), BruteForce()
    assert other.digest() == world.digest()


def saved(tmp_path):
    world, hero = busy()
    go(world, hero, 3)
    world.snapshot().save(tmp_path / "kept.npz")
    return tmp_path / "kept.npz"


def test_cut_and_flipped_files_are_refused_or_whole(tmp_path):
    data = saved(tmp_path).read_bytes()
    world, _ = busy()
    before = world.digest()
    rng = np.random.default_rng(0)
    broken = [data[:n] for n in (0, 1, 10, 100, len(data) // 2, len(data) - 5)]
    for _ in range(60):
        changed = bytearray(data)
        for at in rng.integers(0, len(data), 3):
            changed[at] ^= 1 << int(rng.integers(8))
        broken.append(bytes(changed))
    for number, content in enumerate(broken):
        path = tmp_path / f"broken{number}.npz"
        path.write_bytes(content)
        try:
            world.restore(Snapshot.load(path))
        except ValueError as refused:
            assert path.name in str(refused)
            assert world.digest() == before, "nothing changed"
        else:
            world.restore(Snapshot.load(tmp_path / "kept.npz"))
            before = world.digest()


@pytest.mark.parametrize("method", [1, 8, 12, 14, 93])
def test_files_that_name_another_compression_are_refused_or_whole(tmp_path, method):
    """A snapshot file that names another compression method is refused with an error that names the file.

    Zip files name the method in two bytes of each entry. Other decompressors raise errors of their own.
    """
    path = saved(tmp_path)
    content = path.read_bytes()
    for mark, at in ((b"PK\x03\x04", 8), (b"PK\x01\x02", 10)):
        first, *parts = content.split(mark)
        content = first + b"".join(mark + each[: at - 4] + bytes([method, 0]) + each[at - 2 :] for each in parts)
    path.write_bytes(content)
    if method == 8:
        Snapshot.load(path)  # as it was
    else:
        with pytest.raises(ValueError, match=path.name):
            Snapshot.load(path)


@pytest.mark.parametrize("content", [b"", b"no snapshot", b"PK\x03\x04", b"\x93NUMPY\x01\x00garbage"])
def test_what_is_no_snapshot_is_refused_with_the_file(tmp_path, content):
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    with pytest.raises(ValueError, match="other.npz"):
        Snapshot.load(path)


def test_a_plain_array_file_and_a_missing_one_are_refused(tmp_path):
    np.save(tmp_path / "array.npy", np.arange(3))
    with pytest.raises(ValueError, match="array.npy"):
        Snapshot.load(tmp_path / "array.npy")
    with pytest.raises(FileNotFoundError):
        Snapshot.load(tmp_path / "missing.npz")


def rewritten(path, change):
    """Edit the contents of a snapshot file in place and return its path.

    change(facts, arrays): function that edits the two dicts of the contents.
    """
    with np.load(path) as stored:
        arrays = dict(stored)
    facts = json.loads(str(arrays.pop("facts")))
    change(facts, arrays)
    np.savez(path, facts=np.array(json.dumps(facts)), **arrays)
    return path


@pytest.mark.parametrize(
    "name, change",
    [
        ("version", lambda f, a: f.update(version=99)),
        ("bodies", lambda f, a: a.update(bodies=np.zeros(3, [("x", float)]))),
        ("shapes", lambda f, a: a.pop("shapes")),
        ("hulls", lambda f, a: f.pop("hulls")),
        ("hull_0", lambda f, a: a.pop("hull_0")),
        ("mask_0", lambda f, a: a.pop("mask_0")),
        ("solid_0", lambda f, a: a.pop("solid_0")),
        ("random", lambda f, a: f.update(random={"state": 3})),
        ("next_body", lambda f, a: f.pop("next_body")),
        ("tiers", lambda f, a: f.update(tiers=[[1]])),
        ("gravity", lambda f, a: f.update(gravity=[1, float("nan")])),
    ],
)
def test_a_file_with_a_wrong_part_is_refused_and_changes_nothing(tmp_path, name, change):
    path = rewritten(saved(tmp_path), change)
    world, _ = busy()
    before = world.digest()
    with pytest.raises(ValueError):
        world.restore(Snapshot.load(path))
    assert world.digest() == before
    world.step()


def shuffled(rows):
    """Return a structured array with the same columns in reverse order and without padding."""
    names = rows.dtype.names[::-1]
    other = np.zeros(len(rows), [(name, rows.dtype[name]) for name in names])
    for name in names:
        other[name] = rows[name]
    return other


def test_a_file_whose_columns_stand_elsewhere_in_their_rows_is_read(tmp_path):
    world, hero = busy()
    go(world, hero, 10)
    world.snapshot().save(tmp_path / "kept.npz")
    tables = ("bodies", "shapes", "contact_rows", "reported")
    path = rewritten(tmp_path / "kept.npz", lambda f, a: a.update({name: shuffled(a[name]) for name in tables}))
    digest = world.digest()
    first = go(world, hero, N)
    other, _ = busy(seed=5)
    other.restore(Snapshot.load(path))
    assert other.digest() == digest
    assert go(other, _at(other, hero), N) == first


def test_files_hold_no_pickles(tmp_path):
    with zipfile.ZipFile(saved(tmp_path)) as stored:
        for name in stored.namelist():
            header = stored.read(name)[:200]
            np.lib.format.read_array(io.BytesIO(stored.read(name)), allow_pickle=False)
            assert b"|O" not in header


def test_snapshot_of_other_effects_is_refused():
    world, _ = busy()
    other = World(Effects())
    with pytest.raises(ValueError, match="only the snapshot has continuous, drag"):
        other.restore(world.snapshot())
    with pytest.raises(TypeError, match="snapshot"):
        other.restore("kept.npz")


def test_a_copy_of_a_world_shares_the_values_and_goes_its_own_way():
    """copy.deepcopy of a world gives an independent world with equal digests for equal steps."""
    mask, grid = PixelMask.from_array(np.ones((8, 8), bool)), TileGrid([[True] * 20], 16)
    world = World(Effects(response=True, gravity=True))
    world.add_body(grid, kind="static", position=(0, 100))
    body = world.add_body(mask, position=(100, 40))
    for _ in range(20):
        world.step()
    copied = copy.deepcopy(world)
    assert copied.body(body.id).shapes[0] is mask and copied.digest() == world.digest()
    for _ in range(40):
        world.step()
    assert copied.body(body.id).position != body.position
    copied.add_body(mask, position=(200, 0))
    world.add_body(mask, position=(200, 0))
    for _ in range(40):
        copied.step()
    assert len(copied.library.rasters.rows) == len(world.library.rasters.rows)


def test_neither_a_copy_nor_what_was_copied_disturbs_the_other():
    """Steps of a world and of its copy do not affect each other, although stages keep rows from step to step."""
    world = World()
    world.add_body(Polygon.box(400, 20), kind="static", position=(0, 100))
    for number in range(12):
        world.add_body(Polygon.box(16, 16), position=(18.0 * number - 90.0, 40.0 - 20.0 * (number % 3)))
    alone = copy.deepcopy(world)
    for _ in range(60):
        alone.step()
    copies = []
    for step in range(60):
        if step % 7 == 0:
            copies.append(copy.deepcopy(world))
        before = world.digest()
        for each in copies:
            each.step()
        assert world.digest() == before, f"a copy's step changed the original at step {step}"
        world.step()
    assert world.digest() == alone.digest()
