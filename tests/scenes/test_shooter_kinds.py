"""Five kinds of enemies with their own ways of moving and firing, and the patterns that guns are made of."""

from math import atan2, degrees, hypot, pi

import pytest

from scenes.shooter.cast import GROUND_SPEED
from scenes.shooter.difficulty import EASY, Difficulty
from scenes.shooter.enemies import Gunship
from scenes.shooter.fleet import KINDS
from scenes.shooter.patterns import Gun, fan, lead, ring
from scenes.shooter.stage import Pattern
from tests.scenes.shooter_stages import Sky

SHOT = {
    "bullet": "red",
    "speed": 100.0,
    "every": 0.5,
    "after": 0.0,
    "shots": 1,
    "rest": 0.0,
    "faster": 0.0,
    "muzzles": ((0.0, 0.0),),
}


def flights(sky):
    """Return [(heading [deg], speed [px/s])] of the enemy's bullets, in the order in which they were fired."""
    rows = sky.scene.world.bodies[sky.scene.incoming.places()]
    return [
        (degrees(atan2(vy, vx)), hypot(vx, vy)) for vx, vy in zip(rows["vx"].tolist(), rows["vy"].tolist(), strict=True)
    ]


def fired(kind, x, y, steps, **group):
    """Return (sky, plane): a `Sky` in which a plane of a kind has acted for some steps."""
    sky = Sky()
    plane = sky.enemy(kind, x, y, thinks=True, **group)
    sky.step(steps)
    return sky, plane


def test_the_dart_waits_and_dives_at_where_you_were():
    sky = Sky()
    dart = sky.enemy("dart", 100, 60, thinks=True)
    dart.home_x = 100
    sky.until(lambda: dart.mode == "dive", 200)
    x, y = sky.scene.target
    wanted = atan2(y - dart.y, x - dart.x)
    assert abs(dart.heading - wanted) < 0.2 and dart.frame == "dart_1"
    sky.step(20, ["left"])
    assert atan2(dart.vy, dart.vx) == pytest.approx(dart.heading), "it does not turn any more"


def test_the_saucer_weaves_and_aims_from_above_only():
    sky, saucer = fired("saucer", 240, 40, 110, sway=60.0)
    assert abs(saucer.x - 240) > 5 and saucer.volleys
    assert all(20 < heading < 160 for heading, _ in flights(sky))
    sky, saucer = fired("saucer", 240, 200, 100)
    assert not saucer.volleys, "it is beside you, not above"


def test_the_gunship_fires_fans_and_rings_by_turns_and_leaves():
    sky, gunship = fired("gunship", 240, 56, 40)
    sky.until(lambda: gunship.volleys == 1, 200)
    count = len(sky.scene.incoming.volley["orange"]) + len(sky.scene.incoming)
    assert count == 5
    sky.until(lambda: gunship.volleys == 2, 200)
    sky.step()
    assert len(sky.scene.incoming) >= 16
    sky.scene.plane.shelter(99999)
    sky.until(lambda: gunship.id not in sky.scene.fleet.planes, 1500)


def test_a_plane_fits_between_two_bullets_of_a_gunships_fan():
    assert Gunship.FAN_GAP * 140 > 30 + 12


def test_the_hornet_flies_an_arc_and_fires_at_where_you_will_be():
    sky = Sky()
    hornet = sky.enemy("hornet", 20, 70, thinks=True, side="left", bend=90.0)
    headings = []
    for _ in range(100):
        sky.step(1, ["right"])
        headings.append(hornet.heading)
    assert headings[0] == 0.0 and headings[-1] == pytest.approx(pi / 2)
    assert sorted(headings) == headings
    rows = sky.scene.world.bodies[sky.scene.incoming.places()]
    assert len(rows) and (rows["vx"] > 0.0).all()


@pytest.mark.parametrize(
    ("side", "share", "inward"), [("left", 0.3, (1, 0)), ("right", 0.3, (-1, 0)), ("below", 0.4, (0, -1))]
)
def test_hornets_come_in_from_any_side_and_are_turned_as_they_fly(side, share, inward):
    sky = Sky()
    hornet = sky.enemy("hornet", 0, 0, thinks=True, side=side, bend=0.0)
    x, y = type(hornet).entry(type("Group", (), {"side": side}), share)
    sky.scene.world.body(hornet.id).move_to((x, y))
    sky.step(30)
    moved = hornet.x - x, hornet.y - y
    assert moved[0] * inward[0] + moved[1] * inward[1] > 50
    row = sky.scene.world.bodies[sky.scene.world.rows([hornet.id])[0]]
    assert row["angle"] == pytest.approx(hornet.heading - pi / 2, abs=0.06)


def test_the_turret_stands_on_the_ground_and_cannot_be_rammed():
    sky = Sky()
    turret = sky.enemy("turret", *sky.scene.target, thinks=True)
    before = sky.scene.scrolled
    sky.step(60)
    assert turret.vy == GROUND_SPEED and sky.scene.scrolled - before == pytest.approx(GROUND_SPEED)
    assert not sky.scene.stricken and sky.scene.hits.count["hull"] == 0
    sky.scene.shots.fire("shot", turret.x, turret.y + 30, [-pi / 2], 300.0)
    sky.until(lambda: turret.health < turret.full, 30)


def test_the_turret_fires_walls_and_fans():
    sky, turret = fired("turret", 240, 20, 80)
    assert len(sky.scene.incoming) == 5 and {round(heading) for heading, _ in flights(sky)} == {90}
    sky.until(lambda: turret.volleys == 2, 200)
    sky.step()
    assert len(sky.scene.incoming) == 8


def test_every_kind_has_health_points_and_a_pace_that_makes_it_harder():
    group = type("Group", (), {"hover": 50.0, "sway": 40.0, "bend": 10.0, "side": "left"})
    for made in KINDS.values():
        easy, hard = made(0.0, 0.0, group, EASY), made(0.0, 0.0, group, Difficulty(armour=2.0))
        assert made.points > 0 and hard.health == 2 * easy.health > 0


# --- primitives ------------------------------------------------------------------------------------------------------


def shoot(steps=1, **fields):
    """Return a `Sky` in which a gun at (240, 60) has fired for some steps. fields: changed fields of its pattern."""
    sky = Sky()
    sky.scene.plane.shelter(9999)
    gun = Gun(Pattern(**(SHOT | fields)))
    for _ in range(steps):
        gun.step(sky.scene, 240.0, 60.0)
        sky.step()
    return sky


def test_aimed_and_fan_point_at_the_player():
    sky = shoot(shoot="aimed")
    assert [round(heading) for heading, _ in flights(sky)] == [90]
    sky = shoot(shoot="fan", count=5, spread=40.0)
    assert [round(heading) for heading, _ in flights(sky)] == [70, 80, 90, 100, 110]
    sky = shoot(shoot="fan", count=3, spread=40.0, heading=0.0)
    assert [round(heading) for heading, _ in flights(sky)] == [-20, 0, 20]


def test_a_ring_goes_all_around_and_turns_from_shot_to_shot():
    sky = shoot(31, shoot="ring", count=4, turn=10.0)
    assert sorted(round(heading) % 360 for heading, _ in flights(sky)) == [0, 10, 90, 100, 180, 190, 270, 280]


def test_a_spiral_sways_with_its_period():
    sky = shoot(121, shoot="spiral", count=1, sway=30.0, period=2.0)
    headings = [heading for heading, _ in flights(sky)]
    assert max(headings) > 115 and min(headings) < 65


def test_a_stream_keeps_the_heading_it_began_with_and_gets_faster():
    sky = Sky()
    gun = Gun(Pattern(**(SHOT | {"shoot": "stream", "every": 0.1, "shots": 3, "rest": 5.0, "faster": 20.0})))
    for _ in range(30):
        gun.step(sky.scene, 240.0, 60.0)
        sky.step(1, ["left"])
    found = flights(sky)
    assert len(found) == 3 and len({round(heading, 6) for heading, _ in found}) == 1
    assert [round(speed) for _, speed in found] == [100, 120, 140]


def test_lead_meets_a_target_that_flies_on():
    heading = lead(0.0, 0.0, (0.0, 100.0), (50.0, 0.0), 130.0)
    time = 100.0 / (130.0 * abs(-1) * (1 - (50 / 130) ** 2) ** 0.5)
    assert degrees(heading) == pytest.approx(degrees(atan2(100.0, 50.0 * time)), abs=1.5)
    assert lead(0.0, 0.0, (0.0, 100.0), (0.0, 0.0), 130.0) == pytest.approx(pi / 2)


def test_a_wall_crosses_the_sky_with_one_gap():
    sky = shoot(2, shoot="wall", spacing=16.0, gap=80.0, shift=100.0)
    places = sorted(sky.scene.world.bodies["x"][sky.scene.incoming.places()].tolist())
    gaps = [b - a for a, b in zip(places, places[1:], strict=False) if b - a > 17]
    assert places[0] < 30 and places[-1] > 450 and len(gaps) == 1 and gaps[0] >= 80


def test_bursts_rest_and_uneven_rates_are_kept_on_average():
    sky = shoot(240, shoot="aimed", speed=40.0, every=0.07)
    assert len(sky.scene.incoming) in (56, 57, 58)
    sky = shoot(240, shoot="aimed", speed=40.0, every=0.1, shots=5, rest=1.5)
    assert len(sky.scene.incoming) == 10


def test_headings_are_spread_evenly():
    assert fan(1.0, 1, 2.0) == [1.0] and fan(0.0, 3, 2.0) == [-1.0, 0.0, 1.0]
    assert ring(4) == pytest.approx([0.0, pi / 2, pi, 3 * pi / 2])
