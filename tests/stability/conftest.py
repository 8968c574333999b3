"""Fixtures and hooks that check each measured figure against its row's limit and store it in docs/stability.json."""

import json
from pathlib import Path

import pytest

from physics import JIT
from tests.stability.page import kept_figures
from tests.stability.rows import ROWS
from tests.stability.settings import DEFAULTS, FOUR, SETTINGS, SWEEP, sweeps, using, variants

KEPT = "stability"


def pytest_addoption(parser):
    """Add the option `--stability-json FILE`: the file to which measurements are written.

    pytest knows the option only if the folder is named on the command line: pytest tests/stability --stability-json
    FILE.
    """
    parser.addoption("--stability-json", metavar="FILE", help="write what the rows of the stability suite measure")


def pytest_generate_tests(metafunc):
    """Parametrize each test of a row by settings and by the number of its sweep.

    A test whose worlds follow the present settings runs with 4 substeps and with the defaults; others run with 4
    substeps. A test with a phase or a seed runs SWEEP times.
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
    """Apply the parametrized settings and sweep number during a test; the fixture's value is
    the name of the settings.
    """
    with using(*request.param):
        yield request.param[0]


@pytest.fixture
def measured(request, world_settings):
    """Return a function measured(row, figure, value), which asserts that the value meets the row's limit, records it
    and returns it.

    If `--stability-json` is not given, the value must also be within twice the figure stored in docs/stability.json.
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
    """Register the `Keeper` in the main process, which receives the reports of all worker processes."""
    path = config.getoption("--stability-json")
    if path and not hasattr(config, "workerinput"):
        if not JIT:
            raise pytest.UsageError("--stability-json: without a compiler the rows are measured with smaller counts")
        config.pluginmanager.register(Keeper(Path(path)))


class Keeper:
    """Plugin that writes the worst value of every measured figure to a JSON file; other figures in the file stay
    unchanged.
    """

    def __init__(self, path):
        self.path, self.worst = path, {}

    def pytest_runtest_logreport(self, report):
        """Add the figures that a test recorded in its report, in whichever process it ran.

        xdist turns the tuples of a worker's report into lists.
        """
        if report.when != "call":
            return
        for name, found in report.user_properties:
            if name == KEPT:
                row, figure, value, settings = found
                figures = self.worst.setdefault((settings, row), {})
                figures[figure] = ROWS[row].limit(figure).worse(value, figures.get(figure, value))

    def pytest_sessionfinish(self):
        """Write the figures to the JSON file: rows in the order of the table, numbers with four significant digits."""
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
