"""Ctrl-C ends what reads or computes for long."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from shapes import sphere

TESTS = Path(__file__).parent
PROGRAM = """
import signal, sys, time
# A shell that runs the tests in the background has its children ignore SIGINT.
signal.signal(signal.SIGINT, signal.default_int_handler)
import numpy as np
from parry_continuum import Mesh, load, load_centreline
sys.path.insert(0, {tests!r})
from shapes import sphere
what, path = sys.argv[1:]
vertices, faces = sphere(10.0, 1200, 600) if what == "Mesh" else (None, None)
print("begins", flush=True)
try:
    for _ in range(1000):
        {{"load": lambda: load(path), "load_centreline": lambda: load_centreline(path), "Mesh": lambda: Mesh(vertices, faces)}}[what]()
except KeyboardInterrupt:
    print("ended", flush=True)
"""


def large(folder: Path, what: str) -> Path:
    if what == "load_centreline":
        file = folder / "robot.csv"
        file.write_text("\n".join(f"0,0,{k}" for k in range(3_000_000)))
        return file
    vertices, faces = sphere(10.0, 1200, 600)
    file = folder / "wall.obj"
    with file.open("w") as out:
        np.savetxt(out, vertices, "v %.9g %.9g %.9g")
        np.savetxt(out, faces + 1, "f %d %d %d")
    return file


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
@pytest.mark.parametrize("what", ["load", "load_centreline", "Mesh"])
def test_reading_ends_within_a_second(what: str, tmp_path: Path) -> None:
    file = large(tmp_path, what)
    program = PROGRAM.format(tests=str(TESTS))
    with subprocess.Popen([sys.executable, "-c", program, what, str(file)], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == "begins\n"
        time.sleep(0.7)
        begin = time.monotonic()
        child.send_signal(signal.SIGINT)
        assert child.stdout.readline() == "ended\n"
        assert time.monotonic() - begin < 1
        child.kill()


LONG = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
import numpy as np
from parry_continuum import LinearMotion, Mesh, verify_motion
sys.path.insert(0, {tests!r})
from shapes import sphere
random = np.random.default_rng(1)
line = np.cumsum(random.normal(size=(100, 3)), axis=0)
one = LinearMotion(line[:40], line[:40] + 1, 0.1)
many = LinearMotion(np.stack([line[:40]] * 8), np.stack([line[:40] + 1] * 8), 0.1)
mesh = Mesh(*sphere(10.0, 200, 100))
# The first robots are far away, so that a chunk of many is begun; all others are in the mesh.
robots = np.concatenate([np.stack([line + 1e4] * 400), np.stack([0.5 * line] * 2000)])
asked = {{
    "one": lambda: verify_motion(one, steps=400_000),
    "many": lambda: verify_motion(many, steps=400_000),
    "contacts": lambda: mesh.contacts_within(robots, 0.1, margin=10.0),
    "few": lambda: mesh.contacts_within(robots[-15:], 0.1, margin=10.0),
}}
print("begins", flush=True)
try:
    for _ in range(1000):
        asked[sys.argv[1]]()
except KeyboardInterrupt:
    print("ended", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
@pytest.mark.parametrize("what", ["one", "many", "contacts", "few"])
def test_computing_ends_within_seconds(what: str) -> None:
    program = LONG.format(tests=str(TESTS))
    with subprocess.Popen([sys.executable, "-c", program, what], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == "begins\n"
        time.sleep(1.5)
        begin = time.monotonic()
        child.send_signal(signal.SIGINT)
        assert child.stdout.readline() == "ended\n"
        # A query about one robot is not interrupted.
        assert time.monotonic() - begin < 4
        child.kill()
