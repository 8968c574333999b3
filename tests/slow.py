"""The slow tests: the stored lists, the plugin that measures, and the command that rewrites the list.

    python -m tests.slow --refresh                      # all tests but the nightly ones, in two processes
    python -m tests.slow --refresh tests/physics        # the tests of some files; the lines of others stay
    python -m tests.slow --more                         # only those that are not on the list yet
    python -m pytest -p tests.slow --seconds=FILE       # any run; FILE gets the seconds of each test

A test is slow if it takes a quarter of a second of processor time, including its child processes; from 0.8 seconds on
it is nightly. The time in which numba compiles or loads kernels is left out, because the first test that needs a kernel
would pay for all. A shared fixture counts for each test that uses it. Other load on the machine lengthens processor
time by about a third where caches are shared, and clock time by more.

In an environment without numba, more tests are slow. They are in a second list, which is read in addition to the first
one and written only in such an environment.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
KEPT, KEPT_WITHOUT_NUMBA = ROOT / "tests/slow_tests.txt", ROOT / "tests/slow_without_numba.txt"
SLOW = 0.25  # [s] processor time from which a test is listed
STAYS = 0.7  # of that: a listed test stays listed from here on, so that tests at the border do not come and go
NIGHT = 0.8  # [s] a listed test from which on is run by .ci/nightly alone
COLLECTED = pytest.StashKey[list[str]]()  # node ids of all tests of a run, before any is deselected
# Tests that the README's command runs however long they take: every scene once, and what the sources must keep to.
NEVER = (
    "tests/scenes/test_scenes.py::test_one_digest_however_it_is_run_for_half_a_second[",
    "tests/test_architecture.py::",
    "tests/test_docs.py::",
    "tests/test_kernel_dialect.py::",
    "tests/test_lockstep.py::",
    "tests/test_words.py::",
)
# Tests that .ci/run runs however long they take: of the kernels on disk, of what is installed, of the games as a whole.
DAILY = (
    "tests/fuzz/",
    "tests/game/test_near_misses.py::test_three_keys_lead_a_stranger_from_the_title_to_the_false_hits_of_boxes",
    "tests/physics/test_background.py::",
    "tests/physics/test_kernel_cache.py::",
    "tests/physics/test_kernel_store.py::",
    "tests/scenes/test_effects_called_for.py::test_all_that_is_neutral_changes_nothing_together[",
    "tests/scenes/test_scenes.py::test_compiled_and_plain_kernels_give_one_digest[",
    *(
        f"tests/scenes/test_scenes.py::test_one_digest_however_it_is_run_and_the_goals_are_reached[{name}]"
        for name in ("shooter", "platformer", "lander")
    ),
    "tests/scenes/test_platformer_bot.py::test_the_bot_finds_the_secrets_and_the_goal",
    "tests/scenes/test_takeover.py::",
    "tests/test_packaging.py::",
    "tests/test_wheel_layout.py::",
)


def own_list() -> Path:
    """Return the path of the list for an environment like this one, with or without numba."""
    return KEPT if find_spec("numba") else KEPT_WITHOUT_NUMBA


def listed(path: Path = KEPT) -> dict[str, float]:
    """Return {node id: seconds} from a stored list."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return {name: float(seconds) for seconds, name in (line.split(maxsplit=1) for line in lines)}


def mark_of(name: str, seconds: float) -> str:
    """Return the marker of a listed test: slow or nightly."""
    return "nightly" if seconds >= NIGHT and not name.startswith(DAILY) else "slow"


def slow_here() -> dict[str, float]:
    """Return {node id: seconds} of the tests that are slow in an environment like this one."""
    return listed() | listed(own_list())


def write(path: Path, names: dict[str, float]) -> None:
    """Write a list: one line for each test, its seconds and its node id."""
    path.write_text("".join(f"{seconds:.1f} {name}\n" for name, seconds in names.items()), encoding="utf-8")


def refreshed(kept: dict[str, float], measured: dict[str, float], more: bool = False) -> dict[str, float]:
    """Return the list after a run that measured some files: their lines are replaced, those of other files stay.

    more: True if the measured tests were not on the list; then all its lines stay.
    """
    files = set() if more else {name.split("::")[0] for name in measured}
    stays = {name: seconds for name, seconds in kept.items() if name.split("::")[0] not in files}
    found = {name: seconds for name, seconds in measured.items() if seconds >= SLOW * (STAYS if name in kept else 1.0)}
    return {name: seconds for name, seconds in sorted((stays | found).items()) if not name.startswith(NEVER)}


def stale(collected: list[str], names: dict[str, float], parts: set[str]) -> list[str]:
    """Return the names on the list that belong to no test.

    The file of such a name is missing, or pytest collected the whole file without finding the name. parts: files of
    which only some tests were collected.
    """
    there = set(collected)
    whole = {name.split("::")[0] for name in collected} - parts
    return [
        name
        for name in names
        if name not in there and (name.split("::")[0] in whole or not (ROOT / name.split("::")[0]).is_file())
    ]


# --- the plugin ---------------------------------------------------------------------------------------------------


class Clock:
    """Processor seconds of this process and its ended children, without the compiling and loading of kernels."""

    def __init__(self) -> None:
        self.kernels, self.nesting = 0.0, 0
        if find_spec("numba"):
            self._watch_kernels()

    def __call__(self) -> float:
        """Return the seconds so far; the system counts the time of children in steps of 10 ms."""
        all_times = os.times()
        return time.process_time() - self.kernels + all_times.children_user + all_times.children_system

    def _watch_kernels(self):
        from numba.core.dispatcher import Dispatcher

        compile_or_load = Dispatcher.compile

        def watched(dispatcher, signature):
            started, self.nesting = time.process_time(), self.nesting + 1
            try:
                return compile_or_load(dispatcher, signature)
            finally:
                self.nesting -= 1
                if not self.nesting:  # what it calls is compiled within
                    self.kernels += time.process_time() - started

        Dispatcher.compile = watched


def pytest_addoption(parser):
    """Add the option --seconds FILE."""
    parser.addoption("--seconds", metavar="FILE", help="write the processor seconds of each test there")


def pytest_configure(config):
    """Register the meter in every process, and the `Keeper` in the main process, which receives all reports.

    In a measuring run, nightly tests of the list are marked slow only, so that `-m "not nightly"` measures them again.
    """
    config.pluginmanager.register(Meter(Clock()))
    path = config.getoption("--seconds")
    if path and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Keeper(Path(path)))


class Meter:
    """Plugin that measures the time of each test's phases; a shared fixture counts for every test that uses it."""

    def __init__(self, clock):
        self.clock, self.shared = clock, {}  # {key of a fixture: seconds}
        self.paid = set()  # keys of those that the present test has set up

    def _phase(self, item):
        started = self.clock()
        yield
        item.user_properties.append(("seconds", self.clock() - started))

    @pytest.hookimpl(hookwrapper=True, tryfirst=True)
    def pytest_runtest_setup(self, item):
        """Measure the setup of a test's own fixtures, and add the time of shared fixtures that earlier tests set up."""
        self.paid.clear()
        yield from self._phase(item)
        used = {key_of(each[-1]) for each in item._fixtureinfo.name2fixturedefs.values()}
        others = sum(seconds for key, seconds in self.shared.items() if key in used - self.paid)
        item.user_properties.append(("seconds", others))

    @pytest.hookimpl(hookwrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        """Store the setup time of a fixture with module, package or session scope."""
        started = self.clock()
        yield
        if fixturedef.scope not in ("function", "class"):
            key = key_of(fixturedef)
            self.shared[key] = max(self.shared.get(key, 0.0), self.clock() - started)
            self.paid.add(key)

    @pytest.hookimpl(hookwrapper=True, tryfirst=True)
    def pytest_runtest_call(self, item):
        """Measure the call of the test."""
        yield from self._phase(item)

    @pytest.hookimpl(hookwrapper=True, tryfirst=True)
    def pytest_runtest_teardown(self, item):
        """Measure the teardown of the fixtures."""
        yield from self._phase(item)


def key_of(fixturedef) -> tuple[str, str]:
    """Return (where a fixture is defined, its name)."""
    return fixturedef.baseid, fixturedef.argname


class Keeper:
    """Plugin that writes the seconds of all tests as JSON, by node id."""

    def __init__(self, path):
        self.path, self.seconds = path, {}

    def pytest_runtest_logreport(self, report):
        """Store the seconds of all phases, which a test's last report contains."""
        if report.when == "teardown":
            self.seconds[report.nodeid] = sum(value for name, value in report.user_properties if name == "seconds")

    def pytest_sessionfinish(self):
        """Write the JSON file."""
        self.path.write_text(json.dumps(self.seconds, indent=0) + "\n", encoding="utf-8")


def main(arguments: list[str]) -> int:
    """Measure and rewrite the list with --refresh or --more; otherwise print its size. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--refresh", action="store_true", help="measure, and write the list anew")
    parser.add_argument("--more", action="store_true", help="measure those that are not listed, and add what is slow")
    parser.add_argument("--keep", metavar="FILE", type=Path, help="keep the seconds of each test there, as JSON")
    parser.add_argument("paths", nargs="*", help="files or folders of tests; default: all")
    options = parser.parse_args(arguments)
    path = own_list()
    if options.refresh or options.more:
        with tempfile.TemporaryDirectory() as folder:
            found = options.keep or Path(folder) / "seconds.json"
            chosen = "not slow and not nightly" if options.more else "not nightly"
            command = [sys.executable, "-m", "pytest", "-p", "tests.slow", f"--seconds={found}", "-m", chosen]
            if not options.paths:
                command += ["-n", "2", "--dist", "worksteal"]
            done = subprocess.run([*command, "-p", "no:cacheprovider", *options.paths], cwd=ROOT)
            if done.returncode not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
                return done.returncode
            measured = json.loads(found.read_text(encoding="utf-8"))
            write(path, refreshed(listed(path), measured, options.more))
    names = slow_here()
    for mark in ("slow", "nightly"):
        spent = [seconds for name, seconds in names.items() if mark_of(name, seconds) == mark]
        sys.stdout.write(f"{len(spent)} tests are {mark}; they take {sum(spent) / 60:.1f} minutes\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
