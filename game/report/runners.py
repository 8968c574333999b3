"""Three ways to run the jobs of a report, with the same results.

The jobs run in this process, in worker processes, or on a Dask cluster. A job whose process dies is run once more. If
it dies again, it is reported as failed.
"""

import json
import queue
import threading
from collections.abc import Iterator, Sequence
from typing import Any

from game import startup
from game.errors import UsageError
from game.report.job import Job, Row, run_job
from physics.jit.workers import end_all, start_module

TRIES = 2
PATIENCE = "10s"  # wait for a scheduler
DIED = "the process that did it ended, twice"


def run_here(jobs: Sequence[Job]) -> Iterator[Row]:
    """Run the jobs one after another in this process, and yield their results."""
    for job in jobs:
        yield run_job(*job[:3])


def run_in_processes(jobs: Sequence[Job], workers: int) -> Iterator[Row]:
    """Run the jobs in `workers` processes, and yield each result when its job finishes.

    The processes share the machine's cores and caches, which affects the measured times.
    """
    waiting: queue.SimpleQueue[tuple[Job, int]] = queue.SimpleQueue()
    found: queue.SimpleQueue[Row | Exception] = queue.SimpleQueue()
    for job in jobs:
        waiting.put((job, 1))
    running = []
    stopped = threading.Event()
    threads = [
        threading.Thread(target=_serve, args=(waiting, found, running, stopped), daemon=True)
        for _ in range(min(workers, len(jobs)))
    ]
    try:
        for thread in threads:
            thread.start()
        for _ in jobs:
            result = found.get()
            if isinstance(result, Exception):
                raise result
            yield result
    finally:
        stopped.set()
        end_all(running)
        for thread in threads:
            thread.join()


def _serve(waiting, found, running, stopped):
    """Run jobs from the queue `waiting` in a worker process, and put their results into the queue `found`.

    A worker process that dies is replaced. running: list to which each started process is added; stopped: event that
    ends the loop.
    """
    process: Any = None
    while not stopped.is_set():
        try:
            job, attempt = waiting.get_nowait()
        except queue.Empty:
            break
        line = ""
        try:
            if process is None:
                process = start_module(f"{__package__}.worker")
                running.append(process)
                if stopped.is_set():
                    end_all([process])
            process.stdin.write(json.dumps(job._asdict()) + "\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except (OSError, ValueError) as error:
            if process is None:
                found.put(error)
                return
        if line:
            found.put(json.loads(line))
            continue
        process = None  # it has ended, for whatever reason
        if attempt < TRIES:
            waiting.put((job, attempt + 1))
        else:
            found.put({"name": job.name, "failed": DIED, "spent": 0.0})


def connect(address: str) -> Any:
    """Return a client of the Dask cluster at `address`.

    Raises UsageError if Dask is missing, the address is invalid, or no scheduler answers.
    """
    try:
        from dask.distributed import Client  # pyright: ignore[reportMissingImports]
        from distributed.comm.addressing import get_address_host_port  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise UsageError(f"--dask needs Dask; it comes with: {startup.install('cluster')}") from error
    try:
        get_address_host_port(address)  # checked first: a client with an invalid address blocks when it is deleted
    except ValueError as error:
        raise UsageError(f"--dask: {address} is no address such as tcp://host:8786: {error}") from error
    try:
        return Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise UsageError(f"--dask: no scheduler answers at {address}: {error}") from error


def run_on_dask(jobs: Sequence[Job], client: Any) -> Iterator[Row]:
    """Run the jobs on a Dask cluster, and yield each result when its job finishes. Close the client at the end.

    This program must be installed on the cluster's workers.
    """
    from dask.distributed import as_completed  # pyright: ignore[reportMissingImports]

    with client:
        futures = {client.submit(run_job, *job[:3], pure=False, retries=TRIES - 1): job for job in jobs}
        for future in as_completed(list(futures), loop=client.loop):
            job = futures[future]
            error = future.exception()
            yield {"name": job.name, "failed": f"{DIED} ({error})", "spent": 0.0} if error else future.result()
