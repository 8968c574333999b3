"""Command `python -m tests.fuzz --minutes N [--seed S] [--workers N] [--effect E]`: run random programs."""

import argparse
import multiprocessing
import os
import time

from tests.fuzz.running import script_of, write_program
from tests.fuzz.shrinking import shrink


def worker(first, apart, until, effect, found):
    """Run the programs of the seeds first, first + apart, ... until the time `until`; put failures into the queue
    `found`. effect: see write_program.
    """
    kinds, done = set(), 0
    for seed in range(first, first + 10**9, apart):
        if time.time() > until:
            break
        lines, failure, strategy = write_program(seed, effect=effect)
        done += 1
        if failure is not None and failure.kind not in kinds:
            kinds.add(failure.kind)
            short = shrink(lines, failure, strategy)
            found.put((seed, failure.kind, failure.story, script_of(short, strategy)))
    found.put(done)


def main():
    """Run the processes and print the shortened failing programs. Return the number of kinds of failures found."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=0, help="of the first program; the others follow")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--effect", help="only programs whose world has this effect, such as joints")
    options = parser.parse_args()
    found, until = multiprocessing.Queue(), time.time() + 60.0 * options.minutes
    processes = [
        multiprocessing.Process(target=worker, args=(options.seed + k, options.workers, until, options.effect, found))
        for k in range(options.workers)
    ]
    for process in processes:
        process.start()
    kinds, programs, ended = set(), 0, 0
    while ended < len(processes):
        told = found.get()
        if isinstance(told, int):
            programs, ended = programs + told, ended + 1
        elif told[1] not in kinds:
            seed, kind, story, script = told
            kinds.add(kind)
            print(f"== seed {seed}: {kind}\n\n{script}\n\n{story}", flush=True)
    print(f"{programs} programs, {len(kinds)} kinds of failures")
    return len(kinds)


if __name__ == "__main__":
    raise SystemExit(min(main(), 1))
