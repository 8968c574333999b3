"""`python -m tests.advised [SCENE ...]`: request advice on every scene twice and store it in docs/advice.json.

Only advice given by both runs counts. tests/scenes/test_advised.py compares the scenes with it: each scene follows the
advice or states a reason in its attribute `keeps`.
"""

import json
import subprocess
import sys
from pathlib import Path

from game.measure.errors import VISIBLE
from game.measure.machine import machine
from game.run.options import DEFAULT_FRAMES
from scenes import SCENES

ROOT = Path(__file__).resolve().parent.parent
KEPT = ROOT / "docs" / "advice.json"
# How long each is played, where ten seconds are not what it is made for: to the boss and its 1,500 bullets.
FRAMES = {"shooter": 13000, "lab/disagreement": 3600}
TIMES = 2  # that each scene is measured; an advice that comes only once is chance
ARGUMENTS = ("--error", f"{VISIBLE:g}", "--json")


def frames_of(name: str) -> int:
    """Return the number of frames that the bot plays in a scene."""
    return FRAMES.get(name, DEFAULT_FRAMES)


def ask(name: str) -> dict:
    """Run `main.py --advise` on a scene and return its advice. Raises CalledProcessError if the scene cannot be
    measured.
    """
    command = [sys.executable, "main.py", "--advise", name, *ARGUMENTS, "--frames", str(frames_of(name))]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if done.returncode not in (0, 1):  # 1: nothing is within the error
        raise subprocess.CalledProcessError(done.returncode, command, done.stdout, done.stderr)
    reported = json.loads(done.stdout.splitlines()[-1])
    changes = {each: reported["best"][each] for each in reported["changes"]}
    found = {"changes": changes, "within": [each for each in reported["within"] if each == reported["here"]] != []}
    if changes:
        found |= {"share": round(reported["share"], 3), "interval": [round(each, 3) for each in reported["interval"]]}
    return {"here": reported["here"], "run": found}


def agreed(runs: list[dict]) -> dict:
    """Return the changes that every run advises, {name: value}."""
    first, *others = (run["changes"] for run in runs)
    return {name: value for name, value in first.items() if all(other.get(name) == value for other in others)}


def main(names: list[str]) -> None:
    """Measure the named scenes and write docs/advice.json after every scene, so that an interrupted run is not lost."""
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {"scenes": {}}
    kept["command"] = f"python main.py --advise SCENE {' '.join(ARGUMENTS)} --frames FRAMES"
    kept["machine"] = machine()
    for name in names:
        answers = [ask(name) for _ in range(TIMES)]
        kept["scenes"][name] = {
            "frames": frames_of(name),
            "here": answers[0]["here"],
            "runs": [each["run"] for each in answers],
        }
        print(name, agreed(kept["scenes"][name]["runs"]), kept["scenes"][name]["runs"], flush=True)
        write(kept)


def write(kept: dict) -> None:
    """Write docs/advice.json from `kept`, with one line for each scene, in the order of the menu."""
    rows = [f"  {json.dumps(name)}: {json.dumps(kept['scenes'][name])}" for name in SCENES if name in kept["scenes"]]
    head = "".join(f" {json.dumps(key)}: {json.dumps(kept[key])},\n" for key in ("command", "machine"))
    KEPT.write_text(f'{{\n{head} "scenes": {{\n' + ",\n".join(rows) + "\n }\n}\n", encoding="utf-8")


if __name__ == "__main__":
    unknown = [name for name in sys.argv[1:] if name not in SCENES]
    if unknown:
        raise SystemExit(f"no scene is called {', '.join(unknown)}; scenes: {', '.join(SCENES)}")
    main(sys.argv[1:] or list(SCENES))
