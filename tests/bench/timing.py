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


def best_in_turns(rounds, timed):
    """Return {name: least seconds of a call} of several functions, all called in every round, so that load affects them
    alike.

    timed: {name: function that does the work once and returns its seconds}.
    """
    least = dict.fromkeys(timed, float("inf"))
    for _ in range(rounds):
        for name, measure in timed.items():
            least[name] = min(least[name], measure())
    return least


def table(title, header, rows):
    """Print aligned columns; rows are as long as the header."""
    lines = [[str(each) for each in row] for row in [header, *rows]]
    widths = [max(len(cell) for cell in column) for column in zip(*lines, strict=True)]
    print(f"\n{title}")
    for first, *others in lines:
        cells = [first.ljust(widths[0])] + [cell.rjust(w) for cell, w in zip(others, widths[1:], strict=True)]
        print("  ".join(cells).rstrip(), flush=True)
