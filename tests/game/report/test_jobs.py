"""Jobs of a report: they give the same facts however they are run, and every failure is reported."""

import pytest

from game.errors import UsageError
from game.report.job import Job, facts_of, run_job
from game.report.runners import connect, run_here, run_in_processes, run_on_dask

WORK = "tests.game.report.work"
JOBS = [Job(f"fall/{n}", f"{WORK}:fall", {"bodies": n}) for n in (1, 3, 5, 8)]


def by_name(results):
    return {found["name"]: found for found in results}


def facts(results):
    return {name: facts_of(found["rows"]) for name, found in by_name(results).items()}


def test_processes_find_the_same_facts_as_this_one():
    here = facts(run_here(JOBS))
    assert facts(run_in_processes(JOBS, 2)) == here and len(here) == len(JOBS)
    assert all("cost" not in row for rows in here.values() for row in rows)
    assert len({row["digest"] for rows in here.values() for row in rows}) == len(JOBS), "the facts tell the jobs apart"


def test_a_cluster_finds_the_same_facts_as_this_process():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, protocol="tcp", silence_logs=50
    ) as cluster:
        reported = facts(run_on_dask(JOBS, connect(cluster.scheduler_address)))
    assert reported == facts(run_here(JOBS))


def test_a_scheduler_that_does_not_answer_is_reported(monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr("game.report.runners.PATIENCE", "200ms")
    with pytest.raises(UsageError, match="--dask: no scheduler answers at tcp://127.0.0.1:9"):
        connect("tcp://127.0.0.1:9")


@pytest.mark.parametrize("address", ["nonsense", "tcp://host", "tcp://host:port", "ftp://host:1", ""])
def test_an_address_that_is_none_is_reported_at_once(address):
    pytest.importorskip("distributed")
    with pytest.raises(UsageError, match=rf"--dask: {address} is no address such as tcp://host:8786"):
        connect(address)


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "dask.distributed", None)
    with pytest.raises(UsageError, match=r"\.\[cluster\]"):
        connect("tcp://127.0.0.1:9")


def test_what_a_job_raises_is_its_result():
    found = run_job("x", f"{WORK}:fail", {})
    assert found["failed"] == "ValueError: nothing can be measured here" and "rows" not in found
    assert "ModuleNotFoundError" in run_job("x", "tests.nowhere:at_all", {})["failed"]


@pytest.mark.parametrize("times, comes_through", ((1, True), (2, False)))
def test_a_job_whose_process_dies_is_done_once_more_then_reported(times, comes_through, tmp_path):
    jobs = [Job("x/dies", f"{WORK}:die", {"path": str(tmp_path), "times": times}), *JOBS]
    found = by_name(run_in_processes(jobs, 2))
    assert len(found) == len(jobs), "the others are done"
    assert ("rows" in found["x/dies"]) == comes_through
    assert comes_through or "ended, twice" in found["x/dies"]["failed"]
    assert len(list(tmp_path.iterdir())) == times


def test_processes_end_with_whoever_stops_listening():
    results = run_in_processes(JOBS, 2)
    next(results)
    results.close()  # returns once they are gone
