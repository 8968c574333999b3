"""Timing shared by the benchmarks: the best of several runs, and plain tables."""

from time import perf_counter


def best_of(runs, function):
    """Least seconds of several calls: what the machine can do when nothing else runs on it."""
    least = float("inf")
    for _ in range(runs):
        start = perf_counter()
        function()
        least = min(least, perf_counter() - start)
    return least


def table(title, header, rows):
    """Print aligned columns."""
    rows = [[str(each) for each in row] for row in rows]
    widths = [max(len(row[i]) for row in [list(header)] + rows) for i in range(len(header))]
    print(f"\n{title}")
    for row in [list(header)] + rows:
        print(
            "  ".join(
                cell.ljust(width) if i == 0 else cell.rjust(width) for i, (cell, width) in enumerate(zip(row, widths))
            )
        )
