"""Writes docs/PYTHON_SCALE.md: what a shape costs over Dask and over Ray, on one worker and on two.

    pip install './crates/python[examples]' && python crates/python/bench/scale.py

The first argument is how many shapes are asked about in each run, the second one how often. PAGE names another file.
"""

import os

os.environ["RAYON_NUM_THREADS"] = "1"  # before workers are started: each of them has one core

import importlib.metadata
import platform
import sys
import time
from pathlib import Path

import numpy as np

CRATE = Path(__file__).parent.parent
PAGE = Path(os.environ.get("PAGE") or CRATE.parent.parent / "docs" / "PYTHON_SCALE.md")
EXAMPLES = CRATE / "examples"
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(EXAMPLES), os.environ.get("PYTHONPATH")]))
sys.path.insert(0, str(EXAMPLES))

import ray
from dask.distributed import Client
from dask_blocks import distances, shapes, sphere
from ray_blocks import block_of_distances

import parry_continuum
from parry_continuum import Mesh

BLOCK = 10_000
SHAPES = 10**8


def alone(mesh, count):
    """In this process: seconds of the wall, and of the processor for shapes and for answers."""
    begin, made, found = time.perf_counter(), 0.0, []
    before = time.process_time()
    for start in range(0, count, BLOCK):
        begin_of_block = time.process_time()
        block = shapes(start, min(BLOCK, count - start))
        made += time.process_time() - begin_of_block
        found.append(mesh.distance(block, 0.4))
    used = time.process_time() - before
    return time.perf_counter() - begin, made, used - made, np.concatenate(found)


def over_dask(mesh, count, workers):
    with Client(n_workers=workers, threads_per_worker=1, dashboard_address=None) as client:
        distances(client, mesh, workers * BLOCK, BLOCK).compute()  # the mesh is there, and all is imported
        begin = time.perf_counter()
        found = distances(client, mesh, count, BLOCK).compute()
        return time.perf_counter() - begin, found


def over_ray(mesh, count, workers):
    ray.init(num_cpus=workers, include_dashboard=False, logging_level="error")
    sent = ray.put(mesh)

    def ask(count):
        ends = [(start, min(start + BLOCK, count)) for start in range(0, count, BLOCK)]
        return np.concatenate(ray.get([block_of_distances.remote(sent, *end) for end in ends]))

    ask(workers * BLOCK)
    begin = time.perf_counter()
    found = ask(count)
    took = time.perf_counter() - begin
    ray.shutdown()
    return took, found


def main(count=200_000, rounds=3):
    mesh = Mesh(*sphere(40.0, 5))
    ways = {"Dask": over_dask, "Ray": over_ray}
    walls = {}
    made = answered = np.inf
    for _ in range(rounds):
        wall, seconds_made, seconds_answered, expected = alone(mesh, count)
        made, answered = min(made, seconds_made), min(answered, seconds_answered)
        walls["one process, no cluster", 1] = min(walls.get(("one process, no cluster", 1), np.inf), wall)
        for name, over in ways.items():
            for workers in (1, 2):
                wall, found = over(mesh, count, workers)
                assert np.array_equal(found, expected)
                walls[name, workers] = min(walls.get((name, workers), np.inf), wall)
    micro = 1e6 / count
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in ("dask", "ray", "numpy"))
    rows = [
        f"| {name} | {workers} | {wall * micro:.1f} | "
        + (f"{walls[name, 1] / wall:.2f}" if workers == 2 else "")
        + " |"
        for (name, workers), wall in sorted(walls.items(), key=lambda row: list(ways).index(row[0][0]) if row[0][0] in ways else -1)
    ]
    slowest = max(walls["Dask", 2], walls["Ray", 2])
    hours = slowest / count * SHAPES / 3600
    lines = [
        "# Very many shapes: Dask and Ray",
        "",
        "10^8 shapes of a robot with 30 links are 74 GB, more than most machines hold. So nobody holds them all: the mesh is sent to",
        "every worker once, a worker makes a block of shapes, asks about it, and keeps the distances, 8 bytes for a shape.",
        "[dask_blocks.py](../crates/python/examples/dask_blocks.py) does so over Dask, whose array of distances is as large as one",
        "likes; [ray_blocks.py](../crates/python/examples/ray_blocks.py) over Ray. Each is a few lines to copy. For a cluster give",
        "`Client` or `ray.init` its address, and start each worker with `RAYON_NUM_THREADS=1` and as many workers as cores.",
        "",
        f"Written by `python crates/python/bench/scale.py {count} {rounds}` on a machine with {os.cpu_count()} cores ({platform.machine()}, Python "
        f"{platform.python_version()}),",
        f"with parry-continuum {parry_continuum.__version__}, {versions}. {count:,} shapes of 30 links each in blocks",
        f"of {BLOCK:,}, in a closed mesh of {len(mesh.faces):,} triangles. The least of {rounds} rounds, which go through all rows in turn; all rows give the same distances bit for bit.",
        "",
        f"A shape takes {answered * micro:.1f} us of processor time to ask about, and {made * micro:.1f} us to make, in numpy.",
        "",
        "| way | workers | a shape, us of the clock | times as fast as one worker |",
        "|---|---|---|---|",
        *rows,
        "",
        f"**Extrapolated, and not measured:** 10^8 shapes would take {(made + answered) / count * SHAPES / 3600:.2g} hours of one "
        "core's time, and at the rate of the slower",
        f"of the two rows of two workers {hours:.2g} hours on this machine. Blocks do not depend on one another, so that more workers "
        "share that",
        f"as long as the scheduler hands out blocks as fast as they are done. A block takes a worker {BLOCK * slowest / count * 2:.2g} s; "
        "larger blocks give the scheduler less to do.",
    ]
    PAGE.write_text("\n".join(lines) + "\n")
    print(PAGE.read_text())


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
