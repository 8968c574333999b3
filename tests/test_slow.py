"""The stored lists of slow tests: additions, removals, names that are no test, and the measurements of the plugin."""

import json
import subprocess
import sys
from importlib.util import find_spec

import pytest

from tests import slow
from tests.slow import NEVER, SLOW, STAYS, refreshed, stale

NAMES = {"tests/a.py::test_one[1]": 0.6, "tests/a.py::test_two": 2.0, "tests/b.py::test_three": 1.0}


LISTS = {each.name: each for each in (slow.KEPT, slow.KEPT_WITHOUT_NUMBA)}


@pytest.mark.parametrize("name", LISTS)
def test_a_list_is_in_order_and_holds_each_once(name):
    path = LISTS[name]
    lines = path.read_text(encoding="utf-8").splitlines()
    names = [line.split(maxsplit=1)[1] for line in lines]
    assert names == sorted(set(names)) and len(names) == len(slow.listed(path)) > 100
    assert all(seconds >= STAYS * SLOW - 0.05 for seconds in slow.listed(path).values())


def test_every_name_on_the_list_is_a_test(pytestconfig):
    """Every name on the list for this environment is a test; elsewhere some tests have fewer cases."""
    parts = {argument.split("::")[0] for argument in pytestconfig.args if "::" in argument}
    wrong = stale(pytestconfig.stash[slow.COLLECTED], slow.listed(slow.own_list()), parts)
    assert not wrong, "python -m tests.slow --refresh writes the list anew"


@pytest.mark.parametrize("seconds, before, listed", [
    (SLOW, False, True), (0.99 * SLOW, False, False), (0.99 * SLOW, True, True), (STAYS * SLOW, True, True),
    (0.99 * STAYS * SLOW, True, False), (100.0, False, True), (0.0, True, False),
])  # fmt: skip
def test_what_lies_at_the_border_does_not_come_and_go(seconds, before, listed):
    kept = {"tests/a.py::test": 1.0} if before else {}
    assert refreshed(kept, {"tests/a.py::test": seconds}) == ({"tests/a.py::test": seconds} if listed else {})


@pytest.mark.parametrize("name", NEVER)
def test_some_are_never_listed(name):
    assert refreshed({}, {f"{name}test_that_takes_long": 100.0}) == {}
    assert not [each for path in LISTS.values() for each in slow.listed(path) if each.startswith(name)]


def test_a_refresh_of_some_files_leaves_the_lines_of_others():
    measured = {"tests/a.py::test_two": 3.0, "tests/a.py::test_new": 0.7, "tests/a.py::test_fast": 0.1}
    assert refreshed(NAMES, {"tests/a.py::test_new": 0.7}, more=True) == NAMES | {"tests/a.py::test_new": 0.7}
    found = refreshed(NAMES, measured)
    assert found == {"tests/a.py::test_new": 0.7, "tests/a.py::test_two": 3.0, "tests/b.py::test_three": 1.0}
    assert list(found) == sorted(found), "a test that is gone is dropped"


@pytest.mark.parametrize("collected, parts, wrong", [
    (["tests/a.py::test_one[1]", "tests/a.py::test_two", "tests/b.py::test_three"], set(), []),
    (["tests/a.py::test_one[1]", "tests/b.py::test_three"], set(), ["tests/a.py::test_two"]),
    (["tests/a.py::test_one[2]", "tests/a.py::test_two"], set(), ["tests/a.py::test_one[1]"]),
    (["tests/a.py::test_two"], {"tests/a.py"}, []),
    ([], set(), []),
])  # fmt: skip
def test_a_name_that_is_no_test_is_found_where_its_file_was_collected(collected, parts, wrong, tmp_path, monkeypatch):
    monkeypatch.setattr(slow, "ROOT", tmp_path)
    (tmp_path / "tests").mkdir()
    for name in ("a", "b"):
        (tmp_path / f"tests/{name}.py").touch()
    assert stale(collected, NAMES, parts) == wrong
    (tmp_path / "tests/b.py").unlink()
    gone = ["tests/b.py::test_three"] if "tests/b.py::test_three" not in collected else []
    assert stale(collected, NAMES, parts) == wrong + gone, "and where its file is gone"


TESTS = """
import subprocess, sys, time
import pytest

def work(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass

@pytest.fixture(scope="module")
def dear():
    work(0.3)

def test_own():
    work(0.3)

def test_first(dear):
    pass

def test_second(dear):
    pass

def test_waits():
    time.sleep(0.3)

def test_child():
    subprocess.run([sys.executable, "-c", "import time\\nwhile time.process_time() < 0.4: pass"], check=True)

def test_kernels(request):
    numba = pytest.importorskip("numba")
    started = time.process_time()
    assert numba.njit(lambda x: x * x + 1.0)(2.0) == 5.0
    request.path.with_suffix(".spent").write_text(str(time.process_time() - started))
"""


def test_the_plugin_measures_fixtures_and_processes_and_leaves_out_kernels(tmp_path):
    path, kept = tmp_path / "test_some.py", tmp_path / "seconds.json"
    path.write_text(TESTS)
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    options = ["-c", str(tmp_path / "pytest.ini"), "-p", "no:cacheprovider", "-p", "tests.slow", f"--seconds={kept}"]
    command = [sys.executable, "-m", "pytest", *options, str(path)]
    run = subprocess.run(command, cwd=slow.ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    found = {name.split("::")[1]: seconds for name, seconds in json.loads(kept.read_text()).items()}
    assert found["test_own"] >= 0.3 and found["test_first"] >= 0.3 and found["test_child"] >= 0.38
    assert found["test_second"] >= 0.3, "it would have paid for the fixture, had it been alone"
    assert found["test_waits"] < 0.25
    if find_spec("numba"):
        assert found["test_kernels"] < 0.5 * float(path.with_suffix(".spent").read_text()), "compiling is not counted"
