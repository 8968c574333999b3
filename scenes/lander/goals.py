"""Goals that the bot must reach in a flight, with deadlines. The scene's check() returns them."""

from game.scene import Goal
from scenes.lander.course import WON

SITES = (("canyon", 2400), ("cave", 7200), ("mesa", 9900))  # (site, frame by which it must be reached)
CLEARED = 10500


def goals(scene):
    """Return the goals of a flight, a list of Goal with their current values."""
    score, course = scene.score, scene.course
    return [
        *(
            Goal(f"landed at the {name}", due, score.landings > number, f"{score.landings} sites")
            for number, (name, due) in enumerate(SITES)
        ),
        Goal("cargo set down on a pad", SITES[0][1], score.delivered > 0, f"{score.delivered}"),
        Goal("ice shot through", SITES[1][1], score.fired > 0 and bool(scene.ground.touched), f"{score.fired} shells"),
        Goal("the course flown", CLEARED, course.mode == WON, f"{score.points} points"),
        Goal("no ship lost", 1, score.lost == 0, f"{score.lost} lost"),
        Goal("landed upright and softly", SITES[0][1], score.softest < 60.0, f"{score.softest:.0f} px/s"),
    ]
