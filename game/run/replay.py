"""Recordings: the seed, the input of every step, and digests of the scene's state.

A replay runs the scene again and reports the first frame whose digest differs. The file is JSON. Repeated input takes
one line, so that the file can be read, compared and repaired by hand. Version 2 adds level, date and result; version 1
can still be read. A recording of another physics version is also played, but its first difference is only noted.
"""

import json
from pathlib import Path
from time import strftime
from typing import Any

from game.errors import FileError, ReplayDiverged, brief
from game.files.data_folder import write_atomically
from game.files.json_file import read_json
from game.files.own_levels import level_digest
from game.input.inputs import ACTIONS, NOTHING, InputFrame
from game.run.digest import scene_digest
from game.scene import ASSISTS, Result, Scene
from physics import PHYSICS_VERSION

FORMAT, VERSION = "hitbox replay", 2
DIGEST_EVERY = 1  # frames; 1 names the diverging frame exactly, and costs 0.1 ms a frame in the games
KEPT_EVERY = 30  # frames between two digests in automatic recordings: half a second is exact enough
DIGITS = 16  # hex digits kept per frame: 64 bits
LONGEST = 24 * 60 * 60 * 60  # frames: a day; without a limit a small file could exhaust the memory
LARGEST_SEED = 2**62  # the physics takes 63 bits, and each further world of a scene adds one
FARTHEST = 1_000_000  # limit of the pointer [canvas px] and of the wheel [notches]
LONGEST_DATE = 40  # characters
MOST_POINTS = 10**15


class Recorder:
    """Recorder of a run. It stores the input of each step.

    After every `every` frames it also stores a digest of the scene's state.
    """

    def __init__(self, scene: Scene, bot: bool = False, every: int = DIGEST_EVERY) -> None:
        level = scene.level_file
        self.every = every
        self.head = {
            "format": FORMAT,
            "version": VERSION,
            "physics": PHYSICS_VERSION,
            "scene": scene.name,
            "seed": scene.seed,
            "broadphase": scene.broadphase,
            "solver": scene.solver,
            "tier": scene.tier,
            "level": None if level is None else {"path": str(level), "digest": level_digest(level)},
            "bot": bot,
            "date": strftime("%Y-%m-%d %H:%M"),
            "every": every,
        }
        self.frames = 0
        self.runs = []  # [repeats, InputFrame]
        self.digests = []

    def note(self, frame: InputFrame, scene: Scene) -> None:
        """Record a step. Call this after the step. frame: input of the step."""
        self.frames += 1
        if self.runs and self.runs[-1][1] == frame:
            self.runs[-1][0] += 1
        else:
            self.runs.append([1, frame])
        if self.frames % self.every == 0:
            self.digests.append(scene_digest(scene)[:DIGITS])

    def cut(self, frames: int) -> None:
        """Remove all but the first `frames` frames.

        This is called when the player has rewound to that frame and continues there.
        """
        left = self.frames - frames
        self.frames -= max(0, left)
        while left > 0:
            taken = min(left, self.runs[-1][0])
            self.runs[-1][0] -= taken
            left -= taken
            if not self.runs[-1][0]:
                self.runs.pop()
        del self.digests[self.frames // self.every :]

    def save(self, path: str | Path, result: Result | None = None) -> None:
        """Write the recording to a file.

        result: result of the game, or None if the game has not ended. Raises OSError.
        """
        ended = result and {"won": bool(result.won), "points": int(result.points), "seconds": float(result.seconds)}
        head = {**self.head, "result": ended, "frames": self.frames}
        lines = [json.dumps(head)[:-1] + ",", '"inputs": [']
        lines.append(",\n".join(json.dumps([count, _to_json(frame)]) for count, frame in self.runs))
        lines += ["],", '"digests": [', ",\n".join(json.dumps(digest) for digest in self.digests), "]}"]
        write_atomically(path, "\n".join(lines) + "\n")


def chosen_before(scene: Scene) -> list[tuple[str, Any]]:
    """Return the changes that give a new scene the current settings of `scene`, a list of (name, value).

    Settings that the head of a recording contains are not included.
    """
    changes: list[tuple[str, Any]] = [
        (f"slider:{s.name}", scene.values[s.name]) for s in scene.sliders if scene.values[s.name] != s.start
    ]
    if scene.narrowphase != scene.effects.narrowphase:
        changes.append(("narrowphase", scene.narrowphase))
    if scene.substeps is not None:
        changes.append(("substeps", scene.substeps))
    return changes + [(f"assist:{name}", on) for name, on in scene.assist.items() if on != ASSISTS[name]]


class Replay:
    """A recording that was read from a file.

    next() returns the input of each step, and verify() compares the scene's state.
    """

    def __init__(self, path: str | Path, data: dict[str, Any], frames: list[InputFrame]) -> None:
        self.path = path
        self.scene, self.seed = data["scene"], data["seed"]
        self.broadphase, self.solver, self.tier = data["broadphase"], data["solver"], data["tier"]
        self.bot, self.every = data["bot"], data["every"]
        self.level, self.date, self.result = data["level"], data["date"], data["result"]
        self.digests, self.physics = data["digests"], data["physics"]
        self.inputs = frames
        self.index = 0
        self.parted = ""  # message about the first difference under another physics version

    @property
    def frames(self) -> int:
        """Number of recorded steps."""
        return len(self.inputs)

    @property
    def outdated(self) -> str:
        """A sentence if the recording was made with another physics version, otherwise ""."""
        then = self.physics
        return "" if then == PHYSICS_VERSION else f"recorded under physics {then}, played under {PHYSICS_VERSION}"

    def level_path(self) -> Path | None:
        """Return the level file that was played; None for the scene's own level.

        Raises FileError if the file has changed since the recording.
        """
        if self.level is None:
            return None
        path = Path(self.level["path"])
        found = level_digest(path)
        if found != self.level["digest"]:
            raise FileError(
                self.path,
                "level",
                f"{brief(path, 100)} has changed since: digest {found}, recorded {self.level['digest']:.20}",
            )
        return path

    def next(self, scene: object) -> InputFrame:
        """Return the input of the next step; empty input after the last step. scene: not used."""
        self.index += 1
        return self.inputs[self.index - 1] if self.index <= len(self.inputs) else NOTHING

    def verify(self, scene: Scene) -> None:
        """Compare the scene's state after a step with the recorded digest, if there is one for this frame.

        Raises ReplayDiverged, which names the frame, if they differ. For a recording of another physics version, a
        message about the first difference is stored in `parted` instead.
        """
        frame = self.index
        if frame % self.every or frame // self.every > len(self.digests):
            return
        expected, found = self.digests[frame // self.every - 1], scene_digest(scene)[:DIGITS]
        if found != expected:
            since = "" if self.every == 1 else f" (since frame {frame - self.every})"
            text = f"{brief(self.path, 120)}: diverged at frame {frame}{since}: digest {found}, recorded {expected}"
            if not self.outdated:
                raise ReplayDiverged(text)
            self.parted = self.parted or f"{text}; {self.outdated}"


def load_replay(path: str | Path) -> Replay:
    """Read a recording, and return it as a Replay. Raises FileError, which names the file, the place and the reason."""
    data = read_json(path)
    if isinstance(data, dict) and data.get("version") == 1:
        data = {**data, "level": None, "date": "", "result": None}
    if isinstance(data, dict):
        data.setdefault("physics", 1)  # older files do not hold it
    _check_head(path, data)
    frames = []
    for index, run in enumerate(data["inputs"]):
        place = f"inputs[{index}]"
        if not (isinstance(run, list) and len(run) == 2 and _whole(run[0]) and run[0] > 0):
            raise FileError(path, place, "must be [repeats, input] with repeats of at least 1")
        if run[0] > data["frames"] - len(frames):
            raise FileError(path, "inputs", f"hold more than the {data['frames']} frames that the head says")
        frames += [_from_json(path, place, run[1])] * run[0]
    if len(frames) != data["frames"]:
        raise FileError(path, "inputs", f"hold {len(frames)} frames, the head says {data['frames']}")
    if len(data["digests"]) != data["frames"] // data["every"]:
        raise FileError(path, "digests", f"must be {data['frames'] // data['every']}, are {len(data['digests'])}")
    return Replay(path, data, frames)


def _whole(value):
    return isinstance(value, int) and not isinstance(value, bool)


def _near(value):
    return _whole(value) and abs(value) <= FARTHEST


def _is_result(result):
    if set(result) != {"won", "points", "seconds"} or not isinstance(result["won"], bool):
        return False
    seconds = result["seconds"]
    points = result["points"]
    return _whole(points) and abs(points) <= MOST_POINTS and isinstance(seconds, (int, float)) and 0 <= seconds < 1e6


def _check_head(path, data):
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise FileError(path, "format", f"is not {FORMAT!r}")
    if data.get("version") not in (1, VERSION) or isinstance(data["version"], bool):
        raise FileError(
            path, "version", f"{data.get('version')!r:.40} cannot be read here; this program reads 1 to {VERSION}"
        )
    kinds = {
        "scene": str,
        "seed": int,
        "broadphase": str,
        "solver": (str, type(None)),
        "tier": (str, type(None)),
        "level": (dict, type(None)),
        "date": str,
        "result": (dict, type(None)),
        "bot": bool,
        "physics": int,
        "every": int,
        "frames": int,
        "inputs": list,
        "digests": list,
    }
    for name, kind in kinds.items():
        if name not in data:
            raise FileError(path, name, "is missing")
        if not isinstance(data[name], kind) or (kind is int and not _whole(data[name])):
            raise FileError(path, name, f"has the wrong kind of value: {data[name]!r:.60}")
    for name, least, most in (
        ("physics", 1, None),
        ("every", 1, None),
        ("frames", 0, LONGEST),
        ("seed", 0, LARGEST_SEED),
    ):
        if data[name] < least or (most is not None and data[name] > most):
            must = f"at least {least}" if most is None else f"{least} to {most}"
            raise FileError(path, name, f"must be {must} (got {data[name]!r:.40})")
    if len(data["date"]) > LONGEST_DATE:
        raise FileError(path, "date", f"must be at most {LONGEST_DATE} letters")
    level, result = data["level"], data["result"]
    if level is not None and not (set(level) == {"path", "digest"} and all(isinstance(v, str) for v in level.values())):
        raise FileError(path, "level", "must be null or have path and digest, both text")
    if result is not None and not _is_result(result):
        raise FileError(path, "result", "must be null or have won (true or false), points and seconds (numbers)")
    for index, digest in enumerate(data["digests"]):
        if not (isinstance(digest, str) and len(digest) == DIGITS):
            raise FileError(path, f"digests[{index}]", f"must be {DIGITS} hex digits")


def _to_json(frame):
    data = {}
    if frame.actions:
        data["actions"] = sorted(frame.actions)
    if frame.pointer != (0, 0):
        data["pointer"] = list(frame.pointer)
    if frame.pointer_down:
        data["down"] = True
    if frame.wheel:
        data["wheel"] = frame.wheel
    if frame.changes:
        data["changes"] = [list(change) for change in frame.changes]
    return data


def _from_json(path, place, data):
    if not isinstance(data, dict):
        raise FileError(path, place, "must be an object")
    actions = data.get("actions", [])
    pointer = data.get("pointer", [0, 0])
    changes = data.get("changes", [])
    down, wheel = data.get("down", False), data.get("wheel", 0)
    unknown = set(data) - {"actions", "pointer", "down", "wheel", "changes"}
    if unknown:
        raise FileError(path, place, f"has unknown entries: {', '.join(sorted(unknown)):.60}")
    if not isinstance(actions, list) or any(action not in ACTIONS for action in actions):
        raise FileError(path, place, f"actions must be among {', '.join(ACTIONS)}")
    if not (isinstance(pointer, list) and len(pointer) == 2 and all(_near(v) for v in pointer)):
        raise FileError(path, place, f"pointer must be two whole numbers up to {FARTHEST}")
    if not isinstance(down, bool) or not _near(wheel):
        raise FileError(path, place, f"down must be true or false, wheel a whole number up to {FARTHEST}")
    if not isinstance(changes, list) or any(not (isinstance(c, list) and len(c) == 2) for c in changes):
        raise FileError(path, place, "changes must be a list of [name, value]")
    return InputFrame(frozenset(actions), tuple(pointer), down, wheel, tuple((c[0], c[1]) for c in changes))
