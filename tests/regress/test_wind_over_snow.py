"""The lander's wind reading is legible in front of snow; the dark panel behind the number once let the snow show
through.
"""

from game.overlays.stack import Overlays
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from tests.game.reading import Reader
from tests.lockstep import make_scene


def test_the_wind_can_be_read_where_snow_lies_behind_it():
    scene = make_scene("lander", seed=1)
    session = Session(scene, BotSource())
    picture = Picture()
    for _ in range(10):
        for _ in range(20):
            session.step()
        with Reader() as reader:
            picture.draw_scene(scene, Overlays())
            reader.assert_readable()
