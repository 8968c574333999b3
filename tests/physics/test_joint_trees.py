"""Trees of joints are solved exactly, compared with dense and rational solutions for masses over six decades."""

from fractions import Fraction

import numpy as np
import pytest

import physics
from physics.solver.joint_trees import (
    JOINT_ROW,
    MOST_ROWS,
    build_forest,
    factor_trees,
    new_forest,
    solve_trees,
    with_room,
)
from physics.tables.contact import MOTION
from physics.tables.table import zeros_in_lines

WORLD = 0  # the MOTION row of everything fixed
VELOCITY = ("vx", "vy", "angular_velocity")
FREE = ("free_vx", "free_vy", "free_w")
SIDE_A, SIDE_B = ("ax", "ay", "aw"), ("bx", "by", "bw")


# ---- problems --------------------------------------------------------------------------------------------------------


class Joints:
    """A system of joints between bodies, which a test builds and solves."""

    def __init__(self, bodies):
        self.motions = zeros_in_lines(bodies + 1, MOTION)
        self.ids, self.a, self.b, self.counts, self.rows = [], [], [], [], []

    def mass(self, body, inverse_mass, inverse_inertia):
        self.motions["inverse_mass"][body], self.motions["inverse_inertia"][body] = inverse_mass, inverse_inertia

    def move(self, body, *velocity):
        for names in (VELOCITY, FREE):
            for name, value in zip(names, velocity, strict=True):
                self.motions[name][body] = value

    def add(self, a, b, rows, identity=None):
        """Add a joint between bodies a and b.

        rows: (Jacobian of A, Jacobian of B, right-hand side, compliance) of each of its rows. identity: id of the
        joint, None for the next number.
        """
        self.ids.append(len(self.ids) if identity is None else identity)
        self.a.append(a)
        self.b.append(b)
        self.counts.append(len(rows))
        rows = [(*left, *right, rhs, soft, 0.0, 0.0) for left, right, rhs, soft in rows]
        self.rows += rows + [(0.0,) * 10] * (MOST_ROWS - len(rows))

    def pin(self, a, b, arm_a, arm_b, rhs=(0.0, 0.0), soft=0.0):
        self.add(a, b, pin_rows(arm_a, arm_b, rhs, soft))

    def weld(self, a, b, arm_a, arm_b, rhs=(0.0, 0.0, 0.0), soft=0.0):
        self.add(a, b, [*pin_rows(arm_a, arm_b, rhs, soft), ((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), rhs[2], soft)])

    def shuffled(self, order):
        """Return a copy of the system with the same joints and ids in another order."""
        other = Joints(len(self.motions) - 1)
        other.motions[:] = self.motions
        for name in ("ids", "a", "b", "counts"):
            setattr(other, name, [getattr(self, name)[j] for j in order])
        other.rows = [row for j in order for row in self.rows[MOST_ROWS * j : MOST_ROWS * (j + 1)]]
        return other

    def solve(self, forest=None):
        """Solve the system and return it.

        The results are `taken`, `redundant`, `impulses` (joints, MOST_ROWS), and `after`, the bodies as MOTION rows.
        forest: workspace, None for a new one.
        """
        self.joint_rows = np.array(self.rows, JOINT_ROW) if self.rows else np.zeros(0, JOINT_ROW)
        a, b = np.array(self.a, np.int32), np.array(self.b, np.int32)
        self.after = zeros_in_lines(len(self.motions), MOTION)
        self.after[:] = self.motions
        self.taken = np.zeros(len(a), bool)
        self.forest = new_forest(max(len(a), 1), len(self.motions)) if forest is None else forest
        order = np.argsort(np.array(self.ids, np.int64), kind="stable")
        self.number = build_forest(order, a, b, self.after, self.forest, self.taken)
        self.row_counts = np.array(self.counts, np.int32)
        self.redundant = factor_trees(self.joint_rows, self.row_counts, self.after, self.forest)
        solve_trees(self.forest, self.joint_rows, self.after)
        self.impulses = self.joint_rows["impulse"].reshape(-1, MOST_ROWS)
        return self

    def bits(self):
        """Return the bytes of every number of the solution, in the order of ids."""
        order = np.argsort(self.ids)
        return [self.after[name].tobytes() for name in VELOCITY + FREE] + [self.impulses[order].tobytes()]


def pin_rows(arm_a, arm_b, rhs, soft):
    (ax, ay), (bx, by) = arm_a, arm_b
    return [((-1.0, 0.0, ay), (1.0, 0.0, -by), rhs[0], soft), ((0.0, -1.0, -ax), (0.0, 1.0, bx), rhs[1], soft)]


def chain(links, ratio=1.0, weld=False, ends=1, backwards=False, bend=0.3, seed=0):
    """Return a system of links of 20 px, joined to the world at one end or at both; the last is
    `ratio` times as heavy.
    """
    rng = np.random.default_rng(seed)
    joints = Joints(links)
    bodies = list(range(1, links + 1))[:: -1 if backwards else 1]
    angles = bend * (1.0 + np.sin(0.37 * np.arange(links)))
    halves = 10.0 * np.stack([np.cos(angles), np.sin(angles)], 1)
    for body in bodies:
        heavy = ratio if body == bodies[-1] else 1.0
        joints.mass(body, 1.0 / heavy, 0.03 / heavy)
        joints.move(body, *rng.normal(size=2), 0.1 * rng.normal())
    join = joints.weld if weld else joints.pin
    for k in range(links + (ends == 2)):
        a = bodies[k - 1] if k else WORLD
        b = bodies[k] if k < links else WORLD
        arm_a = halves[k - 1] if k else np.zeros(2)
        arm_b = -halves[k] if k < links else np.zeros(2)
        rhs = rng.normal(size=3) * (1.0, 1.0, 0.01)
        join(a, b, arm_a, arm_b, tuple(rhs))
    return joints


def random_forest(seed, decades=0.0, soft=0.0):
    """Return a system of random trees of bodies with joints of 1 to 3 rows.

    The joints connect the bodies to each other, to the world and to a kinematic body. decades: range of the masses in
    powers of ten. soft: above 0 for joints of more than one row, some of them with compliance.
    """
    rng = np.random.default_rng(seed)
    bodies = int(rng.integers(1, 61))
    joints = Joints(bodies + 1)
    kinematic = bodies + 1
    joints.move(kinematic, 1.0, -2.0, 0.3)
    names = rng.permutation(10 * bodies)
    for body in range(1, bodies + 1):
        inverse = 10.0 ** -rng.uniform(0.0, decades)
        free = rng.random()
        joints.mass(
            body, inverse if free > 0.05 else 0.0, inverse * 0.02 if free < 0.8 else 0.0
        )  # some are fixed in part
        joints.move(body, *rng.normal(size=3))
    pairs = []
    for body in rng.permutation(np.arange(2, bodies + 1)):
        if rng.random() < 0.8:
            pairs.append((int(rng.integers(1, body)), int(body)))
    held = rng.permutation(np.arange(1, bodies + 1))[: bodies // 4]
    pairs += [(int(body), WORLD if rng.random() < 0.7 else kinematic) for body in held]
    for number, (a, b) in enumerate(pairs):
        a, b = (a, b) if rng.random() < 0.5 else (b, a)
        count = int(rng.integers(1, 4)) if soft else 1
        rows = []
        for _ in range(count):
            left, right = rng.normal(size=3) * (1.0, 1.0, 5.0), rng.normal(size=3) * (1.0, 1.0, 5.0)
            rows.append((left, right, rng.normal(), soft * rng.uniform(0.1, 1.0)))
        joints.add(a, b, rows, int(names[number]))
    return joints


# ---- oracles ---------------------------------------------------------------------------------------------------------


def system(joints):
    """Return (Jacobian, right-hand sides, compliances, inverse masses, velocities, keys) of the taken joints' rows.

    The Jacobian has the shape (rows, 3 · motions). Taken are the joints that the solver solves. keys: (joint, row of
    the joint) of each row.
    """
    motions = joints.motions
    columns = 3 * len(motions)
    jacobian, rhs, soft, places = [], [], [], []
    for j in np.flatnonzero(joints.taken):
        for r in range(joints.counts[j]):
            row, line = joints.joint_rows[MOST_ROWS * j + r], np.zeros(columns)
            line[3 * joints.a[j] : 3 * joints.a[j] + 3] += [row[name] for name in SIDE_A]
            line[3 * joints.b[j] : 3 * joints.b[j] + 3] += [row[name] for name in SIDE_B]
            jacobian.append(line)
            rhs.append(row["rhs"])
            soft.append(row["compliance"])
            places.append((j, r))
    inertia = motions["inverse_inertia"]
    inverse = np.stack([motions["inverse_mass"], motions["inverse_mass"], inertia], 1).ravel()
    before = np.stack([motions[name] for name in VELOCITY], 1).ravel()
    return np.array(jacobian).reshape(-1, columns), np.array(rhs), np.array(soft), inverse, before, places


def dense_solution(joints):
    """Return (impulses, velocities, keys) of the taken joints, solved by NumPy; keys as in `system`."""
    jacobian, rhs, soft, inverse, before, places = system(joints)
    matrix = (jacobian * inverse) @ jacobian.T + np.diag(soft)
    scale = 1.0 / np.sqrt(np.diag(matrix))
    found = scale * np.linalg.solve(matrix * scale * scale[:, None], scale * (rhs - jacobian @ before))
    return found, before + inverse * (jacobian.T @ found), places


def exact_solution(joints):
    """Return (impulses, velocities, keys) of the taken joints in rational numbers, solved by Gaussian elimination.

    keys: as in `system`.
    """
    jacobian, rhs, soft, inverse, before, places = system(joints)
    lines = [{k: Fraction(x) for k, x in enumerate(line.tolist()) if x} for line in jacobian]
    masses, start = [Fraction(x) for x in inverse.tolist()], [Fraction(x) for x in before.tolist()]
    count = len(lines)
    table = []
    for i, line in enumerate(lines):
        row = [sum((x * masses[k] * other.get(k, 0) for k, x in line.items()), Fraction(0)) for other in lines]
        row[i] += Fraction(float(soft[i]))
        table.append(row + [Fraction(float(rhs[i])) - sum(x * start[k] for k, x in line.items())])
    for i in range(count):
        for k in range(i + 1, count):
            if table[k][i]:
                factor = table[k][i] / table[i][i]
                table[k] = [x - factor * y for x, y in zip(table[k], table[i], strict=True)]
    found = [Fraction(0)] * count
    for i in reversed(range(count)):
        found[i] = (table[i][-1] - sum(table[i][k] * found[k] for k in range(i + 1, count))) / table[i][i]
    for line, impulse in zip(lines, found, strict=True):
        for k, x in line.items():
            start[k] += masses[k] * x * impulse
    return np.array([float(x) for x in found]), np.array([float(x) for x in start]), places


def velocities(joints):
    return np.stack([joints.after[name] for name in VELOCITY], 1).ravel()


def residuals(joints):
    """Return (greatest violation of a row, greatest velocity error), both relative and computed in rational numbers.

    A velocity error is the difference from the velocity that follows from the impulses.
    """
    jacobian, rhs, soft, inverse, before, places = system(joints)
    after = [Fraction(x) for x in velocities(joints).tolist()]
    pushed, size = [Fraction(x) for x in before.tolist()], [abs(Fraction(x)) for x in before.tolist()]
    violations, largest = [], max(size) * Fraction(float(np.abs(jacobian).max()))
    for line, wanted, compliance, (j, r) in zip(jacobian, rhs, soft, places, strict=True):
        impulse = Fraction(float(joints.impulses[j, r]))
        terms = [Fraction(float(compliance)) * impulse, -Fraction(float(wanted))]
        for k in np.flatnonzero(line).tolist():
            x = Fraction(float(line[k]))
            terms.append(x * after[k])
            change = Fraction(float(inverse[k])) * x * impulse
            pushed[k] += change
            size[k] += abs(change)
        violations.append(abs(sum(terms)))
        largest = max(largest, *map(abs, terms))
    unexplained = [abs(x - y) / each for x, y, each in zip(pushed, after, size, strict=True) if each]
    return float(max(violations) / largest), float(max(unexplained))


def impulses_of(joints, places):
    return np.array([joints.impulses[place] for place in places])


# ---- solutions -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("soft", [0.0, 0.1])
@pytest.mark.parametrize("decades", [0.0, 6.0])
@pytest.mark.parametrize("seed", range(8))
def test_random_forests_are_solved_as_by_numpy(seed, decades, soft):
    joints = random_forest(seed, decades, soft)
    joints.solve()
    assert joints.redundant == 0
    impulses, after, places = dense_solution(joints)
    assert np.allclose(impulses_of(joints, places), impulses, rtol=1e-6, atol=1e-9 * np.abs(impulses).max(initial=1.0))
    assert np.allclose(velocities(joints), after, rtol=1e-7, atol=1e-7)
    violation, unexplained = residuals(joints)
    assert violation < 1e-12 and unexplained < 1e-12


@pytest.mark.parametrize("weld", [False, True])
@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("ratio", [1.0, 1e6, 1e9])
def test_a_heavy_body_on_a_light_chain_is_solved_as_in_rational_numbers(ratio, backwards, weld):
    joints = chain(6, ratio, weld, backwards=backwards).solve()
    impulses, after, places = exact_solution(joints)
    assert np.allclose(impulses_of(joints, places), impulses, rtol=1e-11, atol=1e-13 * np.abs(impulses).max())
    assert np.allclose(velocities(joints), after, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("weld", [False, True])
@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("ratio", [1.0, 1e6])
def test_a_chain_of_200_links_leaves_no_residual(ratio, backwards, weld):
    joints = chain(200, ratio, weld, backwards=backwards).solve()
    assert joints.number == 200 and joints.redundant == 0
    violation, unexplained = residuals(joints)
    assert violation < (1e-10 if weld else 1e-14) and unexplained < 1e-10


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("ratio", [1.0, 1e6])
@pytest.mark.parametrize("links", [2, 3, 60])
def test_a_bridge_is_one_tree_with_joints_to_the_world_at_both_ends(links, ratio, backwards):
    joints = chain(links, ratio, ends=2, backwards=backwards).solve()
    assert joints.number == links + 1 and joints.redundant == 0
    violation, unexplained = residuals(joints)
    assert violation < 1e-14 and unexplained < 1e-12


@pytest.mark.parametrize("bend", [1e-2, 1e-4, 1e-6])
def test_a_bridge_that_is_almost_straight(bend):
    """An almost straight bridge is solved, although it is nearly rigid along its length.

    Its impulses grow with the inverse square of the bend.
    """
    joints = chain(6, ends=2, bend=bend).solve()
    assert joints.redundant == 0
    impulses, after, places = exact_solution(joints)
    assert np.allclose(impulses_of(joints, places), impulses, rtol=1e-14 / bend**2, atol=0.0)
    assert np.allclose(velocities(joints), after, rtol=0.0, atol=1e-14 / bend**2 * np.abs(after).max())


def test_rotation_and_places_may_be_fixed():
    """Bodies with infinite mass or inertia are solved: a wheel on a fixed axle, a slider that
    cannot rotate, and a rod.
    """
    joints = Joints(3)
    joints.mass(1, 0.0, 0.5)
    joints.mass(2, 2.0, 0.0)
    joints.mass(3, 1.0, 0.1)
    joints.move(1, 0.0, 0.0, 3.0)
    joints.pin(1, 3, (4.0, 1.0), (-5.0, 0.0))
    joints.pin(3, 2, (5.0, 0.0), (0.0, 0.0))
    joints.add(2, WORLD, [((0.0, 1.0, 0.0), (0.0, -1.0, 0.0), 0.0, 0.0)])
    joints.solve()
    impulses, after, places = exact_solution(joints)
    assert joints.redundant == 0
    assert np.allclose(impulses_of(joints, places), impulses, rtol=1e-13)
    assert np.allclose(velocities(joints), after, rtol=1e-13, atol=1e-13)
    assert joints.after["vx"][1] == joints.after["vy"][1] == 0.0 == joints.after["angular_velocity"][2]


def test_joints_follow_a_kinematic_body():
    joints = Joints(2)
    joints.mass(1, 1.0, 0.1)
    joints.move(2, 3.0, -4.0, 0.5)
    joints.weld(2, 1, (10.0, 0.0), (0.0, 2.0))
    joints.solve()
    assert velocities(joints)[3:].tolist() == pytest.approx([3.0 + 2.0 * 0.5, -4.0 + 10.0 * 0.5, 0.5, 3.0, -4.0, 0.5])
    assert joints.after[2] == joints.motions[2], "its row is not written"


def test_free_velocities_change_by_as_much():
    joints = chain(5, 100.0)
    joints.motions["free_vx"] += 1.0
    joints.solve()
    for name, free in zip(VELOCITY, FREE, strict=True):
        change = joints.after[name] - joints.motions[name]
        assert np.abs(change[1:]).min() > 0.0
        assert np.allclose(joints.after[free] - joints.motions[free], change, rtol=1e-12, atol=1e-12)


def test_a_factor_serves_several_right_hand_sides():
    joints = chain(12, 1e3, ends=2).solve()
    first = velocities(joints)
    for name in VELOCITY:
        joints.after[name] = joints.motions[name]
    wanted = joints.joint_rows["rhs"].copy()
    joints.joint_rows["rhs"] = 0.0
    solve_trees(joints.forest, joints.joint_rows, joints.after)
    joints.joint_rows["rhs"] = wanted
    solve_trees(joints.forest, joints.joint_rows, joints.after)
    assert np.allclose(velocities(joints), first, rtol=1e-10, atol=1e-10)
    solve_trees(joints.forest, joints.joint_rows, joints.after)
    assert np.abs(joints.joint_rows["impulse"]).max() < 1e-8, "what is solved stays as it is"


def test_bodies_at_rest_stay_at_rest_and_no_number_is_denormal():
    joints = chain(30, 1e3, weld=True)
    joints.rows = [(*row[:6], 0.0, *row[7:]) for row in joints.rows]
    joints.solve()
    for _ in range(40):  # each time the velocities fall by the precision of numbers
        solve_trees(joints.forest, joints.joint_rows, joints.after)
    assert not velocities(joints).any() and not joints.joint_rows["impulse"].any()


# ---- redundant rows --------------------------------------------------------------------------------------------------


def straight_bridge(links, weld=False):
    joints = Joints(links)
    for body in range(1, links + 1):
        joints.mass(body, 1.0, 0.03)
        joints.move(body, 1.0, 2.0, -0.1)
    for k in range(links + 1):
        join = joints.weld if weld else joints.pin
        join(k, (k + 1) % (links + 1), (10.0, 0.0), (-10.0, 0.0))
    return joints


def two_pins():
    joints = Joints(1)
    joints.mass(1, 1.0, 0.03)
    joints.move(1, 1.0, 2.0, 0.5)
    joints.pin(WORLD, 1, (0.0, 0.0), (-7.0, 3.0))
    joints.pin(WORLD, 1, (0.0, 0.0), (8.0, 1.0))
    return joints


def weld_without_rotation():
    joints = Joints(2)
    joints.mass(1, 1.0, 0.0)
    joints.mass(2, 0.5, 0.0)
    joints.move(1, 1.0, 0.0, 0.0)
    joints.weld(1, 2, (5.0, 0.0), (-5.0, 1.0))
    return joints


REDUNDANT = {
    "a bridge that is straight": (lambda: straight_bridge(9), 1),
    "a body with two pins": (two_pins, 1),
    "a beam that is built in at both ends": (lambda: straight_bridge(9, weld=True), 3),
    "a weld of bodies that do not rotate": (weld_without_rotation, 1),
}


@pytest.mark.parametrize("name", REDUNDANT)
def test_redundant_rows_are_counted_and_hold_with_the_others(name):
    make, count = REDUNDANT[name]
    joints = make().solve()
    assert joints.number == len(joints.ids) and joints.redundant == count
    violation, unexplained = residuals(joints)
    assert violation < 1e-12 and unexplained < 1e-12
    assert np.abs(joints.impulses).max() < 2e3, "as if one end alone held the bodies"


@pytest.mark.parametrize("name", REDUNDANT)
@pytest.mark.parametrize("wanted", [1.0, -1e3])
def test_rows_that_contradict_one_another_have_finite_impulses(name, wanted):
    make, count = REDUNDANT[name]
    joints = make()
    last = MOST_ROWS * (len(joints.ids) - 1)
    for r in range(joints.counts[-1]):
        joints.rows[last + r] = (*joints.rows[last + r][:6], wanted, *joints.rows[last + r][7:])
    joints.solve()
    assert joints.redundant == count
    assert np.abs(velocities(joints)).max() < 1e3 * abs(wanted) and np.abs(joints.impulses).max() < 1e6 * abs(wanted)


# ---- structure -------------------------------------------------------------------------------------------------------


def test_joints_that_close_a_loop_are_not_taken():
    joints = Joints(5)
    for body in (1, 2, 3, 4):
        joints.mass(body, 1.0, 0.1)
        joints.move(body, 1.0 * body, 0.0, 0.0)
    pairs = {
        7: (1, 2),
        3: (2, 3),
        9: (3, 1),
        4: (3, 2),
        5: (3, 4),
        6: (4, WORLD),
        8: (WORLD, 1),
        2: (5, WORLD),
        1: (4, 4),
    }
    for identity, (a, b) in pairs.items():
        joints.add(a, b, pin_rows((1.0, 1.0 * identity), (3.0, -1.0), (0.1, 0.2), 0.0), identity)
    joints.solve()
    taken = {identity for identity, each in zip(joints.ids, joints.taken, strict=True) if each}
    assert taken == {7, 3, 5, 6, 8}, "9 closes a loop, 4 is the second of its pair, 2 and 1 link nothing"
    assert joints.number == 5 and joints.redundant == 0
    violation, unexplained = residuals(joints)
    assert violation < 1e-14 and unexplained < 1e-13


def test_no_joints_and_joints_without_rows():
    assert Joints(3).solve().number == 0
    joints = chain(4)
    joints.counts[2] = 0
    joints.solve()
    assert joints.number == 4
    violation, unexplained = residuals(joints)
    assert violation < 1e-14 and unexplained < 1e-13
    joints.counts = [0] * 4
    joints.solve()
    assert all((joints.after[name] == joints.motions[name]).all() for name in VELOCITY)


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_the_joints_and_the_room_change_no_bit(seed):
    joints = random_forest(seed, decades=3.0, soft=0.1)
    bits = joints.solve().bits()
    rng = np.random.default_rng(seed)
    for _ in range(3):
        other = joints.shuffled(rng.permutation(len(joints.ids)))
        assert other.solve(new_forest(200, 300)).bits() == bits


def test_a_tree_does_not_depend_on_other_trees():
    alone = chain(7, 50.0).solve()
    joints = Joints(14)
    for body in range(1, 8):
        for row in (body, body + 7):
            joints.motions[row] = alone.motions[body]
    for j in range(7):
        rows = alone.rows[MOST_ROWS * j : MOST_ROWS * (j + 1)]
        for more in (7, 0):
            a, b = (row + more if row else WORLD for row in (alone.a[j], alone.b[j]))
            joints.add(a, b, [(row[:3], row[3:6], row[6], row[7]) for row in rows[:2]])
    joints.solve()
    for name in VELOCITY:
        assert joints.after[name][1:8].tobytes() == joints.after[name][8:].tobytes() == alone.after[name][1:].tobytes()


def test_a_forest_is_kept_while_it_has_room():
    forest = new_forest(4, 10)
    assert with_room(forest, 4, 10) is forest
    for joints, motions in ((5, 10), (4, 11), (50, 60)):
        grown = with_room(forest, joints, motions)
        assert len(grown.nexts) >= 2 * joints and len(grown.parents) >= motions
        assert grown.nexts.dtype == forest.nexts.dtype and grown.bodies.dtype == forest.bodies.dtype


@pytest.mark.parametrize("power", [-20, 7])
def test_lengths_scaled_by_a_power_of_two_give_the_same_bits(power):
    scale = 2.0**power
    joints = chain(9, 1e3, ends=2)
    other = joints.shuffled(range(len(joints.ids)))
    for name in ("vx", "vy", "free_vx", "free_vy"):
        other.motions[name] *= scale
    other.motions["inverse_inertia"] /= scale * scale
    lengths = (1.0, 1.0, scale, 1.0, 1.0, scale, scale, 1.0, 1.0, 1.0)
    other.rows = [tuple(np.multiply(row, lengths).tolist()) for row in joints.rows]
    joints.solve()
    other.solve()
    assert (other.impulses == scale * joints.impulses).all()
    assert (other.after["vx"] == scale * joints.after["vx"]).all()
    assert (other.after["angular_velocity"] == joints.after["angular_velocity"]).all()


# ---- both forms ------------------------------------------------------------------------------------------------------


@pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
def test_compiled_and_plain_give_the_same_bits():
    from tests.both_forms import compared

    with compared() as seen:
        for seed in range(4):
            random_forest(seed, decades=6.0, soft=0.1 * (seed % 2)).solve()
        for weld in (False, True):
            chain(20, 1e6, weld, ends=2, bend=1e-3).solve()
        for make, _ in REDUNDANT.values():
            make().solve()
    assert len(seen.kernels) == 3


@pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300, -1.0, 1e-310])
def test_both_forms_are_the_same_where_numbers_are_wrong(value):
    from tests.both_forms import compared

    rng = np.random.default_rng(1)
    with compared():
        for seed in range(6):
            joints = random_forest(seed, soft=0.1 * (seed % 2))
            for _ in range(3):
                row = int(rng.integers(len(joints.rows)))
                place = int(rng.integers(8))
                joints.rows[row] = (*joints.rows[row][:place], value, *joints.rows[row][place + 1 :])
            name = ("inverse_mass", "inverse_inertia", "vx", "angular_velocity")[seed % 4]
            joints.motions[name][int(rng.integers(1, len(joints.motions)))] = value
            joints.solve()
