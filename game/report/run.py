"""`--report DIR`: run the jobs that have no result yet, store the result of each, and write the page.

An interrupted report resumes where it stopped. Only the job that was running is repeated.
"""

import json
import sys
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from time import perf_counter

from game import startup
from game.errors import UsageError, brief
from game.files.data_folder import write_atomically
from game.registry import Registry
from game.report.charts import CHARTS
from game.report.job import Job, ReportScope
from game.report.page import Measured, as_csv, write_page
from game.report.plots import library
from game.report.runners import connect, run_here, run_in_processes, run_on_dask
from game.report.store import DATA, Store
from game.run.headless import start_dummy_display
from game.run.options import Options
from game.run.warmup import StderrProgress
from physics import SOLVERS, Effects
from physics.background import compile_jobs


def run_report(options: Options, registry: Registry) -> int:
    """Make the report's measurements (jobs), and write its HTML page.

    Return the exit code: 1 if a job failed, otherwise 0. Raises UsageError if the report cannot start.
    """
    assert options.report is not None
    library()  # matplotlib is required before anything is measured
    start_dummy_display()
    jobs = all_jobs(ReportScope(options.quick, registry.listing))
    chosen = chosen_jobs(jobs, options.only)
    client = connect(options.dask) if options.dask is not None else None  # before a folder is created in vain
    store = Store(Path(options.report), options.quick)
    done = {job.name for job in jobs if _is_done(store, job)}
    due = [job for job in chosen if options.only is not None or job.name not in done]
    if client is not None:
        results = run_on_dask(due, client)
    elif options.workers is not None and options.workers > 1:
        results = run_in_processes(due, options.workers)
    else:
        results = run_here(due)
    if due and client is None:
        compile_kernels()
    progress = Progress(due)
    failed = 0
    try:
        for found in results:
            store.keep(found)
            failed += "failed" in found
            progress(found)
    except KeyboardInterrupt:
        startup.say(f"what is measured is kept in {brief(options.report, 200)}; the same command goes on")
        raise
    finally:
        write(store, jobs, options)
    print(f"{Path(options.report) / 'index.html'}: {len(jobs)} jobs, {failed} failed")
    return 1 if failed else 0


def compile_kernels() -> None:
    """Compile the kernels that most jobs need, on all cores, before the first job.

    Other kernels are compiled at their first call.
    """
    worlds = [(effects, solver) for effects in (Effects.rigid_bodies(), Effects.detection()) for solver in SOLVERS]
    kernels = [
        {"effects": effects.names(), "broadphase": "all", "solver": solver, "pieces": None}
        for effects, solver in worlds
        if effects.stacking or solver in ("blocking", "projection")
    ]
    progress = StderrProgress()
    compile_jobs(kernels, progress)
    progress.end()


def all_jobs(scope: ReportScope) -> list[Job]:
    """Return the jobs of all charts, in the order of the charts. scope: extent of the report."""
    return [job for chart in CHARTS for job in chart.jobs(scope)]


def chosen_jobs(jobs: Sequence[Job], only: str | None) -> list[Job]:
    """Return the jobs that `only` selects: a pattern for names of jobs, or the name of a chart. None selects all jobs.

    Raises UsageError if no job is selected.
    """
    if only is None:
        return list(jobs)
    found = [job for job in jobs if fnmatchcase(job.name, only) or job.name.startswith(f"{only}/")]
    if not found:
        names = ", ".join(dict.fromkeys(job.name.split("/")[0] for job in jobs))
        raise UsageError(
            f"--only: no job is named {brief(only, 60)}; charts: {names}; a job is chart/name, * stands for anything"
        )
    return found


def _is_done(store, job):
    found = store.result(job.name)
    return found is not None and "failed" not in found


def gather(store: Store, jobs: Sequence[Job]) -> list[Measured]:
    """Return the stored results of the jobs, grouped by chart, as one Measured per chart."""
    found = []
    for chart in CHARTS:
        rows, failed, left = [], {}, 0
        for job in jobs:
            if not job.name.startswith(f"{chart.of or chart.key}/"):
                continue
            result = store.result(job.name)
            if result is None:
                left += 1
            elif "failed" in result:
                failed[job.name] = result["failed"]
            else:
                rows += [{**row, "job": job.name} for row in result["rows"]]
        found.append(Measured(chart, rows, {} if chart.of else failed, 0 if chart.of else left))  # reported once
    return found


def write(store: Store, jobs: Sequence[Job], options: Options) -> None:
    """Write the report's HTML page and, in the same folder, the rows of each chart as JSON and CSV. Raises OSError."""
    measured = gather(store, jobs)
    spent = sum(found["spent"] for job in jobs if (found := store.result(job.name)) is not None)
    page = write_page(measured, store.manifest, str(options.report), spent)
    write_atomically(store.folder / "index.html", page)
    for each in measured:
        write_atomically(store.folder / DATA / f"{each.chart.key}.json", json.dumps(each.rows, indent=1))
        write_atomically(store.folder / DATA / f"{each.chart.key}.csv", as_csv(each.rows))


class Progress:
    """Progress on standard error: a line after each job, with the number of finished jobs and the remaining time."""

    def __init__(self, jobs: Sequence[Job]) -> None:
        self.weights = {job.name: job.seconds for job in jobs}
        self.total, self.done, self.count = sum(self.weights.values()), 0.0, 0
        self.started = perf_counter()

    def __call__(self, found: dict) -> None:
        self.count += 1
        self.done += self.weights[found["name"]]
        left = (perf_counter() - self.started) * (self.total - self.done) / self.done
        word = f"failed: {brief(found['failed'])}" if "failed" in found else f"{found['spent']:.1f} s"
        print(
            f"{self.count} of {len(self.weights)} jobs, about {left:.0f} s more; {found['name']} {word}",
            file=sys.stderr, flush=True,
        )  # fmt: skip
