"""Bytes of one moment that share with those of the moment before what did not change, and the rest compressed.

Arrays are cut into chunks, tables column by column, since most columns of a table stay as they are. A chunk is known
again by Python's hash of its bytes, 64 bits under a key of their own in each process.
"""

import sys
import zlib
from array import array
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

CHUNK = 8192  # bytes: two columns of 500 rows
LOOSE_CHUNK = 24576  # bytes, of what may begin elsewhere each time: so far back, and a little, zlib looks (32 kB)
WORD = 8  # bytes: tables whose rows are whole words are laid out by columns
ALIGNED = 16  # bytes: kernels are compiled for arrays that begin at a multiple of their items
LONGEST = 8  # chunks that are each read by the one before, the last but one by itself
WORTH = 0.8  # of a chunk's bytes compressed by itself, below which it is kept as what differs from another
ALIKE = 0.2  # of a chunk's bytes as what differs from another, below which nobody looks what it takes by itself
LEVEL = 6  # zlib's: level 1 is three times as fast, for a sixth more bytes


class Chunk:
    """Some bytes, perhaps compressed. like: the chunk that stood in its place before, or None."""

    __slots__ = ("data", "hash", "like", "packed")

    def __init__(self, data: bytes, like: "Chunk | None" = None) -> None:
        self.data, self.hash, self.packed = data, hash(data), False
        self.like = like if like is None or like.depth < LONGEST else like.first

    @property
    def depth(self) -> int:
        """How many others are read for it."""
        return 0 if self.like is None else 1 + self.like.depth

    @property
    def first(self) -> "Chunk":
        """The one of these that is read by itself."""
        return self if self.like is None else self.like.first

    def pack(self) -> None:
        """Compress it, if that makes it smaller: by itself, unless the other one's bytes as dictionary do better."""
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
        """The bytes it was made of."""
        if not self.packed:
            return self.data
        reader = zlib.decompressobj(zdict=self.like.content()) if self.like is not None else zlib.decompressobj()
        return reader.decompress(self.data)


def _deflated(data, dictionary):
    writer = zlib.compressobj(LEVEL, zdict=dictionary) if dictionary else zlib.compressobj(LEVEL)
    return writer.compress(data) + writer.flush()


class Chunks:
    """What `raw` holds, in its order; `widths`: bytes of an item of each, 0 where it is no array.

    before: an earlier one of the same things, whose chunks may be shared. `new`: those that are not.
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
        self.parts: list[tuple[Chunk, ...]] = []  # of the small ones joined, then of each large one
        for view, width in zip(raw, rows, strict=True):
            size = view.nbytes
            if size < CHUNK:
                small += [_by_columns(view, width), bytes(-size % ALIGNED)]
            else:
                self.parts.append(
                    self._cut(_by_columns(view, width), known, next(old, ()), CHUNK if width else LOOSE_CHUNK)
                )
        self.parts.insert(0, self._cut(memoryview(b"".join(small)), known, past, LOOSE_CHUNK))
        if before is not None:  # the same chunks in the same order: one list for both
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
        """Every chunk, some more than once."""
        return (chunk for part in self.parts for chunk in part)

    def _sizes(self):
        """(bytes, bytes of a row) of each."""
        count = len(self.layout) // 2
        return zip(self.layout[:count], self.layout[count:], strict=True)

    def contents(self) -> list[memoryview]:
        """What was given, anew, to be written to."""
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
    """Bytes that these hold together, a chunk that several share once, with what Python takes to keep them."""
    parts = {id(part): part for chunks in many for part in chunks.parts}
    layouts = {id(chunks.layout): chunks.layout for chunks in many}
    each = {id(chunk): chunk for part in parts.values() for chunk in part}
    for chunk in list(each.values()):
        while chunk.like is not None:
            chunk = each.setdefault(id(chunk.like), chunk.like)
    lists = sum(map(sys.getsizeof, parts.values())) + sum(map(sys.getsizeof, layouts.values()))
    return lists + sum(sys.getsizeof(chunk) + sys.getsizeof(chunk.data) + 32 for chunk in each.values())


def _row(size, width):
    """Bytes of a row of a table; of anything else 1, or 0 as it was given."""
    return width if width % WORD == 0 and size > width else min(width, 1)


def _by_columns(view, width):
    """The same bytes, word by word of all rows."""
    if width <= WORD:
        return view
    words = np.frombuffer(view, np.uint64).reshape(-1, width // WORD)
    return np.ascontiguousarray(words.T).data.cast("B")


def _by_rows(data: np.ndarray, width: int) -> np.ndarray:
    """The reverse."""
    if width <= WORD:
        return data
    words = np.frombuffer(data, np.uint64).reshape(width // WORD, -1)
    return np.ascontiguousarray(words.T).view(np.uint8).reshape(-1)


def _joined(chunks):
    """One array of their bytes, to be written to."""
    return np.frombuffer(bytearray(b"".join([chunk.content() for chunk in chunks])), np.uint8)
