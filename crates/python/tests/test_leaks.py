"""A million calls, and many of the larger kinds, take no more memory than some thousands."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from parry_continuum import ContinuumError, LinearMotion, Mesh, RobotPair, Scene
from shapes import robots

MESH = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
ROBOT = np.array([[0, 0, 1.0], [0, 0, 2.0]])
MANY = robots(np.random.default_rng(0), 20, points=3)
PAIR = RobotPair()
SCENE = Scene()
SCENE.add("floor", MESH, margin=0.1)


def refused() -> None:
    with pytest.raises(ContinuumError):
        MESH.distance(ROBOT * np.nan, 0.1)


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="asks Linux how much memory is used")
@pytest.mark.parametrize(
    ("ask", "count"),
    [
        (lambda: MESH.clears(ROBOT, 0.1, margin=0.1), 1_000_000),
        (lambda: MESH.per_link(ROBOT, 0.1), 100_000),
        (lambda: MESH.contacts_within(ROBOT, 0.1, margin=0.5), 100_000),
        (lambda: MESH.clearance(ROBOT, 0.1, tolerance=0.1), 50_000),
        (lambda: MESH.distance_and_gradient(ROBOT, 0.1), 10_000),
        (lambda: MESH.distance(MANY, 0.1), 10_000),
        (lambda: MESH.set_vertices(MESH.vertices), 5_000),
        (lambda: Mesh(MESH), 5_000),
        (lambda: PAIR.minimum(ROBOT, 0.1, ROBOT + 3, 0.1), 30_000),
        (lambda: PAIR.contacts_within(ROBOT, 0.1, ROBOT + 3, 0.1, margin=9.0), 30_000),
        (lambda: SCENE.tightest([(ROBOT, 0.1)]), 20_000),
        (lambda: SCENE.contacts_within([(ROBOT, 0.1)], reach=3.0), 20_000),
        (lambda: MESH.clears_motion(LinearMotion(MANY, MANY + 1, 0.1), margin=0.1, resolution=0.1), 3_000),
        (refused, 20_000),
    ],
)
def test_nothing_is_kept(ask: object, count: int) -> None:
    def pages() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1])

    for _ in range(2000):
        ask()  # type: ignore[operator]
    before = pages()
    for _ in range(count):
        ask()  # type: ignore[operator]
    # 2 MiB, of which an array kept by each call would take several times as much in most rows.
    assert pages() - before < 512
