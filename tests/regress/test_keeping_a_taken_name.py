"""Keep stores a run under a new name if another file has its name; otherwise the run would be
lost after ten more runs.
"""

import os

from game.run.replay_shelf import keep, recent_folder, replays_folder


def test_the_run_gets_a_name_of_its_own():
    recent_folder().mkdir(parents=True)
    mine, theirs = recent_folder() / "arena.json", replays_folder() / "arena.json"
    mine.write_text("mine")
    theirs.write_text("theirs")
    kept = keep(mine)
    assert kept != theirs and kept.read_text() == "mine" and theirs.read_text() == "theirs"
    assert keep(mine) == kept and len(os.listdir(replays_folder())) == 3
