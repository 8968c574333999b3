"""Pictures of the games, taken while bots play them: the menu's small pictures of all scenes.

The scripts of assets/ do not import the games, so this module runs the program scenes/filming.py, which takes the
pictures.
"""

import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from assets import FOLDER

ABOVE = __name__.split(".")[:-3]  # the package that holds this one, [] in a checkout
PROGRAM = ".".join([*ABOVE, "scenes", "filming"])
ROOT = FOLDER.parents[len(ABOVE)]  # where the names are looked up


def filmed(what, *names):
    """Run `python -m scenes.filming` with the arguments `what` and `names`, and return {file name: bytes} of its
    files.

    The dict is in the order of the file names. Raises RuntimeError with the program's output if the program fails.
    """
    with TemporaryDirectory() as folder:
        command = [sys.executable, "-P", "-m", PROGRAM, what, *names, folder]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        ran = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
        if ran.returncode:
            raise RuntimeError(f"{' '.join(command[1:-1])} failed: {ran.stderr.strip()}")
        return {path.name: path.read_bytes() for path in sorted(Path(folder).iterdir())}


def picture_files():
    """Return {path relative to assets/: bytes} of the menu's pictures, one for each scene, 160 x 90 px."""
    return {f"images/pictures/{name}": content for name, content in filmed("pictures").items()}
