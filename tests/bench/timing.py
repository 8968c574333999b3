"""Timing functions shared by the benchmarks: the best of several runs, and printed tables."""

from time import perf_counter


def best_of(runs, function):
    """Return the least seconds of several calls, the time of the machine without other load."""
    least = float("inf")
    for _ in range(runs):
        start = perf_counter()
        function()
        least = min(least, perf_counter() - start)
    return least


def best_in_turns(rounds, timed):
    """Return {name: least seconds of a call} of several functions.

    Every round calls all functions, so that other load affects them alike. timed: {name: function that does the work
    once and returns its seconds}.
    """
    least = dict.fromkeys(timed, float("inf"))
    for _ in range(rounds):
        for name, measure in timed.items():
            least[name] = min(least[name], measure())
    return least


def table(title, header, rows):
    """Print a title and aligned columns; every row has as many cells as the header."""
    lines = [[str(each) for each in row] for row in [header, *rows]]
    widths = [max(len(cell) for cell in column) for column in zip(*lines, strict=True)]
    print(f"\n{title}")
    for first, *others in lines:
        cells = [first.ljust(widths[0])] + [cell.rjust(w) for cell, w in zip(others, widths[1:], strict=True)]
        print("  ".join(cells).rstrip(), flush=True)
