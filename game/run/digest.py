"""Digest (hash) of a scene's complete state: its worlds in order of creation, its own state, its random generator."""

import struct
from hashlib import blake2b

from game.scene import Scene


def scene_digest(scene: Scene) -> str:
    """Return the digest of the scene's worlds, Scene.state() and random generator, as 32 hex digits.

    Floats are hashed by their bits, with -0.0 as 0.0. Raises TypeError if Scene.state() contains a type that cannot be
    hashed.
    """
    digest = blake2b(digest_size=16)
    for world in scene.worlds:
        digest.update(world.digest().encode())
    for value in scene.state():
        digest.update(_bytes_of(value))
    version, words, gauss = scene.random.getstate()
    digest.update(struct.pack(f"<q{len(words)}Q", version, *words))
    digest.update(_bytes_of(gauss))
    return digest.hexdigest()


def _bytes_of(value):
    if value is None:
        return b"n"
    if isinstance(value, str):
        raw = value.encode()
        return b"s" + struct.pack("<q", len(raw)) + raw
    if hasattr(value, "item"):  # a NumPy scalar is hashed as the Python number it holds
        value = value.item()
    if isinstance(value, int):
        return b"i" + struct.pack("<q", value)
    if isinstance(value, float):
        return b"f" + struct.pack("<d", value + 0.0)
    raise TypeError(f"state() may hold int, float, bool, str or None (got {type(value).__name__})")
