"""Session: a run of a scene, step by step, with its input, recording, invariants and measurements."""

from time import perf_counter

from game.errors import StrictFailure
from game.input.inputs import InputState
from game.run.outcome import RunReport
from game.run.replay import Recorder, Replay
from game.run.sources import Source
from game.scene import Scene


class Session:
    """One run of a scene. source.next(scene) returns the input of each step. recorder and replay are optional.

    strict: whether the run ends at the first broken invariant.
    """

    def __init__(
        self,
        scene: Scene,
        source: Source,
        recorder: Recorder | None = None,
        replay: Replay | None = None,
        strict: bool = False,
    ) -> None:
        self.scene = scene
        self.source = source
        self.recorder = recorder
        self.replay = replay
        self.inputs = InputState()
        self.report = RunReport()
        if strict:
            scene.watch_invariants(strict=True)

    def step(self) -> None:
        """Make one fixed step of the scene.

        Raises ReplayDiverged if the state differs from the replay's digest. Raises StrictFailure for a broken invariant
        if the session is strict. The time of checking invariants does not count as time of the scene.
        """
        frame = self.source.next(self.scene)
        self.inputs.set(frame)
        started = perf_counter()
        self.scene.step(self.inputs)
        monitor = self.scene.monitor
        watching = monitor.seconds if monitor is not None else 0.0
        self.report.note_step(self.scene, perf_counter() - started - watching)
        self.scene.observe()
        if self.recorder is not None:
            self.recorder.note(frame, self.scene)
        if monitor is not None and monitor.strict and monitor.first is not None:
            frame, broken = monitor.first
            raise StrictFailure(f"{self.scene.name}, frame {frame}: {broken}")
        if self.replay is not None:
            self.replay.verify(self.scene)
