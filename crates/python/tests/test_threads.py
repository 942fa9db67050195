"""Threads that share a mesh, one that moves it meanwhile, and Ctrl-C."""

from __future__ import annotations

import signal
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import Mesh
from shapes import robots, sphere

VERTICES, FACES = sphere()
ROBOTS = robots(np.random.default_rng(4), 400)


def test_threads_share_a_mesh() -> None:
    mesh = Mesh(VERTICES, FACES)
    expected = mesh.distance(ROBOTS, 0.1)
    contacts = mesh.contacts_within(ROBOTS, 0.1, margin=6.0)
    assert len(contacts.segment) > 100

    def ask(turn: int) -> None:
        for k in range(turn, len(ROBOTS), 8):
            assert mesh.distance(ROBOTS[k], 0.1) == expected[k]
        assert_array_equal(mesh.distance(ROBOTS, 0.1), expected)
        for one, other in zip(mesh.contacts_within(ROBOTS, 0.1, margin=6.0), contacts):
            assert_array_equal(one, other)

    with ThreadPoolExecutor(8) as threads:
        list(threads.map(ask, range(8)))


def test_first_questions_of_many_threads() -> None:
    """What is built at a first question is built once, while others wait."""
    for _ in range(20):
        mesh = Mesh(VERTICES, FACES)
        start = threading.Barrier(8)

        def ask(turn: int) -> object:
            start.wait()
            if turn % 2:
                return mesh.side(ROBOTS[:30])
            return mesh.contacts_within(ROBOTS[:40], 0.1, margin=3.0).triangle

        with ThreadPoolExecutor(8) as threads:
            found = list(threads.map(ask, range(8)))
        for turn in range(2, 8):
            assert_array_equal(found[turn], found[turn % 2])


def test_a_batch_sees_one_mesh() -> None:
    """While one thread moves the mesh to and fro, each answer of others is about one place of it, for all robots."""
    mesh = Mesh(VERTICES, FACES)
    places = [VERTICES, VERTICES + [0.5, 0, 0]]
    expected = [Mesh(vertices, FACES).distance(ROBOTS, 0.1) for vertices in places]
    assert not np.array_equal(*expected)
    is_over, seen = threading.Event(), set()

    def move() -> None:
        turn = 0
        while not is_over.is_set():
            turn += 1
            mesh.set_vertices(places[turn % 2])

    mover = threading.Thread(target=move)
    mover.start()
    try:
        end = time.monotonic() + 20
        while len(seen) < 2 and time.monotonic() < end:
            for _ in range(20):
                found = mesh.distance(ROBOTS, 0.1)
                seen.add(next(k for k in range(2) if np.array_equal(found, expected[k])))
    finally:
        is_over.set()
        mover.join()
    assert seen == {0, 1}


def test_what_moved_is_seen_at_once() -> None:
    mesh = Mesh(VERTICES, FACES)
    for shift in range(5):
        mesh.set_vertices(VERTICES + [shift, 0, 0])
        assert_array_equal(mesh.distance(ROBOTS, 0.1), Mesh(VERTICES + [shift, 0, 0], FACES).distance(ROBOTS, 0.1))


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise")
def test_ctrl_c_ends_a_batch() -> None:
    program = """
        import signal
        import numpy as np
        from shapes import robots, sphere
        from parry_continuum import Mesh
        # A shell has what runs in the background ignore it.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        mesh = Mesh(*sphere())
        many = np.tile(robots(np.random.default_rng(0), 200), (2_000, 1, 1))
        print("begin", flush=True)
        try:
            while True: # however fast the machine is
                mesh.per_link(many, 0.1)
        except KeyboardInterrupt:
            mesh.distance(many[:50], 0.1)
            print("ended", flush=True)
    """
    command = [sys.executable, "-c", textwrap.dedent(program)]
    with subprocess.Popen(command, cwd=Path(__file__).parent, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None and child.stdout.readline() == "begin\n"
        time.sleep(0.5)
        begin = time.monotonic()
        child.send_signal(signal.SIGINT)
        assert child.stdout.readline() == "ended\n"
        assert time.monotonic() - begin < 3
    assert child.returncode == 0
