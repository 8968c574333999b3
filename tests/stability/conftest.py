"""The fixture that holds what a test measures to its row's limit, and keeps it for docs/stability.json."""

import json
from pathlib import Path

import pytest

from tests.stability.rows import ROWS

KEPT = "stability"


def pytest_addoption(parser):
    """Add the option for the file of measurements; given with the folder: pytest tests/stability --stability-json
    FILE.
    """
    parser.addoption("--stability-json", metavar="FILE", help="write what the rows of the stability suite measure")


@pytest.fixture
def measured(request):
    """measured(row, figure, value): record the value, assert that it is within the row's limit, and return it."""

    def hold(row, figure, value):
        assert request.node.originalname.startswith(f"test_{row.lower()}_"), f"{row} is measured by the test of another"
        limit, value = ROWS[row].limit(figure), float(value)
        request.node.user_properties.append((KEPT, (row, figure, value)))
        assert limit.met(value), (
            f"{row}, {figure}: {value:.6g} is not {limit.sense} {limit.value:g} {limit.unit}".rstrip()
        )
        return value

    return hold


def pytest_configure(config):
    """Collect in the one process that receives the reports of every test."""
    path = config.getoption("--stability-json")
    if path and not hasattr(config, "workerinput"):
        from physics import JIT

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
                row, figure, value = found
                figures = self.worst.setdefault(row, {})
                figures[figure] = ROWS[row].limit(figure).worse(value, figures.get(figure, value))

    def pytest_sessionfinish(self):
        """Write them, rows in the order of the table, four digits each."""
        kept = json.loads(self.path.read_text()) if self.path.exists() else {}
        for row, figures in self.worst.items():
            kept[row] = kept.get(row, {}) | {name: float(f"{value:.4g}") for name, value in figures.items()}
        rows = {
            row.id: {each.figure: kept[row.id][each.figure] for each in row.limits if each.figure in kept[row.id]}
            for row in ROWS.values()
            if row.id in kept
        }
        self.path.write_text(json.dumps(rows, indent=1) + "\n")
