"""PNG files from arrays, written without an imaging library, so that their bytes depend on zlib alone.

`payload` returns data that do not even depend on zlib: two files show the same picture if their headers and their
decompressed rows are equal.
"""

import struct
import zlib

import numpy as np

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def encode(pixels):
    """Return the bytes of an 8-bit PNG. pixels: (h, w, 4) or (h, w, 3) uint8.

    Raises ValueError for another shape or type.
    """
    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] not in (3, 4):
        raise ValueError(f"pixels must be uint8 of shape (h, w, 3) or (h, w, 4) (got {pixels.dtype} {pixels.shape})")
    height, width, channels = pixels.shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)  # the leading 0 of a row: filter "none"
    rows[:, 1:] = pixels.reshape(height, width * channels)
    header = struct.pack(">IIBBBBB", width, height, 8, 6 if channels == 4 else 2, 0, 0, 0)
    return (
        SIGNATURE + _chunk(b"IHDR", header) + _chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + _chunk(b"IEND", b"")
    )


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def payload(png):
    """Return (header bytes, decompressed row bytes) of a PNG, which do not depend on its compression.

    Raises ValueError if the bytes are not a whole PNG.
    """
    if not png.startswith(SIGNATURE):
        raise ValueError("not a PNG: the signature is missing")
    at, header, packed = len(SIGNATURE), b"", b""
    while at + 12 <= len(png):
        size, kind = struct.unpack(">I4s", png[at : at + 8])
        data = png[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            header = data
        elif kind == b"IDAT":
            packed += data
        elif kind == b"IEND":
            try:
                return header, zlib.decompress(packed)
            except zlib.error as error:
                raise ValueError(f"not a whole PNG: {error}") from error
        at += 12 + size
    raise ValueError("not a whole PNG: the end marker is missing")


def decode(png):
    """Return the pixels (h, w, channels) uint8 of a PNG written by `encode`. Raises ValueError for other PNGs."""
    header, rows = payload(png)
    width, height, depth, colour = struct.unpack(">IIBB", header[:10])
    channels = {2: 3, 6: 4}.get(colour)
    if depth != 8 or channels is None:
        raise ValueError(f"only 8-bit RGB and RGBA are read here (got depth {depth}, colour type {colour})")
    table = np.frombuffer(rows, np.uint8).reshape(height, 1 + width * channels)
    if table[:, 0].any():
        raise ValueError("only unfiltered rows are read here")
    return table[:, 1:].reshape(height, width, channels).copy()
