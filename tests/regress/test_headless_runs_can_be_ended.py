"""A run without a window ends on SIGTERM, which SDL would otherwise turn into an event."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

MAIN = Path(__file__).resolve().parents[2] / "main.py"


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
def test_it_ends(tmp_path):
    # It has begun once its display is open, which is when SDL takes what signals it can.
    watched = (
        "import main, game.run.headless as h; start = h.start_dummy_display; "
        "h.start_dummy_display = lambda: (start(), print('open', flush=True)); "
        "main.main(['--scene', 'lab/cradle', '--headless', '--frames', '100000000'])"
    )
    program = subprocess.Popen([sys.executable, "-c", watched], cwd=MAIN.parent, stdout=subprocess.PIPE, text=True)
    try:
        while "open" not in program.stdout.readline():
            assert program.poll() is None
        program.send_signal(signal.SIGTERM)
        assert program.wait(20) == -signal.SIGTERM
    finally:
        program.kill()
        program.stdout.close()
