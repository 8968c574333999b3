"""The options of a run of the program, as read from the command line."""

from dataclasses import dataclass
from pathlib import Path

from game.registry import Registry
from game.run.replay import Replay
from game.scene import Scene
from physics.annotations import SolverName, TierName

DEFAULT_FRAMES = 600  # of a headless run without --frames: ten seconds


@dataclass
class Options:
    """Checked options, one field for each command-line flag. recording: content of the file that --replay names."""

    list: bool = False
    scene: str | None = None
    headless: bool = False
    frames: int | None = None
    seed: int | None = None
    json: bool = False
    bot: bool = False
    record: str | None = None
    replay: str | None = None
    overlay: tuple[str, ...] | None = None  # overlay layers to show; None: the scene's default
    broadphase: str | None = None
    solver: SolverName | None = None
    tier: TierName | None = None
    level: Path | None = None
    screenshot: str | None = None
    csv: str | None = None  # a file
    profile: bool = False
    warmup: bool = False
    strict: bool = False
    version: bool = False
    advise: str | None = None  # a scene, which is then also `scene`
    error: float | None = None  # [px] allowed error of the advice
    report: str | None = None  # a folder
    quick: bool = False
    workers: int | None = None
    dask: str | None = None  # the address of a scheduler
    only: str | None = None  # jobs of the report, by a pattern
    recording: Replay | None = None

    @property
    def is_a_run(self) -> bool:
        """Whether the run of one scene is measured, saved or limited in length.

        If so, the program ends with the run.
        """
        return bool(
            self.frames or self.record or self.json or self.profile or self.screenshot or self.csv or self.strict
        )

    @property
    def played_by_bot(self) -> bool:
        """Whether the scene's bot plays, or played the recording that is replayed.

        The goals are checked only in this case.
        """
        return self.bot or bool(self.recording and self.recording.bot)

    @property
    def last_frame(self) -> int | None:
        """Number of frames after which the run ends; None if the player decides when it ends."""
        return self.frames or (self.recording.frames if self.recording else None)


def scene_class_of(options: Options, registry: Registry) -> type[Scene]:
    """Return the class of the scene that the options name. options.scene must not be None."""
    assert options.scene is not None
    return registry.scene_class(options.scene)


def make_scene(options: Options, registry: Registry) -> Scene:
    """Return a new scene of the class that the options name. Raises FileError for an invalid level file."""
    return scene_class_of(options, registry)(
        options.seed or 0, options.broadphase, options.solver, options.tier, options.level
    )
