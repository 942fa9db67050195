"""Writes docs/PYTHON_SPEED.md: this package beside its peers, and beside the Rust library.

    pip install './crates/python[bench]' && python crates/python/bench/peers.py

Peers that are not installed, or do not load, are left out, and the page says so. PAGE names another file. `beside.py` alone
prints the chapter about robots beside robots. Times are processor time, of all threads together, so that what else the machine does
counts little.
"""

import collections
import functools
import importlib.metadata
import importlib.util
import itertools
import os
import platform
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import beside
import numpy as np
from shapes import RADIUS, cavity, robots
from ways import WAYS

import parry_continuum
from parry_continuum import Mesh

CRATE = Path(__file__).parent.parent
PAGE = Path(os.environ.get("PAGE") or CRATE.parent.parent / "docs" / "PYTHON_SPEED.md")
DISTRIBUTIONS = {"fcl": "python-fcl"}


def timed(ask, shapes):
    """The median processor time of a call in microseconds, and the answers."""
    ask(shapes[0])
    times, found = [], []
    for points in shapes:
        begin = time.process_time()
        found.append(ask(points))
        times.append(time.process_time() - begin)
    return 1e6 * float(np.median(times)), np.array(found)


def number(value):
    return f"{value:,.0f}" if value >= 100 else f"{value:.1f}" if value >= 1 else f"{value:.2g}"


def peers(mesh, vertices, faces, shapes):
    """Rows of the table."""
    rows, missing = [], []
    own, exact = timed(lambda points: mesh.distance(points, RADIUS), shapes)
    batch = min(timed(lambda _: mesh.distance(shapes, RADIUS), [None] * 5)[0] for _ in range(3)) / len(shapes)
    touches = f"{np.mean(exact == 0):.0%} of the shapes touch"
    rows.append(("**`distance`**, one robot", len(shapes), own, "", "", ""))
    rows.append(("**`distance`**, a batch", len(shapes), batch, "", "", ""))
    for name, package, make, caps, count in WAYS:
        if importlib.util.find_spec(package) is None:
            missing.append(package)
            continue
        try:
            ask = make(vertices, faces)
        except ImportError as error:  # such as Open3D without a library of the system's
            print(error)
            missing.append(package)
            continue
        taken, found = timed(ask, shapes[:count])
        true = mesh.distance(shapes[:count], RADIUS, caps=caps)
        error, is_free = found - true, true > 0
        over, under = error[is_free].max(initial=0), (-error[is_free]).max(initial=0)
        called_free = np.mean(found[~is_free] > 0) if (~is_free).any() else 0
        over, under = (f"{error:.1e}" if error > 0 else "0" for error in (over, under))
        rows.append((name, count, taken, over, under, f"{called_free:.0%}"))
        print(rows[-1], flush=True)
    return rows, sorted(set(missing)), touches


def overhead(mesh, vertices, faces, shapes):
    """Of each question what a robot takes in Rust and in Python, microseconds of one thread's processor time."""
    given = [[len(vertices), len(faces), *shapes.shape[:2]], vertices, faces, shapes, [RADIUS]]
    data = np.concatenate([np.ravel(np.asarray(numbers, float)) for numbers in given]).tobytes()
    command = ["cargo", "run", "--quiet", "--release", "--example", "rust"]
    environment = {"CARGO_TARGET_DIR": str(CRATE / "target"), **os.environ, "RAYON_NUM_THREADS": "1"}
    radii = np.full(shapes.shape[1] - 1, RADIUS)
    asks = {
        "distance": (mesh.distance, radii),
        "clears": (functools.partial(mesh.clears, margin=1.0), radii),
        "per_link": (mesh.per_link, radii),
        "contacts_within": (functools.partial(mesh.contacts_within, margin=1.0), radii),
    }
    rust, python = {}, {}
    one_by_one = list(shapes)

    def least(table, name, value):
        table[name] = min(table.get(name, np.inf), value)

    for _ in range(3):
        lines = subprocess.run(command, cwd=CRATE, env=environment, input=data, capture_output=True, check=True).stdout
        for line in lines.decode().splitlines():
            name, one, *many = line.split()
            least(rust, name, float(one) / 1e3)
            if many:
                least(rust, f"{name} of a batch", float(many[0]) / 1e3)
        for name, (ask, *others) in asks.items():
            for _ in range(15):
                begin = time.thread_time()
                # A loop that costs next to nothing, and keeps no answer.
                collections.deque(map(ask, one_by_one, *map(itertools.repeat, others)), maxlen=0)
                least(python, name, 1e6 * (time.thread_time() - begin) / len(shapes))
        for _ in range(15):
            begin = time.process_time()
            mesh.distance(shapes, radii)
            least(python, "distance of a batch", 1e6 * (time.process_time() - begin) / len(shapes))
    return [(name, rust[name], python[name]) for name in rust]


def threads(mesh, shapes):
    """How many times as many robots two of Python's threads answer as one does, by the clock."""
    radii = np.full(shapes.shape[1] - 1, RADIUS)
    asks = {
        "distance": (mesh.distance, radii),
        "per_link": (mesh.per_link, radii),
        "contacts_within": (functools.partial(mesh.contacts_within, margin=1.0), radii),
    }
    one_by_one = list(shapes)
    taken = {}

    def work(ask, others):
        for _ in range(3):
            collections.deque(map(ask, one_by_one, *map(itertools.repeat, others)), maxlen=0)

    with ThreadPoolExecutor(2) as pool:
        for _ in range(8):
            for name, (ask, *others) in asks.items():
                for count in (1, 2):
                    begin = time.perf_counter()
                    list(pool.map(work, [ask] * count, [others] * count))
                    took = (time.perf_counter() - begin) / count
                    taken[name, count] = min(taken.get((name, count), np.inf), took)
    return [(name, taken[name, 1] / taken[name, 2]) for name in asks]


def main(count=500):
    vertices, faces = cavity()
    shapes = robots(count)
    mesh = Mesh(vertices, faces)
    mesh.prepare()
    busy = os.getloadavg()[0]
    # Before the peers are loaded, which bring threads and memory of their own.
    added, shared = overhead(mesh, vertices, faces, shapes), threads(mesh, shapes)
    rows, missing, touches = peers(mesh, vertices, faces, shapes)
    robots_beside = beside.chapter(number)
    versions = [DISTRIBUTIONS.get(package, package) for package in sorted({way[1] for way in WAYS} - set(missing))]
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in versions)
    without = f" Not there, or not to be loaded: {', '.join(missing)}." if missing else ""
    lines = [
        "# Python beside its peers",
        "",
        "Written by `python crates/python/bench/peers.py` (after `pip install './crates/python[bench]'`), on a machine",
        f"with {os.cpu_count()} cores ({platform.machine()}, Python {platform.python_version()}), with parry-continuum "
        f"{parry_continuum.__version__},",
        f"{versions}.{without}",
        "",
        f"A cavity of {len(faces):,} triangles, about 50 mm wide on each side, and robots of {shapes.shape[1] - 1} links, 75 mm",
        f"long, with the radius {RADIUS} mm; {touches}. Each library is asked as its users ask it. Errors are those of the",
        "distance of free shapes, against `distance` for the shape that the library was given: cylinders, capsules, or, for point",
        "queries, the robot itself. *Too far* is unsafe: the clearance is overstated. The last column is the share of touching shapes",
        "that are called free. Slow ways answer fewer shapes. Times are processor time of all threads together: the median of calls; for",
        "the batch the least of three medians divided by its shapes.",
        "",
        "| way | shapes | a robot, us | too far by, mm | too near by, mm | touching, called free |",
        "|---|---|---|---|---|---|",
        *(f"| {name} | {count} | {number(taken)} | {over} | {under} | {called_free} |"
          for name, count, taken, over, under, called_free in rows),
        "",
        *robots_beside,
        "",
        "## What Python adds",
        "",
        "Microseconds of processor time for a robot, the least of several rounds in turns: arrays in, a chain made of them, the answer,",
        "arrays out. For the times of a batch, the Rust program uses one thread, and Python all cores.",
        "",
        "| question | Rust | Python | more |",
        "|---|---|---|---|",
        *(f"| `{name}` | {rust:.2f} | {python:.2f} | {python - rust:+.2f} |"
          for name, rust, python in added),
        "",
        "## Two threads",
        "",
        "How many times as many robots two of Python's threads that share the mesh answer, one robot after the other, as one thread",
        f"does: by the clock, the least of several rounds in turns. The load was {busy:.1f} on {os.cpu_count()} cores in the minute before; what other",
        "programs take is not there for the second thread.",
        "",
        "| question | times as many |",
        "|---|---|",
        *(f"| `{name}` | {ratio:.2f} |" for name, ratio in shared),
    ]
    PAGE.write_text("\n".join(lines) + "\n")
    print(PAGE.read_text())


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
