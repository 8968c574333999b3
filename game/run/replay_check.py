"""Check that a recording can be played by its scene.

Every name and value is checked, because files may come from other people and from other versions.
"""

from pathlib import Path

from game.errors import FileError
from game.registry import Registry
from game.run.replay import Replay, load_replay
from game.scene import SUBSTEPS, Scene
from physics import BROADPHASES


def load_replay_for(path: str | Path, registry: Registry) -> tuple[Replay, type[Scene]]:
    """Read a recording. Return (recording, class of its scene).

    Raises FileError if the file is damaged, or if the scene cannot play the recording.
    """
    recording = load_replay(path)
    if recording.scene not in registry.names:
        raise FileError(
            path, "scene", f"there is no scene {recording.scene!r:.60} here; valid: {', '.join(registry.names)}"
        )
    scene_class = registry.scene_class(recording.scene)
    check_recording(recording, scene_class)
    return recording, scene_class


def check_recording(recording: Replay, scene_class: type[Scene]) -> None:
    """Check that the values of a recording are valid for its scene.

    Raises FileError, which names the first value that the scene does not accept.
    """
    path = recording.path
    for place, value, valid in (
        ("broadphase", recording.broadphase, tuple(BROADPHASES)),
        ("solver", recording.solver, (None, *scene_class.valid_solvers(), *scene_class.solvers)),
        ("tier", recording.tier, scene_class.tiers or (None,)),
    ):
        if value not in valid and not (place == "tier" and value is None):
            raise FileError(
                path, place, f"{scene_class.name} has no {value!r:.60}; valid: {', '.join(map(str, valid))}"
            )
    if recording.level is not None and not scene_class.takes_level:
        raise FileError(path, "level", f"{scene_class.name} takes none")
    asked = set()
    for number, frame in enumerate(recording.inputs):
        if frame.changes and id(frame) not in asked:
            asked.add(id(frame))
            for name, value in frame.changes:
                if not is_possible(scene_class, name, value):
                    raise FileError(
                        path, f"frame {number + 1}", f"{scene_class.name} has no change {name!r:.40} to {value!r:.40}"
                    )


def is_possible(scene_class: type[Scene], name: object, value: object) -> bool:
    """Return whether the scene accepts a change (name, value) as input.

    A scene whose worlds have different solvers accepts no change of the solver.
    """
    if not isinstance(name, str) or isinstance(value, (list, dict)):
        return False
    kind, _, what = name.partition(":")
    if kind == "slider":
        known = what in [slider.name for slider in scene_class.sliders]
        return known and isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e12
    if kind == "assist":
        return what in scene_class.assists and isinstance(value, bool)
    switches = scene_class.effects.response and not scene_class.solvers
    return {
        "broadphase": value in BROADPHASES,
        "narrowphase": isinstance(value, bool),
        "restart": True,
        "substeps": scene_class.effects.stacking and value in SUBSTEPS and not isinstance(value, bool),
        "solver": bool(switches) and value in scene_class.valid_solvers(),
        "tier": value in scene_class.tiers,
    }.get(name, False)
