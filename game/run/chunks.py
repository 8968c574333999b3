"""Compressed store for the bytes of a scene's state. Successive states share the parts in which they are equal.

Arrays are cut into blocks of bytes, called chunks. Tables are cut column by column, since most columns do not change
from one state to the next. Equal chunks are found by Python's hash of their bytes: 64 bits, with a different key in
each process.
"""

import sys
import zlib
from array import array
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

CHUNK = 8192  # bytes: two columns of 500 rows
LOOSE_CHUNK = 24576  # bytes, for data whose position may shift; a little less than the window of zlib (32 kB)
WORD = 8  # bytes: tables whose rows are whole words are stored by columns
ALIGNED = 16  # bytes: kernels are compiled for arrays aligned to their items
LONGEST = 8  # most chunks in a chain in which each is compressed with the previous one as zlib dictionary
WORTH = 0.8  # a dictionary is used if it reduces the compressed size of a chunk below this share
ALIKE = 0.2  # share of the original size below which a chunk with a dictionary is not also tried without one
LEVEL = 6  # of zlib: level 1 is three times as fast, for a sixth more bytes


class Chunk:
    """A block of bytes, possibly compressed.

    like: the chunk at the same position in the previous state, used as the dictionary of the compression; None for no
    dictionary.
    """

    __slots__ = ("data", "hash", "like", "packed")

    def __init__(self, data: bytes, like: "Chunk | None" = None) -> None:
        self.data, self.hash, self.packed = data, hash(data), False
        self.like = like if like is None or like.depth < LONGEST else like.first

    @property
    def depth(self) -> int:
        """Number of other chunks that must be decompressed before this one can be read."""
        return 0 if self.like is None else 1 + self.like.depth

    @property
    def first(self) -> "Chunk":
        """The first chunk of the chain of dictionaries. It can be read without another chunk."""
        return self if self.like is None else self.like.first

    def pack(self) -> None:
        """Compress the chunk if this makes it smaller.

        Use the bytes of `like` as the dictionary if this saves enough.
        """
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
        """Return the original bytes of the chunk."""
        if not self.packed:
            return self.data
        reader = zlib.decompressobj(zdict=self.like.content()) if self.like is not None else zlib.decompressobj()
        return reader.decompress(self.data)


def _deflated(data, dictionary):
    writer = zlib.compressobj(LEVEL, zdict=dictionary) if dictionary else zlib.compressobj(LEVEL)
    return writer.compress(data) + writer.flush()


class Chunks:
    """The contents of several buffers, stored in order as chunks.

    raw: the buffers. widths: size of an array item in each buffer [bytes], 0 if the buffer is not an array. before: the
    Chunks of an earlier state of the same buffers, or None. A chunk that occurs in `before` is not stored again. new:
    list of the chunks that do not occur in `before`.
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
        """Yield all chunks in order. A chunk that occurs several times is yielded each time."""
        return (chunk for part in self.parts for chunk in part)

    def _sizes(self):
        """Return (size, row size) of each buffer [bytes]. _row() defines the row size."""
        count = len(self.layout) // 2
        return zip(self.layout[:count], self.layout[count:], strict=True)

    def contents(self) -> list[memoryview]:
        """Return the contents of the buffers, each as a writable copy."""
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
    """Return the total memory of several Chunks [bytes], including Python's overhead.

    A chunk that several of them share counts once.
    """
    parts = {id(part): part for chunks in many for part in chunks.parts}
    layouts = {id(chunks.layout): chunks.layout for chunks in many}
    each = {id(chunk): chunk for part in parts.values() for chunk in part}
    for chunk in list(each.values()):
        while chunk.like is not None:
            chunk = each.setdefault(id(chunk.like), chunk.like)
    lists = sum(map(sys.getsizeof, parts.values())) + sum(map(sys.getsizeof, layouts.values()))
    return lists + sum(sys.getsizeof(chunk) + sys.getsizeof(chunk.data) + 32 for chunk in each.values())


def _row(size, width):
    """Return the row size of a buffer [bytes]: 0 if it is not an array, 1 for an array that is not stored by columns.

    size: size of the buffer [bytes]; width: size of its array items [bytes], 0 if it is not an array.
    """
    return width if width % WORD == 0 and size > width else min(width, 1)


def _by_columns(view, width):
    """Return the bytes of a table of 8-byte words in the order of its columns. Other data are returned unchanged.

    width: size of a row [bytes].
    """
    if width <= WORD:
        return view
    words = np.frombuffer(view, np.uint64).reshape(-1, width // WORD)
    return np.ascontiguousarray(words.T).data.cast("B")


def _by_rows(data: np.ndarray, width: int) -> np.ndarray:
    """Return the bytes of a table in the order of its rows. This is the inverse of _by_columns().

    width: row size [bytes].
    """
    if width <= WORD:
        return data
    words = np.frombuffer(data, np.uint64).reshape(width // WORD, -1)
    return np.ascontiguousarray(words.T).view(np.uint8).reshape(-1)


def _joined(chunks):
    """Return the contents of several chunks, joined into one writable array of bytes."""
    return np.frombuffer(bytearray(b"".join([chunk.content() for chunk in chunks])), np.uint8)
