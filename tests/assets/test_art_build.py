"""The files in assets/ equal the output of their scripts to the bit, in two runs."""

import numpy as np
import pytest

from assets import FOLDER, build
from assets.craft import png

FAST = (
    "font/font5x7",
    "font/font3x5",
    "sounds/laser",
    "sounds/coin",
    "images/planes",
    "images/hero",
    "images/tiles",
    "images/lander",
    "levels/platformer",
)
PLAYED = "images/pictures"  # of every scene, after its bot has played: forty seconds


@pytest.mark.parametrize("name", FAST)
def test_product_regenerates_bit_identical(name):
    assert build.make(name) == build.make(name)
    assert build.differences(name) == [], f"run: python -m assets.build {name}"


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.nightly if name == PLAYED else ())
        for name in build.PRODUCTS
        if name not in FAST
    ],
)
def test_every_other_product_regenerates_bit_identical(name):
    assert build.differences(name) == [], f"run: python -m assets.build {name}"


def test_every_made_kind_of_file_in_the_folder_has_a_product():
    made = {"images": "*.*", "sounds": "*.*", "music": "*.*", "font": "*.*", "levels": "*.tmj"}
    kept = {f"{folder}/{path.stem}" for folder, pattern in made.items() for path in (FOLDER / folder).glob(pattern)}
    products = {name for name in build.PRODUCTS if "backdrops" not in name and "pictures" not in name}
    assert products <= kept
    layers = {
        "sea",
        "coast",
        "storm",
        "clouds_low",
        "cloud_shadows",
        "clouds_high",
        "clouds_storm",
        "sky_dusk",
        "mountains_far",
        "mountains_mid",
        "mountains_near",
        "keep_far",
        "clouds",
        "cave_far",
        "cave_near",
        "lab_earth",
        "lab_earth_wall",
        "lander_sky",
        "lander_clouds",
        "lander_far",
        "lander_mid",
        "lander_near",
        "lander_ground",
        "lander_wall",
    }
    assert kept - products == {f"images/{layer}" for layer in layers}  # their products make several at once


def test_check_names_a_changed_pixel(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(build, "FOLDER", tmp_path)
    build.write("font/font3x5")
    assert build.main(["font/font3x5", "--check"]) == 0
    target = tmp_path / "font" / "font3x5.png"
    pixels = png.decode(target.read_bytes())
    pixels[0, 0] = 255 - pixels[0, 0]
    target.write_bytes(png.encode(pixels))
    assert build.main(["font/font3x5", "--check"]) == 1
    assert "font/font3x5.png" in capsys.readouterr().err


def test_unknown_part_exits_2_and_names_the_valid_ones(capsys):
    assert build.main(["no such part"]) == 2
    assert "images/planes" in capsys.readouterr().err
    with pytest.raises(KeyError, match="images/planes"):
        build.make("images/plane")


def test_png_round_trip_and_refusals():
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 4)).astype(np.uint8)
    packed = png.encode(pixels)
    assert (png.decode(packed) == pixels).all()
    with pytest.raises(ValueError, match="signature"):
        png.payload(b"GIF89a")
    with pytest.raises(ValueError, match="whole"):
        png.payload(packed[:-20])
    with pytest.raises(ValueError, match="shape"):
        png.encode(np.zeros((3, 3), np.uint8))
