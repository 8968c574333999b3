"""Session: a scene being stepped, with its input, its recording, its judge and its measurements."""

from time import perf_counter

from game.input.inputs import InputState
from game.run.outcome import RunReport
from game.run.replay import Recorder, Replay
from game.run.sources import Source
from game.scene import Scene


class Session:
    """`source.next(scene)` gives the input; recorder and replay may be None."""

    def __init__(
        self, scene: Scene, source: Source, recorder: Recorder | None = None, replay: Replay | None = None
    ) -> None:
        self.scene = scene
        self.source = source
        self.recorder = recorder
        self.replay = replay
        self.inputs = InputState()
        self.report = RunReport()

    def step(self) -> None:
        """One fixed step. Raises ReplayDiverged when a replay's digest differs."""
        frame = self.source.next(self.scene)
        self.inputs.set(frame)
        started = perf_counter()
        self.scene.step(self.inputs)
        self.report.note_step(self.scene, perf_counter() - started)
        self.scene.observe()
        if self.recorder is not None:
            self.recorder.note(frame, self.scene)
        if self.replay is not None:
            self.replay.verify(self.scene)
