"""Feats of the hero, counted for the goals of the scene: the bot must use each element of the level before
a deadline.
"""

from game.scene import Goal
from scenes.platformer.feel import HEIGHT, WIDTH

WORDS = {"jump": "jumps", "wall_jump": "wall jumps", "drop": "drops"}
# feat -> (kind of object that the level needs for it, or None; number of times or steps; deadline [steps])
WANTED = {
    "slope": (None, 20, 900),
    "stomps": ("walker", 1, 1500),
    "pushed a crate": ("crate", 10, 1500),
    "springs": ("spring", 1, 2100),
    "drops": (None, 1, 2100),
    "lift": ("platform", 60, 3000),
    "ladder": ("ladder", 60, 3300),
    "walls blown": ("blast_wall", 1, 4500),
    "crumbled": ("crumble", 1, 4500),
    "belt": ("belt", 20, 5100),
    "crates thrown": ("spring", 1, 5100),
    "lift with a crate": ("platform", 60, 6300),
    "lift with an enemy": ("platform", 60, 6300),
    "wall jumps": (None, 3, 7200),
    "rode a crate": ("crate", 30, 9000),
}
GOAL_DUE = 9000  # [steps]

TILT = 0.1  # rise per px from which ground counts as a slope


class Feats:
    """Counts of the hero's feats (jumps, rides, ladders ...) in a run. The scene's goals are based on them.

    done: {name of a feat: number of times, or of steps, that the hero did it}.
    """

    def __init__(self, scene):
        self.scene = scene
        names = (*WANTED, *WORDS.values(), "crushed", "slid")
        self.done = dict.fromkeys(names, 0)
        self.inside_solid = 0

    def count(self):
        """Count the hero's feats of the last step."""
        scene, done = self.scene, self.done
        hero = scene.hero
        left, top, _, _ = hero.box
        self.inside_solid += scene.level.blocks(left, top, WIDTH, HEIGHT)
        for word, name in WORDS.items():
            done[name] += word in hero.news
        done["slope"] += hero.grounded and abs(hero.slope) >= TILT  # tilted crates are flatter
        done["slid"] += hero.sliding != 0
        done["ladder"] += hero.ladder is not None
        done["belt"] += hero.grounded and hero.character.surface_speed != 0.0
        done["pushed a crate"] += bool(hero.pushed is not None and hero.vx != 0.0 and hero.pushed.slides(hero.facing))
        if hero.riding is not None:
            self._count_ride(scene, hero)

    def _count_ride(self, scene, hero):
        done, under = self.done, hero.riding.user
        done["rode a crate"] += under == "crate"
        for platform in scene.things.platforms:
            x, y = hero.character.position
            left, top, right, _ = platform.box
            if not (left - 8 < x < right + 8 and top - 60 < y < top and under in ("platform", "crate")):
                continue
            done["lift"] += under == "platform"
            done["lift with a crate"] += any(
                left < crate.body.position[0] < right and abs(crate.box[3] - top) < 3 for crate in scene.things.crates
            )
            done["lift with an enemy"] += any(
                enemy.riding == platform.body.id for enemy in scene.things.enemies.values()
            )

    def broke(self):
        """Count one crumbling stone that has broken."""
        self.done["crumbled"] += 1

    def goals(self):
        """Return the goals of the scene, a list of Goal with deadlines and the values reached so far."""
        scene, things = self.scene, self.scene.things
        kinds = {thing.kind for thing in scene.level.map.things}
        lit = sum(trigger.lit for trigger in scene.checkpoints)
        found = [Goal("never inside a solid tile", 1, self.inside_solid == 0, f"{self.inside_solid} steps")]
        for name, (kind, times, due) in WANTED.items():
            if kind is None or kind in kinds:
                found.append(Goal(name, due, self.done[name] >= times, f"{self.done[name]} of {times}"))
        x, y = scene.hero.character.position
        if things.secrets_in_all:
            found.append(
                Goal(
                    "all secrets",
                    GOAL_DUE,
                    scene.secrets == things.secrets_in_all,
                    f"{scene.secrets} of {things.secrets_in_all}",
                )
            )
        if scene.checkpoints:
            of = len(scene.checkpoints)
            found.append(Goal("all checkpoints", GOAL_DUE, lit == of, f"{lit} of {of}"))
        found.append(Goal("reached the goal", GOAL_DUE, scene.phase == "won", f"{scene.phase} at ({x:.0f}, {y:.0f})"))
        return found
