"""Motions, scenes and queries are copied and pickled, and answer as before."""

from __future__ import annotations

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import (
    BendingMotion,
    ContinuumError,
    LinearMotion,
    Mesh,
    Motion,
    MotionPath,
    MovingBase,
    RigidMotion,
    RobotPair,
    Scene,
    SelfQuery,
)
from shapes import poses, robots, sphere

RANDOM = np.random.default_rng(55)
MESH = Mesh(*sphere())
MANY, POSES = robots(RANDOM, 5), poses(RANDOM, 5)
ONE = MANY[0]
TANGENTS = np.stack([MANY[:, 1] - MANY[:, 0], MANY[:, -1] - MANY[:, -2]], axis=1)
SECTIONS = np.array([[9.0, 0.01, 0], [3, 0, 0.02]])
MOTIONS = {
    "linear": LinearMotion(ONE, ONE + 1, 0.1),
    "linear of many": LinearMotion(MANY, MANY + 1, np.full(11, 0.1), caps="capsules"),
    "of lists": LinearMotion(ONE.tolist(), (ONE + 1).tolist(), 0.1),
    "rigid": RigidMotion(ONE, 0.1, POSES[0], POSES[1], caps="cylinders"),
    "rigid of many": RigidMotion(ONE, 0.1, POSES, POSES[::-1]),
    "curve": RigidMotion.of_curve(MANY, 0.1, POSES, POSES[::-1], tangents=TANGENTS, turn=0.1),
    "fit": RigidMotion.of_curve(ONE, 0.1, POSES[0], POSES[1], deviation=0.01),
    "bending": BendingMotion(SECTIONS, SECTIONS + [0, 0.01, 0], [0.2, 0.1], pose=POSES[1]),
    "bending without a pose": BendingMotion(SECTIONS, SECTIONS + [0, 0.01, 0], 0.2),
    "base": MovingBase(BendingMotion(SECTIONS, SECTIONS + [0, 0.01, 0], 0.2), POSES, POSES[::-1]),
    "path": MotionPath([LinearMotion(ONE, ONE + 1, 0.1), LinearMotion(ONE + 1, ONE, 0.1)]),
    "none": LinearMotion(MANY[:0], MANY[:0], 0.1),
}
WAYS = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    **{f"pickle {protocol}": lambda it, protocol=protocol: pickle.loads(pickle.dumps(it, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)},
}


def answer(motion: Motion) -> Any:
    return MESH.clearance_of_motion(motion, tolerance=0.1)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", MOTIONS)
def test_motions(name: str, way: str) -> None:
    motion = MOTIONS[name]
    again = WAYS[way](motion)
    assert type(again) is type(motion) and again.count == motion.count
    for one, other in zip(answer(again), answer(motion)):
        assert_array_equal(one, other)


def test_motions_are_made_of_copies() -> None:
    points = ONE.copy()
    motion = LinearMotion(points, points + 1, 0.1)
    before = answer(motion)
    points[:] = np.nan
    again = pickle.loads(pickle.dumps(motion))
    assert_array_equal(answer(again).lower, before.lower)


@pytest.mark.parametrize("way", WAYS)
def test_scenes(way: str) -> None:
    scene = Scene(robot_margin=0.2, nested=[(0, 1)])
    scene.add("wall", MESH, margin=0.5)
    scene.add("seen", MESH, margin=None, pose=POSES[2])
    scene.add("vessel", Mesh(*sphere(1.0)), margin=0.1, pose=POSES[1])
    again = WAYS[way](scene)
    assert type(again) is Scene and len(again) == 3
    given = [(MANY, 0.1), (MANY, 0.05), (ONE, 0.1, POSES[3])]
    for ask in (Scene.tightest, Scene.per_structure):
        for one, other in zip(ask(again, given), ask(scene, given)):
            assert_array_equal(one, other)
    assert_array_equal(again.clears(given), scene.clears(given))
    scene.add("more", MESH, margin=1.0)
    assert (len(scene), len(again)) == (4, 3)
    assert repr(again) == 'Scene("wall", "seen", "vessel")'
    empty = WAYS[way](Scene())
    assert len(empty) == 0
    with pytest.raises(ContinuumError, match="nothing in the scene has a margin"):
        empty.clears([(ONE, 0.1)])


def test_a_copy_shares_its_meshes_and_a_deep_copy_does_not() -> None:
    vertices, faces = sphere()
    mesh, scene = Mesh(vertices, faces), Scene()
    scene.add("wall", mesh, margin=0.0)
    shared, own = copy.copy(scene), copy.deepcopy(scene)
    before = scene.tightest([(ONE, 0.1)]).slack
    mesh.set_vertices(vertices * 2)
    after = scene.tightest([(ONE, 0.1)]).slack
    assert after > before
    assert (shared.tightest([(ONE, 0.1)]).slack, own.tightest([(ONE, 0.1)]).slack) == (after, before)


@pytest.mark.parametrize("way", WAYS)
def test_pairs(way: str) -> None:
    pair = RobotPair()
    expected = pair.minimum(MANY, 0.1, ONE, 0.1)
    again = WAYS[way](pair)
    assert type(again) is RobotPair
    assert_array_equal(again.minimum(MANY, 0.1, ONE, 0.1).distance, expected.distance)


@pytest.mark.parametrize("way", WAYS)
def test_self_queries(way: str) -> None:
    query = SelfQuery()
    hooks = np.array([[0, 0, 0], [0, 0, 9], [2, 0, 11], [4, 0, 9], [4, 0, 0]]) * np.linspace(1, 2, 5)[:, None, None]
    expected = query.minimum(hooks, 0.1)
    again = WAYS[way](query)
    assert type(again) is SelfQuery and again is not query
    assert_array_equal(again.minimum(hooks, 0.1).distance, expected.distance)
    np.testing.assert_allclose(expected.distance, 4 * np.linspace(1, 2, 5) - 0.2, rtol=1e-14)


def test_another_process() -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as process:
        assert process.submit(answer, MOTIONS["rigid"]).result().lower == answer(MOTIONS["rigid"]).lower
