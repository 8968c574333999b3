"""Every scene: its bot reaches its goals, irrelevant conditions do not change it, and every setting has an effect."""

import copy
from contextlib import closing

import pytest

import physics
from game.registry import Registry
from game.run.replay import Recorder
from game.run.replay_check import load_replay_for
from scenes import SCENES
from tests.lockstep import (
    SWITCHES,
    Changing,
    DrawnRun,
    PlainRun,
    Run,
    failures_of,
    first_difference,
    lockstep,
    make_scene,
    ways_to_run,
)

SHORT_FRAMES = 30
DRAWN_FRAMES = 1200
PLAIN_FRAMES = 25  # without compiled kernels
PLAIN_GROUPS = 4  # of scenes that share a process without compiled kernels: it takes longer to begin than to play one
LAB_FRAMES = 600
FRAMES = {"shooter": 3600, "platformer": 3600, "lander": 3600}  # the games' first minute, goals included
FEW = not physics.JIT
REGISTRY = Registry(SCENES)
scene_class = REGISTRY.scene_class
TURNED = 20  # the frame before which a setting is changed
needs_speed = pytest.mark.skipif(FEW, reason="hundreds of frames; nothing here depends on who runs the kernels")

# Thin lines and an upright box, whose bounds are exact; a sprite that is alone.
SAME_WITHOUT_NARROW_PHASE = {"lab/sensors", "lab/ladder"}
# What these change is no matter of a world: the rules, the picture, which other world goes on beside it.
BESIDE_THE_WORLDS = {
    *(
        (f"lab/{lab}", name)
        for lab, name in (
            ("sensors", "events"),
            ("stacks", "column"),
            ("tunnelling", "lane"),
            ("mask_sweep", "side"),
            ("gallery", "side"),
            ("mask_stack", "shape"),
            ("ladder", "shape"),
            ("carving", "loose parts"),
        )
    ),  # the title line alone is about another one; nothing is loose yet
    ("shooter", "hurts"),
    ("lab/effects", "effect"),
    ("lab/shapes", "step"),
    ("lab/queries", "query"),
    ("lab/queries", "size"),
}


def play(scene, frames, source=None):
    run = Run("the scene", scene, source)
    for _ in range(frames):
        run.step()
    return run


def played_and_replayed(name, frames, path):
    """Play the scene by its bot, and again from its recording. Return both runs.

    The second run is drawn with every overlay for 20 s. It compares all broad phases in each step, and changes from one
    to another. Raises ReplayDiverged with the first frame that differs, StrategiesDisagree with the pairs.
    """
    scene = make_scene(name, FEW)
    run = Run("the scene", scene, recorder=Recorder(scene, bot=True))
    for _ in range(frames):
        run.session.step()
    run.session.recorder.save(path)
    recording, _ = load_replay_for(path, REGISTRY)
    again = DrawnRun("replayed", make_scene(name, FEW, asks_all=True), Changing(SWITCHES, recording), recording)
    for frame in range(recording.frames):
        if frame < DRAWN_FRAMES:
            again.step()
        else:
            again.session.step()
    assert recording.frames == frames and again.scene.state() == scene.state()
    return run, again


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", SCENES)
def test_one_digest_however_it_is_run_for_half_a_second(name, tmp_path):
    """A scene has the same digests played and replayed for half a second.

    The README's command for the tests must cover every scene, so this test is never on a list of slow tests
    (tests/slow.py, NEVER).
    """
    played_and_replayed(name, SHORT_FRAMES, tmp_path / "recording.json")


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", SCENES)
def test_one_digest_however_it_is_run_and_the_goals_are_reached(name, tmp_path):
    frames = FRAMES.get(name, LAB_FRAMES) if physics.JIT else PLAIN_FRAMES
    for run in played_and_replayed(name, frames, tmp_path / "recording.json"):
        assert not failures_of(run, frames), run.label


@pytest.mark.skipif(not physics.JIT, reason="nothing to compare with")
@pytest.mark.parametrize("group", range(PLAIN_GROUPS))
def test_compiled_and_plain_kernels_give_one_digest(group):
    names = list(SCENES)[group::PLAIN_GROUPS]
    with closing(PlainRun("without compiled kernels", names, PLAIN_FRAMES)) as plain:
        for name in names:
            lockstep([Run(f"{name} with compiled kernels", make_scene(name, few=True)), plain], PLAIN_FRAMES)


@pytest.mark.nightly
@needs_speed
@pytest.mark.parametrize("seed", [2, 3])
@pytest.mark.parametrize("name", SCENES)
def test_one_digest_however_it_is_run_on_other_seeds(name, seed):
    lockstep(list(ways_to_run(name, seed=seed)), FRAMES.get(name, LAB_FRAMES))


@pytest.mark.nightly
@needs_speed
@pytest.mark.parametrize("name", SCENES)
def test_compiled_and_plain_kernels_give_one_digest_for_ten_seconds(name):
    with closing(PlainRun("without compiled kernels", [name], LAB_FRAMES)) as plain:
        lockstep([Run("with compiled kernels", make_scene(name, few=True)), plain], LAB_FRAMES)


@pytest.mark.parametrize("name", SCENES)
def test_restart_goes_back_to_the_start(name):
    frames = 60 if physics.JIT else 10
    scene = make_scene(name, few=True)
    play(scene, frames)
    scene.restart()
    lockstep([Run("a new scene", make_scene(name, few=True)), Run("the scene after a restart", scene)], frames)


def changed(name, changes):
    """Return two runs of a scene whose settings are changed during the game.

    One uses the scene's own broad phase, the other compares all broad phases. changes: as in Changing.
    """
    return [
        Run(f"changed{label}", make_scene(name, True, asks_all=asks_all), Changing(changes))
        for label, asks_all in (("", False), (" and asking all broad phases", True))
    ]


@needs_speed
@pytest.mark.parametrize("name", SCENES)
def test_the_narrow_phase_switches_mid_game(name):
    start = make_scene(name).narrowphase
    off, on = {TURNED: (("narrowphase", not start),)}, {2 * TURNED: (("narrowphase", start),)}
    runs = changed(name, off | on)
    for found in (not start, start):
        lockstep(runs, TURNED + 1)
        assert {world.effects.narrowphase for run in runs for world in run.scene.worlds} == {found}
    untouched, switched = (Run("", make_scene(name, True), Changing(changes)) for changes in ({}, off))
    frame = first_difference(untouched, switched, LAB_FRAMES)
    if name in SAME_WITHOUT_NARROW_PHASE:
        assert frame is None
    else:
        assert frame is not None and frame > TURNED, "it goes on as if nothing had been switched"


def worlds_differ(one, other, frames):
    """Return whether the worlds of two runs differ within a number of frames."""
    for _ in range(frames):
        if [world.digest() for world in one.scene.worlds] != [world.digest() for world in other.scene.worlds]:
            return True
        one.step()
        other.step()
    return False


@needs_speed
@pytest.mark.parametrize("name, slider", [(name, each.name) for name in SCENES for each in scene_class(name).sliders])
def test_every_slider_can_be_turned_mid_game_and_does_something(name, slider):
    untouched = play(make_scene(name, True), TURNED)
    known = next(each for each in untouched.scene.sliders if each.name == slider)
    values = {known.low, known.clamp(1.3 * known.low + 20), known.high} - {untouched.scene.values[slider]}
    untouched.step()
    for value in sorted(values):
        runs = changed(name, {TURNED: ((f"slider:{slider}", value),)})
        lockstep(runs, TURNED + 1)
        assert runs[0].scene.values[slider] == value
        if (name, slider) not in BESIDE_THE_WORLDS:
            one, other = copy.deepcopy((runs[0], untouched))
            assert worlds_differ(one, other, 30), f"{slider} at {value} changes nothing"
        lockstep(runs, 9)


@needs_speed
@pytest.mark.parametrize("name, tier", [(name, tier) for name in SCENES for tier in scene_class(name).tiers])
def test_every_tier_can_be_chosen_mid_game(name, tier):
    runs = changed(name, {TURNED: (("tier", tier),)})
    lockstep(runs, 300)  # bodies that came before the change and after it
    for world in runs[0].scene.worlds:
        tiers = {world.body(identity).tier for identity in world.bodies["id"].tolist()}
        assert tier in tiers and tiers <= {tier, None}


@needs_speed
@pytest.mark.parametrize("name", [name for name in SCENES if scene_class(name).tiers])
def test_tiers_are_felt(name):
    ends = {}
    for tier in scene_class(name).tiers:
        digest = play(make_scene(name, True, tier=tier), 1500).step()
        assert digest not in ends, f"{tier} and {ends[digest]} come to the same"
        ends[digest] = tier


@pytest.mark.parametrize("name", SCENES)
def test_an_unknown_change_is_refused(name):
    with pytest.raises(ValueError, match="gravity"):
        make_scene(name, few=True).change("gravity", 3)
