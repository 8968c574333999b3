"""The fixture that holds what a test measures to its row's limit, and keeps it for docs/stability.json."""

import json
from pathlib import Path

import pytest

from physics import JIT
from tests.stability.page import kept_figures
from tests.stability.rows import ROWS
from tests.stability.settings import DEFAULTS, FOUR, SETTINGS, SWEEP, sweeps, using, variants

KEPT = "stability"


def pytest_addoption(parser):
    """Add the option for the file of measurements; given with the folder: pytest tests/stability --stability-json
    FILE.
    """
    parser.addoption("--stability-json", metavar="FILE", help="write what the rows of the stability suite measure")


def pytest_generate_tests(metafunc):
    """Run each test of a row under 4 substeps and under the default settings, where its worlds follow them, and over
    its phases or seeds.
    """
    if "measured" not in metafunc.fixturenames:
        return
    both = variants(metafunc.function, metafunc.module, set(metafunc.fixturenames))
    swept = sweeps(metafunc.function, metafunc.module)
    cases = [(each, number) for each in (SETTINGS if both else (FOUR,)) for number in range(SWEEP if swept else 1)]
    metafunc.fixturenames.append("world_settings")
    metafunc.parametrize(
        "world_settings",
        [pytest.param(each, id=_name(both, *each), marks=[pytest.mark.nightly] if each[1] else ()) for each in cases],
        indirect=True,
    )


def _name(both, settings, number):
    names = [settings.replace(" ", "_")] if both else []
    names += [f"phase_{number}"] if number else []
    return "-".join(names) or pytest.HIDDEN_PARAM


@pytest.fixture
def world_settings(request):
    """Make the worlds of a test with some settings, and the phases of one number of a sweep."""
    with using(*request.param):
        yield request.param[0]


@pytest.fixture
def measured(request, world_settings):
    """measured(row, figure, value): record the value, assert that it is within the row's limit, and return it.

    Where nothing is written to docs/stability.json it is also within twice the value on record there.
    """
    on_record = {} if request.config.getoption("--stability-json") or not JIT else kept_figures()

    def hold(row, figure, value):
        assert request.node.originalname.startswith(f"test_{row.lower()}_"), f"{row} is measured by the test of another"
        limit, value = ROWS[row].limit(figure, world_settings == DEFAULTS), float(value)
        recorded = on_record.get(world_settings, {}).get(row, {}).get(figure)
        limit = limit if recorded is None else limit.near(recorded)
        request.node.user_properties.append((KEPT, (row, figure, value, world_settings)))
        assert limit.met(value), (
            f"{row}, {figure}, {world_settings}: {value:.6g} is not {limit.sense} {limit.value:g} {limit.unit}".rstrip()
        )
        return value

    return hold


def pytest_configure(config):
    """Collect in the one process that receives the reports of every test."""
    path = config.getoption("--stability-json")
    if path and not hasattr(config, "workerinput"):
        if not JIT:
            raise pytest.UsageError("--stability-json: without a compiler the rows are measured with smaller counts")
        config.pluginmanager.register(Keeper(Path(path)))


class Keeper:
    """Writes the worst value of every figure that was measured; what was not measured now stays as it was."""

    def __init__(self, path):
        self.path, self.worst = path, {}

    def pytest_runtest_logreport(self, report):
        """Take what a test has recorded, wherever it ran; reports of workers come as lists."""
        if report.when != "call":
            return
        for name, found in report.user_properties:
            if name == KEPT:
                row, figure, value, settings = found
                figures = self.worst.setdefault((settings, row), {})
                figures[figure] = ROWS[row].limit(figure).worse(value, figures.get(figure, value))

    def pytest_sessionfinish(self):
        """Write them, rows in the order of the table, four digits each."""
        kept = json.loads(self.path.read_text()) if self.path.exists() else {}
        for (settings, row), figures in self.worst.items():
            of = kept.setdefault(settings, {})
            of[row] = of.get(row, {}) | {name: float(f"{value:.4g}") for name, value in figures.items()}
        rows = {
            settings: {
                row.id: {each.figure: of[row.id][each.figure] for each in row.limits if each.figure in of[row.id]}
                for row in ROWS.values()
                if row.id in of
            }
            for settings, of in ((each, kept.get(each, {})) for each in SETTINGS)
        }
        self.path.write_text(json.dumps(rows, indent=1) + "\n")
