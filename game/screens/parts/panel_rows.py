"""The rows of the panel while a scene is played.

A change of the simulation becomes input of the next step (devices.change), so that a recording contains it.
"""

from game.drawing.number_text import plain_name
from game.overlays.stack import Overlays
from game.run.ignored_effects import ignored_effects
from game.run.loop import SPEEDS
from game.run.outcome import solver_name
from game.screens.parts.effect_rows import effect_rows
from game.screens.parts.panel import BUTTON, CHECK, CHOICE, HEAD, SLIDER, Row
from game.screens.parts.played import Played

LEAP = 60  # steps that a press of the row "Rewind" goes back


def play_rows(play: Played) -> list[Row]:
    """Return the panel's rows for a Play screen.

    The scene's own rows come first, so that they are visible in any window.
    """
    scene = play.scene
    return [
        Row(HEAD, scene.title),
        *(_slider(play, scene, slider) for slider in scene.sliders),
        *_switches(play, scene),
        Row(HEAD, "See"),
        *layer_rows(play.overlays),
        Row(HEAD, "Time"),
        *_time(play),
        Row(
            BUTTON,
            "What accuracy costs",
            key="M",
            press=play.toggle_costs,
            hint="every setting as a dot: its error against its time",
        ),
        *_race(play),
        *effect_rows(play.measuring),
    ]


def _race(play):
    measuring = play.measuring
    if measuring.race is not None:
        split = measuring.split is not None
        hint = "side by side; else the rival lies over the scene"
        return [
            Row(CHECK, "Split screen", key="K", on=split, press=measuring.toggle_split, hint=hint),
            Row(BUTTON, "End the race", press=measuring.end_race, hint="the rival goes"),
        ]
    rivals = measuring.rivals()
    if not rivals:
        return []
    at = measuring.against % len(rivals)

    def turn(way):
        measuring.against = (at + way) % len(rivals)

    name = rivals[at].label(measuring.now())
    return [
        Row(CHOICE, "Race against", name, turn=turn, hint="one scene, one seed, two settings"),
        Row(BUTTON, "Start the race", press=lambda: play.start_race(rivals[at]), hint="both begin anew"),
    ]


def _switches(play, scene):
    rows = []
    if scene.switches_broadphase:
        rows.append(
            Row(
                CHOICE,
                "Broad phase",
                scene.broadphase,
                "B",
                turn=play.switches.broadphase,
                hint="how pairs that may touch are found",
            )
        )
    if scene.solver_choices():
        rows.append(
            Row(
                CHOICE,
                "Solver",
                plain_name(solver_name(scene) or ""),
                "V",
                turn=play.switches.solver,
                hint=_solver_hint(scene),
            )
        )
    if scene.effects.stacking and not any(slider.name == "substeps" for slider in scene.sliders):
        rows.append(
            Row(
                CHOICE,
                "Substeps",
                "by load" if (now := scene.worlds[0].substeps) == "auto" else str(now),
                turn=play.switches.substeps,
                hint="how often a step looks at its contacts",
            )
        )
    if scene.tiers:
        rows.append(
            Row(
                CHOICE, "Tested as", scene.tier, "T", turn=play.switches.tier, hint="the shape that stands for a sprite"
            )
        )
    rows.append(
        Row(
            CHECK,
            "Narrow phase",
            key="N",
            on=scene.narrowphase,
            press=play.switches.narrowphase,
            hint="off: two boxes that meet are a hit",
        )
    )
    return rows


def _solver_hint(scene):
    """Return the hint of the solver row: the effects that the solver ignores.

    If there are none, it is the solver's purpose.
    """
    ignored = ignored_effects(scene)
    return f"ignores {', '.join(map(plain_name, ignored))}" if ignored else "how overlaps are resolved"


def layer_rows(overlays: Overlays) -> list[Row]:
    """Return one row with a check box for each overlay layer."""
    return [
        Row(
            CHECK,
            layer.title,
            key=layer.key.upper(),
            color=layer.color,
            on=layer.name in overlays.on,
            press=lambda name=layer.name: overlays.toggle(name),
        )
        for layer in overlays.layers
    ]


def _time(play):
    clock = play.clock
    return [
        Row(CHECK, "Freeze", key="P", on=clock.paused, press=play.toggle_pause),
        Row(BUTTON, "Single step", key="O", press=play.single_step, hint="one sixtieth of a second"),
        Row(
            BUTTON,
            "Step inspector",
            key="E",
            press=play.toggle_step_inspector,
            hint="stage by stage, forwards and back",
        ),
        Row(
            CHOICE,
            "Speed",
            f"{clock.speed:.0%}",
            "- +",
            turn=lambda way: clock.faster() if way > 0 else clock.slower(),
            hint=f"down to {SPEEDS[-1]:.0%}",
        ),
        *_rewind(play),
        Row(BUTTON, "Restart", key="R", press=play.request_restart),
    ]


def _rewind(play):
    if play.timeline is None:
        return []
    rewind = play.timeline.rewind
    back = "" if rewind.live else f"   {(rewind.end - rewind.position) / 60.0:.1f} s back"
    hint = "a second back, frozen; hold the key to run back"
    return [Row(BUTTON, "Rewind" + back, key="Backspace", press=lambda: _leap(play), hint=hint)]


def _leap(play):
    play.clock.paused = True
    play.timeline.go(-LEAP)


def _slider(play, scene, slider):
    value = scene.values[slider.name]
    change = play.devices.change

    def set_value(new):
        if slider.clamp(new) != scene.values[slider.name]:
            change(f"slider:{slider.name}", slider.clamp(new))

    if slider.choices:
        return Row(
            CHOICE,
            slider.name,
            slider.show(value),
            turn=lambda way: set_value(slider.low + (value - slider.low + way) % len(slider.choices)),
        )
    span = slider.high - slider.low
    nudge = max(slider.step, round(span / 50 / slider.step) * slider.step)
    return Row(
        SLIDER,
        slider.name,
        slider.show(value),
        share=(value - slider.low) / span,
        turn=lambda way: set_value(value + way * nudge),
        put=lambda share: set_value(slider.low + share * span),
    )
