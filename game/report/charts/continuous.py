"""Charts 6 and 7: fast discs that fly at a thin plate.

The charts show the share of discs that tunnel and the cost. For the other discs, they show the distance of the reported
contact from the exact contact. The reference is analytic. A disc on a straight path first touches an upright plate when
the distance of its centre from the plate equals its radius. A discrete test between steps misses max(0, 1 - (w + 2r) /
(v dt)) of the discs that fly at the plate's face.
"""

from collections.abc import Sequence

import numpy as np

from game.measure.rates import Rate
from game.measure.timing import Cost, clock, undisturbed
from game.report.chart import Axis, Chart, Panel, panel_is, percent, time, value
from game.report.claim import FAILS, HOLDS, Claim, ordering, pair, ratio_of, region
from game.report.job import Job, ReportScope, Row, counted, spread
from physics import Circle, Effects, Polygon, World
from physics.annotations import ContinuousName

RADIUS, WIDTH, HALF = 5.0, 1.0, 11.0  # [px] of the disc, the plate's width, half its height
APART = 80.0  # [px] between two lanes; each has a disc and a plate
RUN_UP, STEPS, RUNS = 2, 60, 5  # steps before the plate; 300 timed steps
RATIOS = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)  # disc diameters per step
WAYS: tuple[tuple[ContinuousName, int], ...] = (
    ("off", 1),
    ("ray", 1),
    ("swept", 1),
    ("toi", 1),
    ("auto", 1),
    *(("off", k) for k in (2, 4, 8, 16, 32)),
)
VISIBLE = 1.0  # [px]
COUNTS = (1, 10, 100, 1000)  # discs
SWEPT, SHARES = (0.3, 1.0, 3.0, 10.0), (0.0, 0.1, 0.5, 1.0)  # diameters per step; share of the discs that hit a plate
HITTING, ROUNDS, DISCS = 6, 5, 200  # steps in which they hit, repetitions of these in a run, discs
PRICE, PRICE_WORDS = (2.0, 5.0), "2 to 5 x/less/more"  # what engines' manuals say of a body's time
EFFECTS = Effects(response=True, continuous=True)


def name_of(way: str, divided: int) -> str:
    """Return the name of a method in the chart. way: kind of continuous collision.

    divided: number of parts into which each step is divided. If it is not 1, the name contains only this number.
    """
    return way if divided == 1 else f"{divided} steps in one"


def starts(lanes: int, step: float) -> np.ndarray:
    """Return the start positions [px] of the discs, (lanes, 2), one disc per lane.

    step: path of a disc in one step [px]. The distances of the discs from the plate are spread over the length of a
    step. The discs fly at the plate's face, at its ends, or past it.
    """
    chance = np.random.default_rng(8)
    x = -RUN_UP * step - RADIUS - WIDTH - step * (np.arange(lanes) + 0.5) / lanes
    aside = chance.uniform(-1.2, 1.2, lanes) * (HALF + RADIUS)
    return np.column_stack([x, APART * np.arange(lanes) + aside])


def first_touch(aside: np.ndarray) -> np.ndarray:
    """Return (n,) x [px] of the discs' centres at their first contact with the plate; NaN for discs that miss it.

    aside: (n,) distances [px] of the discs' paths from the plate's middle.
    """
    beyond = np.maximum(np.abs(aside) - HALF, 0.0)
    reach = np.full(len(aside), np.nan)
    meets = beyond < RADIUS
    reach[meets] = -WIDTH / 2 - np.sqrt(RADIUS**2 - beyond[meets] ** 2)
    return reach


def world_of(way: ContinuousName, divided: int, lanes: int, ratio: float, plates: bool = True) -> World:
    """Return a world of parallel lanes, each with a disc and a plate.

    way: kind of continuous collision; divided: number of parts into which a step of 1/60 s is divided; ratio: path of a
    disc in 1/60 s [diameters]; plates: False omits the plates.
    """
    step = ratio * 2.0 * RADIUS
    world = World(EFFECTS, dt=1.0 / 60.0 / divided)
    if plates:
        middles = np.column_stack([np.zeros(lanes), APART * np.arange(lanes)])
        world.add_bodies(Polygon.box(WIDTH, 2 * HALF), middles, kind="static")
    world.add_bodies(Circle(RADIUS), starts(lanes, step), np.full((lanes, 2), (60.0 * step, 0.0)), continuous=way)
    return world


def measure(ratio: float, lanes: int) -> list[Row]:
    """Return a row for each method: missed hits, false hits, and the error of the position of the contact.

    The error is the distance of the disc at the reported contact from its position at the first touch [px]. ratio: path
    of a disc in 1/60 s [diameters]; lanes: number of discs.
    """
    step = ratio * 2.0 * RADIUS
    begin = starts(lanes, step)
    touch = first_touch(begin[:, 1] - APART * np.arange(lanes))
    meets = ~np.isnan(touch)
    depth = RADIUS - np.maximum(np.abs(begin[:, 1] - APART * np.arange(lanes)) - HALF, 0.0)
    rows = []
    for way, divided in WAYS:
        world = world_of(way, divided, lanes, ratio)
        discs = {int(row["id"]): k for k, row in enumerate(world.bodies[lanes:])}
        late = np.full(lanes, np.nan)
        failures = 0
        flown = int(np.ceil((2.0 * (RADIUS + WIDTH) - begin[:, 0].min()) / step)) + 1
        for _ in range(flown * divided):
            world.step()
            failures += world.profile.counters["cap_hits"]
            for event in world.events.begin:
                identity = int(event["body_a"]) if int(event["body_a"]) in discs else int(event["body_b"])
                lane = discs[identity]
                if np.isnan(late[lane]):
                    late[lane] = abs(float(world.body(identity).position.x) - touch[lane]) if meets[lane] else 0.0
        reported = ~np.isnan(late)
        missed = Rate(int((meets & ~reported).sum()), int(meets.sum()))
        ghost = Rate(int((reported & ~meets).sum()), int(reported.sum()))
        found = late[meets & reported]
        rows.append(
            {
                "series": name_of(way, divided),
                "label": f"{name_of(way, divided)}, {ratio:g} sizes a step",
                "panel": "miss",
                "ratio": ratio,
                "missed": counted(missed),
                "ghost": counted(ghost),
                "deepest_missed": float(depth[meets & ~reported].max(initial=0.0)),
                "late": [float(each) for each in np.percentile(found, (5, 50, 95))] if len(found) else None,
                "failures": {"cap_hits": failures},
            }
        )
    return rows


def measure_times(count: int) -> list[Row]:
    """Return a row for each method: the time to simulate 1/60 s with `count` discs.

    Each disc moves ten diameters in 1/60 s. There is one plate for every ten discs.
    """
    ratio, spent = 10.0, {}  # diameters per step
    rates = {row["series"]: row for row in measure(ratio, 200)}
    with undisturbed():
        for turn in range(RUNS + 1):
            for way, divided in WAYS:
                world = _traffic(way, divided, count, ratio)
                started = clock()
                for _ in range(STEPS * divided):
                    world.step()
                if turn:  # the first run compiles missing kernels
                    spent.setdefault((way, divided), []).append((clock() - started) / STEPS)
    return [
        {
            "series": name_of(way, divided),
            "label": f"{name_of(way, divided)}, {count} discs",
            "panel": "time",
            "n": count,
            "ratio": ratio,
            "missed": rates[name_of(way, divided)]["missed"],
            "deepest_missed": rates[name_of(way, divided)]["deepest_missed"],
            "cost": spread(Cost.of(times, STEPS)),
        }
        for (way, divided), times in spent.items()
    ]


def measure_density(ratio: float) -> list[Row]:
    """Return a row for each method and each share of discs that hit a plate: the time of a step, and the hits.

    ratio: path of a disc in 1/60 s [diameters]. Every run repeats the same HITTING steps, because a disc flies no more
    after its hit. The step before them, in which the discs are new to the broad phase, is not timed.
    """
    rows = []
    for share in SHARES:
        worlds = {way: _hitting(way, share, ratio) for way in ("off", "toi", "auto")}
        begin = {way: world.bodies[["x", "y", "vx", "vy"]].copy() for way, world in worlds.items()}
        spent, hits = {way: [] for way in worlds}, dict.fromkeys(worlds, 0)
        with undisturbed():
            for turn in range(RUNS + 1):
                for way, world in worlds.items():
                    seconds = 0.0
                    for _ in range(ROUNDS):
                        _put_back(world, begin[way])
                        world.step()
                        for _ in range(HITTING):
                            started = clock()
                            world.step()
                            seconds += clock() - started
                            hits[way] += 0 if turn else len(world.events.begin)
                    if turn:  # the first run compiles missing kernels
                        spent[way].append(seconds / (ROUNDS * HITTING))
        rows += [
            {
                "series": way,
                "label": f"{way}, {ratio:g} sizes a step, {100 * share:g} % hit",
                "panel": _density(share),
                "ratio": ratio,
                "share": share,
                "hits": hits[way] / ROUNDS,
                "cost": spread(Cost.of(times, ROUNDS * HITTING)),
            }
            for way, times in spent.items()
        ]
    return rows


def _put_back(world, begin):
    """Move all bodies to their poses and velocities in `begin`, without rows of contacts that they had."""
    for name in ("vx", "vy"):
        world.bodies[name] = begin[name]
    world.move(world.bodies["id"], np.column_stack([begin["x"], begin["y"]]))


def _density(share):
    """Return the name of the panel for a share 0..1 of discs that hit a plate."""
    return f"{DISCS} discs, {100 * share:g} % hit in {HITTING} steps"


def _hitting(way, share, ratio):
    """Return a world of DISCS discs, of which a share hits a plate in the steps 2 to 1 + HITTING."""
    step, hitting = ratio * 2.0 * RADIUS, round(share * DISCS)
    world, lanes = World(EFFECTS), APART * np.arange(DISCS)
    if hitting:
        at = RADIUS + WIDTH + step * (1.0 + HITTING * (np.arange(hitting) + 0.5) / hitting)
        which = np.linspace(0, DISCS - 1, hitting).astype(int)
        world.add_bodies(Polygon.box(WIDTH, 2 * HALF), np.column_stack([at, lanes[which]]), kind="static")
    speeds = np.full((DISCS, 2), (60.0 * step, 0.0))
    world.add_bodies(Circle(RADIUS), np.column_stack([np.zeros(DISCS), lanes]), speeds, continuous=way)
    return world


def _traffic(way, divided, count, ratio):
    """Return a world of discs that fly through a field of plates. Most discs hit no plate.

    count: number of discs; the other arguments are those of world_of().
    """
    step = ratio * 2.0 * RADIUS
    world = World(EFFECTS, dt=1.0 / 60.0 / divided)
    chance = np.random.default_rng(9)
    lanes = APART * np.arange(count)
    plates = np.column_stack([chance.uniform(0.0, STEPS * step, count), lanes])[::10]
    world.add_bodies(Polygon.box(WIDTH, 2 * HALF), plates, kind="static")
    world.add_bodies(
        Circle(RADIUS),
        np.column_stack([np.zeros(count), lanes]),
        np.full((count, 2), (60.0 * step, 0.0)),
        continuous=way,
    )
    world.step()
    return world


def _jobs(scope: ReportScope) -> list[Job]:
    lanes = 200 if scope.quick else 1000
    ratios = RATIOS[::2] if scope.quick else RATIOS
    counts = COUNTS[1:3] if scope.quick else COUNTS
    work = __name__
    return [
        *(Job(f"continuous/miss-{r:g}", f"{work}:measure", {"ratio": r, "lanes": lanes}, lanes / 200) for r in ratios),
        *(Job(f"continuous/time-{n}", f"{work}:measure_times", {"count": n}, 2.0 + n / 50) for n in counts),
        *(
            Job(f"continuous/density-{r:g}", f"{work}:measure_density", {"ratio": r}, 1.5)
            for r in SWEPT[:: 3 if scope.quick else 1]
        ),
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for row in rows:
        if row["panel"] == "miss" and row["series"] == "off":
            rate, expected = Rate(*row["missed"]), _expected(row["ratio"])
            low, high = rate.interval
            found.append(
                Claim(
                    f"looked at between steps only, {row['ratio']:g} sizes a step: {100 * expected:.1f} % are missed",
                    f"{100 * rate.share:.1f} % ({100 * low:.1f} to {100 * high:.1f})",
                    HOLDS if low <= expected <= high else FAILS,
                    "1 - chord / (v dt), averaged over where it flies",
                )
            )
    return found


def _time_claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    timed = [row for row in rows if row["panel"] == "time"]
    for count in dict.fromkeys(row["n"] for row in timed):
        sure = {
            row["series"]: pair(row["cost"]) for row in timed if row["n"] == count and row["deepest_missed"] < VISIBLE
        }
        if len(sure) > 1:
            found.append(ordering(f"{count} discs at ten sizes a step, none missed that was in by a pixel", sure))
    for share in SHARES:
        costs = {(row["series"], row["ratio"]): row["cost"] for row in rows if row["panel"] == _density(share)}
        ratios = {f"{r:g}": ratio_of(costs["toi", r], costs["off", r]) for r in SWEPT if ("toi", r) in costs}
        if ratios:
            text = f"continuous collision costs 2 to 5 x at every number of sizes a step, where {100 * share:g} % hit"
            found.append(region(text, ratios, PRICE, PRICE_WORDS, "common advice in engines' manuals"))
    return found


def _expected(ratio):
    """Return the share of hits that a discrete test misses in theory, averaged over all paths that meet the plate.

    ratio: path of a disc per step [diameters].
    """
    step = ratio * 2.0 * RADIUS
    aside = np.abs(np.linspace(0.0, HALF + RADIUS, 20_001))[:-1]
    beyond = np.maximum(aside - HALF, 0.0)
    chord = WIDTH + 2.0 * np.sqrt(RADIUS**2 - beyond**2)
    return float(np.maximum(0.0, 1.0 - chord / step).mean())


_missed = Axis("missed hits [%]", percent("missed"), log=False)
CHART = Chart(
    6,
    "continuous",
    "Fast bodies: missed hits",
    "How many hits are missed as bodies move further in a step, and how late are the others reported?",
    "a straight path past an upright plate, in closed form",
    (
        Panel("missed", Axis("v dt / size", value("ratio")), _missed, lambda r: r["panel"] == "miss", "series"),
        Panel(
            "how deep what was missed would have been",
            Axis("v dt / size", value("ratio")),
            Axis("missed, in by at most [px]", value("deepest_missed"), log=False, mark=VISIBLE),
            lambda r: r["panel"] == "miss",
            "series",
        ),
        Panel(
            "reported how far from the first touch",
            Axis("v dt / size", value("ratio")),
            Axis("off by [px]", value("late"), mark=1.0),
            lambda r: r["panel"] == "miss",
            "series",
        ),
    ),
    _jobs,
    _claims,
)
TIME_CHART = Chart(
    7,
    "continuous-time",
    "Fast bodies: the cost of sweeps",
    "How long is a step with discs at ten sizes a step, and how many hits does it miss?",
    "as chart 6",
    (
        *(
            Panel(
                f"{count} discs",
                Axis("us a step", time("cost")),
                _missed,
                lambda r, n=count: r["panel"] == "time" and r["n"] == n,
            )
            for count in COUNTS
        ),
        *(
            Panel(
                _density(share),
                Axis("v dt / size", value("ratio")),
                Axis("us a step", time("cost")),
                panel_is(_density(share)),
                "series",
            )
            for share in SHARES
        ),
    ),
    lambda scope: [],
    _time_claims,
    of="continuous",
)
