"""A PNG larger than the limit is not decoded, because its size is read from the header first."""

import struct
import zlib

import pygame
import pytest

from game.errors import FileError
from scenes.lab.ladder import MOST, Ladder, own_picture
from scenes.platformer.level import level_of
from tests.scenes.test_platformer_maps import save, small

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def png(width, height, kind=b"IHDR"):
    """Return the bytes of a PNG file whose header states a size; the pixel data is not valid."""
    head = chunk(kind, struct.pack(">2I5B", width, height, 8, 6, 0, 0, 0))
    return SIGNATURE + head + chunk(b"IDAT", zlib.compress(bytes(64))) + chunk(b"IEND", b"")


def other(kind):
    """Return the bytes of a picture in another format, as pygame writes it. kind: file extension."""
    from io import BytesIO

    file, picture = BytesIO(), pygame.Surface((8, 8))
    picture.fill((200, 100, 50))
    pygame.image.save(picture, file, f"picture.{kind}")
    return file.getvalue()


@pytest.fixture
def nothing_decoded(monkeypatch):
    def load(*arguments):
        raise AssertionError("the picture was decoded")

    monkeypatch.setattr(pygame.image, "load", load)


def put(folder, content):
    path = folder / "mine.png"
    path.write_bytes(content)
    return path


def tileset(folder, content):
    put(folder, content)
    level = small()
    level["tilesets"][0]["image"] = "mine.png"
    return save(folder, level)


DOORS = {
    "the ladder": lambda folder, content: own_picture(put(folder, content)),
    "a tileset": lambda folder, content: level_of(tileset(folder, content)),
}
SIZES = [(MOST, 2**31 - 1), (2**31 - 1, MOST), (20_000, 20_000), (2**31 - 1, 2**31 - 1), (2**32 - 1, 1), (5000, 4)]


@pytest.mark.parametrize("width, height", SIZES)
@pytest.mark.parametrize("door", DOORS)
def test_a_huge_picture_is_refused_with_its_size_and_what_is_allowed(tmp_path, nothing_decoded, door, width, height):
    with pytest.raises(FileError, match=rf"mine\.png: picture: is {width} x {height} px, at most \d+ go each way"):
        DOORS[door](tmp_path, png(width, height))


@pytest.mark.parametrize("width, height", [(0, 4), (4, 0), (0, 0)])
@pytest.mark.parametrize("door", DOORS)
def test_a_picture_without_a_pixel(tmp_path, nothing_decoded, door, width, height):
    with pytest.raises(FileError, match=rf"picture: is {width} x {height} px"):
        DOORS[door](tmp_path, png(width, height))


SPOILT = {
    "nothing": b"",
    "cut in the signature": SIGNATURE[:5],
    "cut in the header": png(9, 9)[:20],
    "another first chunk": png(9, 9, b"IEND"),
    "text": b"a picture of a ship, in words" * 3,
    "bmp": other("bmp"),
    "jpg": other("jpg"),
    "tga": other("tga"),
}


@pytest.mark.parametrize("content", SPOILT.values(), ids=SPOILT)
@pytest.mark.parametrize("door", DOORS)
def test_what_is_no_png_is_not_decoded(tmp_path, nothing_decoded, door, content):
    with pytest.raises(FileError, match="picture: is no PNG file"):
        DOORS[door](tmp_path, content)


def test_the_largest_is_taken(tmp_path):
    pygame.display.init()
    pygame.display.set_mode((480, 270))
    picture = pygame.Surface((MOST, MOST))
    picture.fill((90, 160, 220))
    path = tmp_path / "mine.png"
    pygame.image.save(picture, path)
    assert own_picture(path)[1].area == MOST * MOST


def test_a_folder_or_a_file_that_is_not_there(tmp_path):
    for path in (tmp_path, tmp_path / "none.png"):
        with pytest.raises(FileError):
            Ladder(level=path)
