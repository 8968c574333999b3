"""Files of precomputed mask outlines. The key of an outline is a hash of the pixels, the settings and the code.

A game ships such a file with its art and registers it with `use`. A game that starts without compiled kernels then need
not compute the outlines. Outlines that are not in a file are computed. If the code or the pixels change, the key
changes.
"""

import hashlib
import zipfile
import zlib
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

DIGEST = 16  # bytes per key
FOLDERS = ("outline", "raster")  # subpackages whose code, with math2d.py and settings.py, determines the parts


class Parts(NamedTuple):
    """Convex parts of an outline: rounded polygons, whose corners are listed part after part."""

    corners: np.ndarray  # (n, 2) float64 [px]
    inner: np.ndarray  # (n,) bool
    counts: np.ndarray  # (k,) int64: corners of each polygon
    radii: np.ndarray  # (k,) float64 [px]


_files: list[Path] = []
_kept: dict[bytes, Parts] = {}
recorded: dict[bytes, Parts] | None = None  # all parts that fitted() returned, for `write`; None: not recorded


def use(path: Path) -> None:
    """Register a file made by `write`, in which `fitted` then looks up outlines. The file is read at the next lookup.

    A missing or damaged file counts as empty.
    """
    _files.append(path)


def forget() -> None:
    """Remove all files and the outlines read from them. Then outlines are computed, until `use` is called again."""
    _files.clear()
    _kept.clear()


def fitted(name: str, pixels: np.ndarray, smooth: float, fit: Callable[[], Parts]) -> Parts:
    """Return the convex parts stored for the outline of these pixels; if none are stored, the result of fit().

    pixels[row, col] bool; smooth [px]: largest distance of the outline from the pixels' edges; name: name of the method
    by which fit() computes the parts. Name, pixels and smooth form the key of the stored parts.
    """
    key = _key(name, pixels, smooth)
    while _files:
        _kept.update(_read(_files.pop()))
    found = _kept.get(key)
    if found is None:
        found = fit()
    if recorded is not None:
        recorded[key] = found
    return found


def _key(name, pixels, smooth):
    digest = hashlib.blake2b(f"{name} {pixels.shape} {smooth!r} ".encode() + code_stamp(), digest_size=DIGEST)
    digest.update(np.packbits(pixels).tobytes())
    return digest.digest()


@cache
def code_stamp() -> bytes:
    """Return a hash of the source files that compute outlines.

    The hash is part of each key, so that parts stored by other code are not used.
    """
    digest, home = hashlib.blake2b(digest_size=DIGEST), Path(__file__).resolve().parents[1]
    paths = [path for folder in FOLDERS for path in (home / folder).glob("*.py") if path != Path(__file__).resolve()]
    for path in sorted((home / "settings.py", home / "math2d.py", *paths)):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.digest()


def write(path: Path, found: Mapping[bytes, Parts]) -> None:
    """Write convex parts with their keys to a file that `use` can read. Equal parts give equal files."""
    order = sorted(found)
    np.savez_compressed(
        path,
        keys=np.frombuffer(b"".join(order), np.uint8).reshape(-1, DIGEST),
        parts=np.array([len(found[key].counts) for key in order], np.int64),
        counts=_joined([found[key].counts for key in order], np.int64),
        radii=_joined([found[key].radii for key in order], np.float64),
        corners=_joined([found[key].corners for key in order], np.float64).reshape(-1, 2),
        inner=_joined([found[key].inner for key in order], np.bool_),
    )


def _joined(arrays, dtype):
    return np.concatenate([np.zeros((0, *arrays[0].shape[1:]), dtype), *arrays]) if arrays else np.zeros(0, dtype)


def _read(path):
    """Return {key: parts} of a file; {} if the file is unreadable, damaged or of another format."""
    try:
        with np.load(path, allow_pickle=False) as file:
            held = {name: file[name] for name in ("keys", "parts", "counts", "radii", "corners", "inner")}
        return _split(**held)
    except (OSError, ValueError, KeyError, IndexError, EOFError, zipfile.BadZipFile, zlib.error):
        return {}


def _split(keys, parts, counts, radii, corners, inner):
    if not (len(keys) == len(parts) and parts.sum() == len(counts) == len(radii)):
        raise ValueError("the numbers of parts do not agree")
    if not (counts.sum() == len(corners) == len(inner) and (counts > 0).all() and (parts >= 0).all()):
        raise ValueError("the numbers of corners do not agree")
    found, part, corner = {}, 0, 0
    for key, count in zip(keys, parts.tolist(), strict=True):
        own = slice(part, part + count)
        end = corner + int(counts[own].sum())
        found[key.tobytes()] = Parts(corners[corner:end], inner[corner:end], counts[own], radii[own])
        part, corner = part + count, end
    return found
