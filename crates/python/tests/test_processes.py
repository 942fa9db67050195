"""Children of a process: forked, spawned, and forked while other threads ask."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import Mesh
from shapes import Array, robots, sphere

VERTICES, FACES = sphere(10.0, 60, 30)
ROBOTS = robots(np.random.default_rng(6), 200)
METHODS = [method for method in multiprocessing.get_all_start_methods() if method != "forkserver"]
TESTS = Path(__file__).parent


def answers(mesh: Mesh) -> list[Array]:
    """Of every kind that builds something at its first question, alone and on all cores."""
    return [
        mesh.distance(ROBOTS, 0.1),
        np.array([mesh.distance(robot, 0.1) for robot in ROBOTS[:5]]),
        mesh.clears(ROBOTS, 0.1, margin=0.5),
        mesh.contacts_within(ROBOTS[:30], 0.1, margin=2.0).distance,
        mesh.side(ROBOTS[:, 0]),
        mesh.distance(ROBOTS[:1] + 1e12, 0.1),
        Mesh(VERTICES + 1, FACES).distance(ROBOTS, 0.1),
    ]


def agree(mesh: Mesh, expected: list[Array]) -> bool:
    found = answers(mesh)
    mesh.set_vertices(VERTICES + 1)
    return all(map(np.array_equal, found, expected)) and np.array_equal(mesh.distance(ROBOTS, 0.1), expected[-1])


def in_child(ask: object) -> int:
    """What a forked child answers; it is killed if it does not."""
    child = os.fork()
    if child == 0:
        status = 1
        try:
            status = 0 if ask() else 2  # type: ignore[operator]
        finally:
            os._exit(status)
    end = time.monotonic() + 60
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.01)
    os.kill(child, 9)
    os.waitpid(child, 0)
    raise TimeoutError("a child hangs")


@pytest.mark.parametrize("method", METHODS)
def test_pools_of_processes(method: str) -> None:
    mesh = Mesh(VERTICES, FACES)
    expected = answers(mesh)
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(method)) as processes:
        for found in processes.map(answers, [mesh] * 4):
            for one, other in zip(found, expected):
                assert_array_equal(one, other)


needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
quiet = pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")


@needs_fork
@quiet
def test_a_child_of_a_process_that_asked() -> None:
    mesh = Mesh(VERTICES, FACES)
    expected = answers(mesh)
    assert in_child(lambda: agree(mesh, expected)) == 0
    assert in_child(lambda: in_child(lambda: agree(mesh, expected)) == 0) == 0
    assert agree(mesh, expected)


@needs_fork
@quiet
def test_forks_while_other_threads_ask() -> None:
    """Batches, first questions that build, moves and new meshes, in the middle of which a child is made."""
    expected = answers(Mesh(VERTICES, FACES))
    meshes = [Mesh(VERTICES, FACES)]
    is_over = threading.Event()

    def ask() -> None:
        while not is_over.is_set():
            mesh = meshes[-1]
            mesh.per_link(ROBOTS, 0.1)
            mesh.contacts_within(ROBOTS[:20], 0.1, margin=2.0)
            mesh.side(ROBOTS)

    def move() -> None:
        while not is_over.is_set():
            fresh = Mesh(VERTICES, FACES)  # with all that is to be built
            meshes.append(fresh)
            fresh.set_vertices(VERTICES)
            del meshes[:-3]

    threads = [threading.Thread(target=work) for work in (ask, ask, move)]
    for thread in threads:
        thread.start()
    try:
        for _ in range(30):
            mesh = meshes[-1]
            assert in_child(lambda: agree(mesh, expected)) == 0
    finally:
        is_over.set()
        for thread in threads:
            thread.join()


@needs_fork
@quiet
def test_forks_while_another_thread_builds() -> None:
    """A first question builds something, which others wait for. In the child it stays half built, and nobody finishes it."""
    vertices, faces = sphere(10.0, 250, 125)
    asks = [lambda mesh: mesh.side([0.0, 0, 0]), lambda mesh: len(mesh.contacts_within(ROBOTS[0], 0.1, margin=1.0).segment)]
    in_the_middle = 0
    for turn in range(12):
        ask = asks[turn % 2]
        mesh = Mesh(vertices, faces)
        thread = threading.Thread(target=ask, args=(mesh,))
        thread.start()
        time.sleep(0.001 * (turn // 2))
        in_the_middle += thread.is_alive()
        assert in_child(lambda: ask(mesh) is not None) == 0
        thread.join()
    assert in_the_middle > 0


@needs_fork
def test_a_fork_in_a_signal_handler() -> None:
    """Python's handlers run between the chunks of a batch: the child goes on with its own batch."""
    program = """
import numpy as np, os, signal, sys
from shapes import robots, sphere
from parry_continuum import Mesh
mesh = Mesh(*sphere())
many = np.tile(robots(np.random.default_rng(0), 200), (300, 1, 1))
expected = mesh.distance(many[:200], 0.1)
children = []
signal.signal(signal.SIGALRM, lambda *_: children.append(os.fork()))
signal.setitimer(signal.ITIMER_REAL, 0.1)
found = mesh.distance(many, 0.1)
assert np.array_equal(found, np.tile(expected, 300))
assert len(children) == 1
if children[0]:
    sys.exit(os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]))
"""
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", program], cwd=TESTS, timeout=120, check=False)
    assert done.returncode == 0
