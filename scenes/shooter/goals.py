"""Goals that the bot must reach in a stage, with deadlines. The scene's check() returns them."""

from game.scene import Goal
from scenes.shooter.cast import steps

FOUGHT = {"dart": 900, "saucer": 1500, "hornet": 2400, "turret": 3300, "gunship": 4200}  # kind -> frame
MIDBOSS, BOSS, CLEARED = 9000, 18000, 18600  # frames: enough for every timer
LONGEST = steps(40)  # steps that a plane without a timer of its own may stay in the sky


def stage_goals(scene):
    """Return the goals for the scene's stage, a list of Goal."""
    score, fleet = scene.score, scene.fleet
    kinds = {event.event for event in scene.director.stage.events}
    sent = {group.kind for event in scene.director.stage.events for group in event.groups}
    leaders = (("midboss", MIDBOSS), ("boss", BOSS))
    cleared = scene.result is not None and scene.result.won
    return [
        *(
            Goal(f"shot down a {kind}", due, score.kills[kind] > 0, f"{score.kills[kind]}")
            for kind, due in FOUGHT.items()
            if kind in sent
        ),
        Goal("grazed", 3600, score.grazes > 0, f"{score.grazes}"),
        Goal("a pick-up taken", 3600, score.taken > 0, f"{score.taken}"),
        Goal("a bomb used", BOSS, score.bombs > 0, f"{score.bombs}"),
        *(Goal(f"the {name} beaten", due, scene.beaten[name]) for name, due in leaders if name in kinds),
        Goal(
            "the stage cleared without a continue",
            CLEARED,
            cleared and not score.continues,
            f"{scene.plane.lives} lives left, {score.hits} hits",
        ),
        Goal("no enemy stays for ever", 1, fleet.longest < LONGEST, f"the longest {fleet.longest / 60:.0f} s"),
        Goal("every body in the world is in the game", 1, scene.unknown == 0, f"{scene.unknown} are not"),
    ]
