"""Pictures of the games, filmed while their bots play: the small ones that the menu shows of every scene.

Art knows nothing of the games: the program scenes/filming.py films them, and is run here.
"""

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from assets import FOLDER


def filmed(what, *names):
    """Run `python -m scenes.filming` for what it is told; return {file name: bytes} in the order of their names.

    Raises RuntimeError with what the program said when it fails.
    """
    with TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "scenes.filming", what, *names, folder]
        ran = subprocess.run(command, cwd=FOLDER.parent, capture_output=True, text=True)
        if ran.returncode:
            raise RuntimeError(f"{' '.join(command[1:-1])} failed: {ran.stderr.strip()}")
        return {path.name: path.read_bytes() for path in sorted(Path(folder).iterdir())}


def picture_files():
    """Return {relative path: bytes} of the menu's pictures, one per scene, 160 x 90."""
    return {f"images/pictures/{name}": content for name, content in filmed("pictures").items()}
