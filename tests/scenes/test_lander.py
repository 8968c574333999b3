"""Rules of the lander: flight, fuel, impacts, landings, the rope, cargo, shells, lost ships and the end of the game."""

from math import pi

import pytest

import physics
from game.drawing.sprites import load_atlas
from game.run.digest import scene_digest
from scenes.lander.course import CHEER, CLEARED, FLYING, LANDED, LOST, WON
from scenes.lander.feel import (
    AWAY,
    CAN,
    FEWEST_SHELLS,
    FUEL,
    HARMLESS,
    HULL,
    LINE,
    LIVES,
    SHELL_LIFE,
    SHELLS,
    STRANDED,
    TURN_RATE,
)
from scenes.lander.score import DELIVERY, MEDALS, Score
from scenes.lander.weather import Weather
from tests.scenes.lander_stage import Flight

pytestmark = pytest.mark.skipif(not physics.JIT, reason="seconds of play take too long without compiled kernels")


def test_the_ships_own_pixels_are_its_body():
    flight = Flight()
    (shape,) = flight.ship.body.shapes
    assert shape is load_atlas("lander").mask("ship")
    ground = flight.scene.ground.body.shapes[0]
    assert ground.size == (4096, 1024) and 0.3 < ground.area / (4096 * 1024) < 0.8


def test_it_stands_on_its_pad_until_somebody_thrusts():
    flight = Flight()
    start = flight.ship.y
    flight.step(120)
    assert abs(flight.ship.y - start) < 1.0 and flight.ship.quiet and flight.scene.pad_below().name == "base"
    assert not flight.ship.body.awake
    flight.step(60, ["up"])
    assert flight.ship.y < start - 10.0 and not flight.ship.touching


def test_thrust_burns_fuel_and_nothing_else_does():
    flight = Flight()
    flight.put(300, 200)
    flight.step(30)
    assert flight.ship.fuel == FUEL
    flight.step(60, ["up"])
    assert FUEL - 6.0 < flight.ship.fuel < FUEL - 3.0
    flight.ship.fuel = 0.0
    before = flight.ship.vy
    flight.step(30, ["up"])
    assert flight.ship.vy > before + 15.0 and not flight.ship.thrusting, "without fuel it falls"


def test_it_turns_both_ways_and_stops_by_itself():
    for key, way in (("right", 1), ("left", -1)):
        flight = Flight()
        flight.put(300, 200)
        flight.step(20, [key])
        assert 0.0 < way * flight.ship.angle < pi / 2
        assert abs(flight.ship.body.angular_velocity) <= TURN_RATE + 1e-9
        flight.step(30)
        assert abs(flight.ship.body.angular_velocity) < 1e-9


@pytest.mark.parametrize("speed, hurt", [(0.7 * HARMLESS, False), (2.2 * HARMLESS, True), (3.2 * HARMLESS, True)])
def test_a_knock_costs_by_its_impulse(speed, hurt):
    flight = Flight()
    pad = flight.scene.moon.pads[0]
    flight.put_over(pad, 1.0, (0.0, speed))
    flight.step(40)
    assert (flight.ship.hull < HULL) == hurt
    if hurt:
        assert HULL - 1.5 * speed < flight.ship.hull < HULL - 0.3 * (speed - HARMLESS)


def test_the_harder_the_knock_the_more_it_costs_and_a_hard_one_is_the_end():
    left = []
    for speed in (70.0, 95.0, 120.0):
        flight = Flight()
        flight.put_over(flight.scene.moon.pads[0], 12.0, (0.0, speed))
        flight.step(20)
        left.append(flight.ship.hull)
    assert left[0] > left[1] > left[2] > 0.0
    flight = Flight()
    flight.put_over(flight.scene.moon.pads[0], 12.0, (0.0, 220.0))
    flight.step(20)
    assert not flight.ship.here and flight.ship.lives == LIVES - 1 and flight.scene.score.lost == 1


def test_nobody_is_hurt_with_the_assist():
    flight = Flight()
    flight.step(1, changes=[("assist:invincible", True)])
    flight.put_over(flight.scene.moon.pads[0], 12.0, (0.0, 300.0))
    flight.step(30)
    assert flight.ship.here and flight.ship.hull >= 1.0


def test_a_lost_ship_comes_back_on_the_last_pad():
    flight = Flight()
    flight.ship.pad = flight.scene.moon.pads[1]
    flight.ship.shells = 0
    flight.scene.give_up()
    flight.step(AWAY - 1)
    assert not flight.ship.here
    flight.step(3)
    assert flight.ship.here and abs(flight.ship.x - flight.scene.moon.pads[1].x) < 1.0
    assert (flight.ship.fuel, flight.ship.hull, flight.ship.shells) == (FUEL, HULL, FEWEST_SHELLS)


def test_without_ships_it_is_over():
    flight = Flight()
    for _ in range(LIVES):
        flight.until(lambda: flight.ship.here, AWAY + 5)
        flight.scene.give_up()
    flight.step(AWAY + 2)
    scene = flight.scene
    assert scene.course.mode == LOST and scene.result is not None and not scene.result.won
    result = scene.result
    flight.step(200, ["up", "fire"])
    assert scene.result is result and not flight.ship.here


def land(flight, number, speed=12.0):
    """Land the ship on the pad with this number, at this vertical speed [px/s]."""
    flight.put_over(flight.scene.moon.pads[number], 4.0, (0.0, speed))
    flight.until(lambda: flight.scene.course.mode != FLYING, 200)


def test_a_landing_counts_when_it_is_soft_upright_and_at_rest():
    flight = Flight()
    land(flight, 1)
    scene = flight.scene
    assert scene.course.mode == LANDED and scene.score.landings == 1
    named = dict(scene.course.counted)
    assert named["LANDING"] == 1000 and named["GENTLE"] == 1500 and named["CENTRED"] > 400 and named["HULL"] == 500
    flight.step(CHEER + 1)
    assert scene.course.mode == FLYING and scene.course.site.name == "cave"


def test_a_landing_elsewhere_counts_nothing_but_fills_the_tank():
    flight = Flight()
    flight.ship.fuel, flight.ship.hull, flight.ship.shells = 20.0, 50.0, 3
    flight.put_over(flight.scene.moon.pads[2], 4.0)
    flight.step(400)
    assert flight.scene.score.landings == 0 and flight.scene.course.site.name == "canyon"
    assert flight.ship.fuel == FUEL and flight.ship.hull == HULL and flight.ship.shells == SHELLS


def test_a_harder_landing_is_worth_less():
    worth = []
    for speed in (20.0, 45.0, 60.0):
        flight = Flight()
        land(flight, 1, speed)
        worth.append(dict(flight.scene.course.counted)["GENTLE"])
    assert worth[0] > worth[1] > worth[2] > 0


def test_a_ship_on_its_side_has_not_landed():
    flight = Flight()
    pad = flight.scene.moon.pads[1]
    flight.put(pad.x, pad.y - 15.0, angle=pi / 2)
    flight.step(150)
    assert flight.scene.score.landings == 0


def test_three_sites_are_a_flight_and_bonuses_are_counted():
    flight = Flight()
    for number in (1, 2, 3):
        land(flight, number)
        if number < 3:
            flight.until(lambda: flight.scene.course.mode == FLYING, CHEER + 2)
    scene = flight.scene
    assert scene.course.mode == CLEARED and scene.result is None
    before = scene.score.points
    flight.until(lambda: scene.result is not None, 1500)
    assert scene.course.mode == WON and scene.result.won
    names = [name for name, _ in scene.course.counted]
    assert names[-3:] == ["TIME", "SHIPS LEFT", "NO SHIP LOST"] and "ALL CARGO" not in names
    assert scene.score.points == before + sum(points for _, points in scene.course.counted[-3:])
    assert scene.result.points == scene.score.points and scene.result.lines[0].startswith(scene.score.medal.lower())


def test_stranded_without_fuel_the_ship_is_given_up():
    flight = Flight()
    flight.put(380.0, 540.0)
    flight.ship.fuel = 0.0
    flight.until(lambda: bool(flight.ship.touching), 300)
    flight.until(lambda: not flight.ship.here, STRANDED + 400)
    assert flight.scene.score.lost == 1


def test_a_can_holds_fuel():
    flight = Flight()
    x, y = flight.scene.moon.cans[1]
    flight.ship.fuel = 30.0
    flight.put(x, y - 40.0)
    cans = len(flight.scene.yard.cans)
    flight.until(lambda: len(flight.scene.yard.cans) < cans, 90)
    assert flight.ship.fuel == 30.0 + CAN and flight.scene.score.cans == 1


def test_the_line_holds_what_is_in_reach_and_lets_go():
    flight = Flight()
    identity, piece = flight.piece()
    x, y = piece.body.position
    flight.put(x, y - 150.0)
    flight.step(1, ["bomb"])
    assert flight.scene.line.load is None, "out of reach"
    flight.put(x, y - 40.0)
    flight.step(1)
    flight.step(1, ["bomb"])
    assert flight.scene.line.load.id == identity
    flight.until(lambda: piece.body.position.y < y - 40.0, 400, ["up"])
    gap = ((piece.body.position.x - flight.ship.x) ** 2 + (piece.body.position.y - flight.ship.y) ** 2) ** 0.5
    assert LINE - 8.0 < gap < LINE + 14.0, "it hangs at the line's end"
    flight.step(1)
    flight.step(1, ["bomb"])
    assert flight.scene.line.load is None
    rising = piece.body.velocity.y
    flight.step(20)
    assert piece.body.velocity.y > rising + 8.0, "it falls"


def test_a_load_is_felt():
    speeds = []
    for hooked in (False, True):
        flight = Flight()
        _, piece = flight.piece()
        piece.body.move_to((300.0, 260.0))
        flight.put(300.0, 214.0)
        flight.step(1, ["bomb"] if hooked else [])
        flight.step(60, ["up"])
        speeds.append(flight.ship.vy)
    assert speeds[1] > speeds[0] + 8.0


@pytest.mark.parametrize("whole", [100.0, 40.0])
def test_cargo_at_rest_on_a_pad_is_delivered_for_what_is_left_of_it(whole):
    flight = Flight()
    identity, piece = flight.piece()
    pad = flight.scene.moon.pads[0]
    piece.whole = whole
    flight.put(700.0, 200.0)
    flight.step(1, changes=[("assist:invincible", True)])
    piece.body.move_to((pad.x + 20.0, pad.y - 14.0))
    piece.body.velocity = (0.0, 0.0)
    flight.until(lambda: identity not in flight.scene.yard.cargo, 240)
    assert flight.scene.score.delivered == 1
    assert flight.scene.score.points == pytest.approx(DELIVERY * (0.25 + 0.75 * whole / 100.0), abs=5)


def test_cargo_is_hurt_by_hard_knocks_and_lost_by_harder_ones():
    left = []
    for speed in (40.0, 120.0, 400.0):
        flight = Flight()
        identity, piece = flight.piece()
        piece.body.move_to((370.0, 500.0))
        piece.body.velocity = (0.0, speed)
        flight.step(90)
        left.append(flight.scene.yard.cargo[identity].whole if identity in flight.scene.yard.cargo else 0.0)
    assert left[0] > left[1] > left[2] == 0.0


def test_the_drum_rolls_where_the_crate_stays():
    flight = Flight()
    _, drum = flight.piece(1)
    _, crate = flight.piece(0)
    for piece, pad in ((drum, flight.scene.moon.pads[1]), (crate, flight.scene.moon.pads[2])):
        piece.body.move_to((pad.x - 30.0, pad.y - 9.0))
        piece.body.velocity = (30.0, 0.0)
    flight.scene.yard.delivered = lambda held: []
    start = drum.body.position.x, crate.body.position.x
    flight.step(150)
    assert drum.body.position.x - start[0] > 1.5 * (crate.body.position.x - start[1])
    assert abs(drum.body.angle) > 1.0


def test_shells_leave_the_nose_push_back_and_end_by_themselves():
    flight = Flight()
    flight.put(300.0, 100.0, angle=pi / 2)
    flight.step(1, ["fire"])
    assert len(flight.scene.gun.shells) == 1 and flight.ship.shells == SHELLS - 1
    (identity,) = flight.scene.gun.shells
    assert flight.scene.world.body(identity).velocity.x > 250.0 and flight.ship.vx < -2.0
    flight.scene.world.body(identity).move_to((300.0, -400.0))
    flight.step(SHELL_LIFE + 2)
    assert not flight.scene.gun.shells and identity not in flight.scene.world


def test_a_burst_throws_what_is_near():
    flight = Flight()
    _, piece = flight.piece()
    piece.body.move_to((300.0, 300.0))
    flight.put(500.0, 100.0)
    flight.scene.blast(280.0, 300.0, 15.0)
    flight.step(1)
    assert piece.body.velocity.x > 40.0
    before = piece.body.velocity.x
    flight.scene.blast(100.0, 300.0, 15.0)
    flight.step(1)
    assert piece.body.velocity.x <= before, "too far away"


def test_the_wind_is_the_seeds_and_calm_in_caves():
    from random import Random

    moon = Flight().scene.moon
    one, same, other = (Weather(Random(seed), moon) for seed in (1, 1, 2))
    for weather in (one, same, other):
        for step in range(300):
            weather.step(step / 60, 3600.0, 200.0)
    assert one.state() == same.state() != other.state() and one.wind > 20.0
    for step in range(400):
        one.step(5.0 + step / 60, 2240.0, 780.0)
    assert abs(one.wind) < 1.0


def test_wind_blows_a_flying_ship_aside():
    flight = Flight()
    ways = []
    for wind in (0.0, 200.0):
        flight = Flight()
        flight.put(300.0, 100.0)
        flight.scene.weather.step = lambda *_, weather=flight.scene.weather, wind=wind: setattr(weather, "wind", wind)
        flight.step(60)
        ways.append(flight.ship.x)
    assert ways[1] > ways[0] + 5.0


def test_medals_are_for_points():
    score = Score()
    for name, least in MEDALS:
        score.points = least
        assert score.medal == name
    assert [least for _, least in MEDALS] == sorted((least for _, least in MEDALS), reverse=True)


def test_restart_is_the_first_frame_again():
    flight = Flight()
    flight.step(200, ["up", "fire"])
    flight.scene.restart()
    fresh = Flight()
    assert scene_digest(flight.scene) == scene_digest(fresh.scene)
    for each in (flight, fresh):
        each.inputs = type(each.inputs)()
        each.step(40, ["up"])
    assert scene_digest(flight.scene) == scene_digest(fresh.scene)
