"""A compressed store for the bytes of a moment that shares unchanged chunks with the moment before.

Arrays are cut into chunks. Tables are cut column by column, since most columns of a table stay the same. A chunk is
recognised by Python's hash of its bytes: 64 bits, with a different key in each process.
"""

import sys
import zlib
from array import array
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

CHUNK = 8192  # bytes: two columns of 500 rows
LOOSE_CHUNK = 24576  # bytes, of data whose start may shift; a little less than the window of zlib (32 kB)
WORD = 8  # bytes: tables whose rows are whole words are stored by columns
ALIGNED = 16  # bytes: kernels are compiled for arrays aligned to their items
LONGEST = 8  # largest depth of a chain of chunks, each compressed with the one before as dictionary
WORTH = 0.8  # a chunk is stored relative to another if this takes less than WORTH of its own compressed size
ALIKE = 0.2  # below this share of its size relative to another, a chunk is not compressed by itself for comparison
LEVEL = 6  # of zlib: level 1 is three times as fast, for a sixth more bytes


class Chunk:
    """Some bytes, perhaps compressed. like: the chunk at the same place before, or None."""

    __slots__ = ("data", "hash", "like", "packed")

    def __init__(self, data: bytes, like: "Chunk | None" = None) -> None:
        self.data, self.hash, self.packed = data, hash(data), False
        self.like = like if like is None or like.depth < LONGEST else like.first

    @property
    def depth(self) -> int:
        """The number of other chunks that are needed to read it."""
        return 0 if self.like is None else 1 + self.like.depth

    @property
    def first(self) -> "Chunk":
        """The chunk at the start of the chain, which is read without another."""
        return self if self.like is None else self.like.first

    def pack(self) -> None:
        """Compress the chunk if that makes it smaller. The bytes of `like` are the dictionary if this saves enough."""
        by_like = None if self.like is None else _deflated(self.data, self.like.content())
        alike = by_like is not None and len(by_like) < ALIKE * len(self.data)
        own = b"" if alike else _deflated(self.data, b"")
        if by_like is not None and (alike or len(by_like) < WORTH * len(own)):
            self.data, self.packed = by_like, True
            return
        self.like = None
        if len(own) < len(self.data):
            self.data, self.packed = own, True

    def content(self) -> bytes:
        """Return the original bytes."""
        if not self.packed:
            return self.data
        reader = zlib.decompressobj(zdict=self.like.content()) if self.like is not None else zlib.decompressobj()
        return reader.decompress(self.data)


def _deflated(data, dictionary):
    writer = zlib.compressobj(LEVEL, zdict=dictionary) if dictionary else zlib.compressobj(LEVEL)
    return writer.compress(data) + writer.flush()


class Chunks:
    """The bytes of several buffers, in order, as chunks.

    raw: the buffers. widths: bytes of an item of each, 0 if it is not an array. before: an earlier Chunks of the same
    buffers, to share chunks with. `new`: the chunks that are not shared.
    """

    def __init__(self, raw: Sequence[memoryview], widths: Sequence[int], before: "Chunks | None" = None) -> None:
        known = {chunk.hash: chunk for chunk in before} if before is not None else {}
        self.new: list[Chunk] = []
        rows = [_row(view.nbytes, width) for view, width in zip(raw, widths, strict=True)]
        self.layout = array("q", [*(view.nbytes for view in raw), *rows])
        if before is not None and before.layout == self.layout:
            self.layout = before.layout
        small = []
        old = iter(before.parts if before is not None else ())
        past = next(old, ())
        self.parts: list[tuple[Chunk, ...]] = []  # of the small buffers joined, then of each large one
        for view, width in zip(raw, rows, strict=True):
            size = view.nbytes
            if size < CHUNK:
                small += [_by_columns(view, width), bytes(-size % ALIGNED)]
            else:
                self.parts.append(
                    self._cut(_by_columns(view, width), known, next(old, ()), CHUNK if width else LOOSE_CHUNK)
                )
        self.parts.insert(0, self._cut(memoryview(b"".join(small)), known, past, LOOSE_CHUNK))
        if before is not None:  # equal parts are stored once
            for number, (part, old) in enumerate(zip(self.parts, before.parts, strict=False)):
                if part == old:
                    self.parts[number] = old

    def _cut(self, view, known, past, size):
        chunks = []
        for number, start in enumerate(range(0, len(view), size)):
            like = past[number] if number < len(past) else None
            chunk = Chunk(bytes(view[start : start + size]), like)
            same = known.get(chunk.hash)
            if same is None:
                known[chunk.hash] = chunk
                self.new.append(chunk)
            chunks.append(same or chunk)
        return tuple(chunks)

    def __iter__(self) -> Iterator[Chunk]:
        """Iterate over every chunk; shared ones come more than once."""
        return (chunk for part in self.parts for chunk in part)

    def _sizes(self):
        """Return (bytes, bytes of a row) of each buffer."""
        count = len(self.layout) // 2
        return zip(self.layout[:count], self.layout[count:], strict=True)

    def contents(self) -> list[memoryview]:
        """Return writable copies of the buffers."""
        parts = iter(self.parts)
        small = _joined(next(parts))
        found, at = [], 0
        for size, width in self._sizes():
            if size < CHUNK:
                part, at = small[at : at + size], at + size + -size % ALIGNED
            else:
                part = _joined(next(parts))
            found.append(_by_rows(part, width).data)
        return found


def bytes_of(many: Iterable[Chunks]) -> int:
    """Return the bytes that these hold together, with Python's overhead; shared chunks count once."""
    parts = {id(part): part for chunks in many for part in chunks.parts}
    layouts = {id(chunks.layout): chunks.layout for chunks in many}
    each = {id(chunk): chunk for part in parts.values() for chunk in part}
    for chunk in list(each.values()):
        while chunk.like is not None:
            chunk = each.setdefault(id(chunk.like), chunk.like)
    lists = sum(map(sys.getsizeof, parts.values())) + sum(map(sys.getsizeof, layouts.values()))
    return lists + sum(sys.getsizeof(chunk) + sys.getsizeof(chunk.data) + 32 for chunk in each.values())


def _row(size, width):
    """Return the bytes of a row of a table; 1 for other arrays, 0 for other data."""
    return width if width % WORD == 0 and size > width else min(width, 1)


def _by_columns(view, width):
    """Return the bytes ordered by columns of words."""
    if width <= WORD:
        return view
    words = np.frombuffer(view, np.uint64).reshape(-1, width // WORD)
    return np.ascontiguousarray(words.T).data.cast("B")


def _by_rows(data: np.ndarray, width: int) -> np.ndarray:
    """Return the bytes ordered by rows: the inverse of _by_columns."""
    if width <= WORD:
        return data
    words = np.frombuffer(data, np.uint64).reshape(width // WORD, -1)
    return np.ascontiguousarray(words.T).view(np.uint8).reshape(-1)


def _joined(chunks):
    """Return one writable array of the bytes of chunks."""
    return np.frombuffer(bytearray(b"".join([chunk.content() for chunk in chunks])), np.uint8)
