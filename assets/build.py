"""Write every file of assets/ that a script makes, or check that the files in the folder are up to date.

python -m assets.build            regenerate all
python -m assets.build sounds     only products whose name contains "sounds"
python -m assets.build --check    regenerate in memory; exit 1 and name the files that differ
"""

import argparse
import importlib
import sys

from assets import FOLDER
from assets.audio import music, sounds
from assets.craft import ogg, png
from assets.craft.ogg import Recording

# name of the product -> (module, of this package if it begins with a dot, function, arguments); imported when built.
PRODUCTS = {
    "font/font5x7": (".ui.font", "font_files", ("font5x7",)),
    "font/font3x5": (".ui.font", "font_files", ("font3x5",)),
    **sounds.PRODUCTS,
    **music.PRODUCTS,
    "images/planes": (".shooter.aircraft", "planes_files", ()),
    "images/effects": (".shooter.effects", "effects_files", ()),
    "images/hero": (".platformer.hero", "hero_files", ()),
    "images/things": (".platformer.things", "things_files", ()),
    "images/lab": (".lab.pieces", "lab_files", ()),
    "images/backdrops_lab": (".lab.earth", "earth_files", ()),
    "images/tiles": (".platformer.tiles", "tiles_files", ()),
    "images/lander": (".lander.sheet", "lander_files", ()),
    "images/backdrops_lander": (".lander.heavens", "heavens_files", ()),
    "images/backdrops_lander_ground": (".lander.ground", "ground_files", ()),
    "images/ui": (".ui.sheet", "ui_files", ()),
    "images/backdrops_shooter": (".shooter.backdrops", "backdrop_files", ()),
    "images/backdrops_platformer": (".platformer.backdrops", "backdrop_files", ()),
    "images/pictures": (".publish.films", "picture_files", ()),
    "levels/platformer": (".platformer.tiled", "level_files", ()),
}


def make(name):
    """Return the files of one product without writing them, {path relative to assets/: content}.

    A content is the bytes of the file, or a Recording that is still to be encoded. Raises KeyError, which names the
    valid products, for an unknown name.
    """
    if name not in PRODUCTS:
        raise KeyError(f"no product {name!r}; choose one of {', '.join(PRODUCTS)}")
    module, function, arguments = PRODUCTS[name]
    return getattr(importlib.import_module(module, __package__), function)(*arguments)


def differences(name):
    """Return the paths of one product's files that are missing from the folder or differ from the script's result.

    A PNG is compared by header and inflated rows, because another build of zlib compresses the same picture
    differently. A tune is compared by the hash of its samples, stored beside it, and by decoding the file
    (craft/ogg.py).
    """
    wrong = []
    for path, made in make(name).items():
        target = FOLDER / path
        if not target.is_file() or not _same(path, target.read_bytes(), made):
            wrong.append(path)
    return wrong


def _same(path, kept, made):
    if isinstance(made, Recording):
        return made.is_kept_in(kept)
    if kept == made:
        return True
    if not path.endswith(".png"):
        return False
    try:
        return png.payload(kept) == png.payload(made)
    except ValueError:
        return False


def write(name):
    """Write one product's files. Return a list of their paths relative to assets/.

    An existing recording of the same samples is kept, because encoding the same samples again gives other bytes.
    """
    files = make(name)
    for path, content in files.items():
        target = FOLDER / path
        target.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, Recording):
            if target.is_file() and content.is_kept_in(target.read_bytes()):
                continue
            content = content.encoded()
        target.write_bytes(content)
    return list(files)


def main(arguments=None):
    """Run the command line. Return the exit code: 0 success, 1 a file differs, 2 an unknown name."""
    parser = argparse.ArgumentParser(
        prog=f"python -m {__package__}.build", description="Write or check the files of assets/."
    )
    parser.add_argument("part", nargs="?", default="", help="only products whose name contains this")
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 if a file differs")
    options = parser.parse_args(arguments)
    names = [name for name in PRODUCTS if options.part in name]
    if not names:
        sys.stderr.write(f"no product contains {options.part!r}; there are: {', '.join(PRODUCTS)}\n")
        return 2
    if options.check:
        wrong = [path for name in names for path in differences(name)]
        if not ogg.is_available() and any(name in music.PRODUCTS for name in names):
            sys.stderr.write(
                "soundfile is not installed: tunes were checked by their samples' hashes and their lengths, "
                "not by decoding them\n"
            )
        for path in wrong:
            sys.stderr.write(f"assets/{path} differs from what its script makes\n")
        return 1 if wrong else 0
    for name in names:
        for path in write(name):
            sys.stdout.write(f"assets/{path}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
