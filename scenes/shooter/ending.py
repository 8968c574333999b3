"""The end of a game: a countdown offers to continue after the last life, or bonuses are counted after the stage.

`scene.result` is set once, at the very end. After that the picture is frozen and keys have no effect.
"""

from game.drawing.number_text import count_text
from game.scene import Result
from scenes.shooter.cast import steps

COUNTDOWN = 10  # seconds, shown as 9..0
GRACE = steps(0.7)  # steps in which a key held from the fight is ignored
MOST_CONTINUES = 3
FIRST_BONUS, NEXT_BONUS = steps(1.5), steps(0.5)  # steps from the boss's end to the first bonus, and between bonuses
SHOWN = steps(2.0)  # steps for which all bonuses are shown before the result

PLAYING, ASKING, CLEARED, WON, LOST = "playing", "asking", "cleared", "won", "lost"


class Ending:
    """The end of a game.

    mode: PLAYING, ASKING, CLEARED, WON or LOST; since: steps in this mode; left: remaining steps of the countdown to
    continue.
    """

    def __init__(self):
        self.mode, self.since, self.left = PLAYING, 0, 0
        self.counted = []  # (reason, points) of the bonuses so far

    @property
    def digit(self):
        """Digit that the countdown shows: the remaining time in whole seconds."""
        return self.left // 60

    def step(self, scene, inputs):
        """Make one step of the ending. Return whether the game is stopped, so that the world must not be stepped."""
        self.since += 1
        if self.mode == PLAYING:
            if scene.plane.lives == 0 and scene.plane.away == 0:
                self._ask(scene)
        elif self.mode == ASKING:
            self._count_down(scene, inputs)
        elif self.mode == CLEARED:
            self._count_bonuses(scene)
        return self.mode not in (PLAYING, CLEARED)

    def _enter(self, mode):
        self.mode, self.since = mode, 0

    def _ask(self, scene):
        if scene.score.continues < MOST_CONTINUES:
            self._enter(ASKING)
            self.left = COUNTDOWN * 60 - 1
        else:
            self._lose(scene)

    def _count_down(self, scene, inputs):
        before = self.digit
        self.left -= 1
        if self.since > GRACE:
            if inputs.pressed("fire") or inputs.pressed("confirm"):
                self._enter(PLAYING)
                scene.score.go_on()
                scene.plane.go_on()
                scene.clear_bullets()
                scene.spectacle.went_on()
                return
            if inputs.pressed("bomb") or inputs.pressed("cancel"):
                self.left = self.digit * 60 - 1  # hurry
        if self.left <= 0:
            self._lose(scene)
        elif self.digit != before:
            scene.play("blip", volume=0.5)

    def _lose(self, scene):
        self._enter(LOST)
        scene.result = self._result(scene, won=False)

    def clear(self, scene):
        """Start to count the bonuses. Called when the boss is gone."""
        self._enter(CLEARED)
        scene.clear_bullets()
        scene.plane.shelter(steps(60))

    def _count_bonuses(self, scene):
        bonuses = scene.score.final(scene.plane.lives, scene.plane.bombs)
        number = len(self.counted)
        if number < len(bonuses):
            if self.since == FIRST_BONUS + NEXT_BONUS * number:
                self.counted.append(bonuses[number])
                scene.score.add_bonus(bonuses[number][1])
                scene.play("coin", volume=0.6)
        elif self.since >= FIRST_BONUS + NEXT_BONUS * number + SHOWN:
            self._enter(WON)
            scene.result = self._result(scene, won=True)

    def _result(self, scene, won):
        score = scene.score
        lines = (
            f"{count_text(sum(score.kills.values()), 'plane')}, {count_text(score.waves, 'whole wave')}",
            f"{count_text(score.grazes, 'graze')}, best chain {score.best_chain}",
            ", ".join(map(count_text, (score.hits, score.bombs, score.continues), ("hit", "bomb", "continue"))),
        )
        return Result(won, score.points, (scene.frame + 1) / 60, lines)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (self.mode, self.since, self.left, len(self.counted))
