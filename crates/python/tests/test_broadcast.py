"""One robot stands for as many as there are poses, radii or other robots, as numpy broadcasts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import (
    BendingMotion,
    ContinuumError,
    LinearMotion,
    Mesh,
    MovingBase,
    RigidMotion,
    RobotPair,
    Scene,
)
from shapes import poses, robots, sphere

RANDOM = np.random.default_rng(44)
MESH = Mesh(*sphere())
B = 21
MANY, POSES = robots(RANDOM, B), poses(RANDOM, B)
ONE, RADII = MANY[0], RANDOM.uniform(0.05, 0.2, (B, 11))
REPEATED = np.stack([ONE] * B)
PAIR, SCENE = RobotPair(), Scene(robot_margin=0.1)
SCENE.add("wall", MESH, margin=0.5)
TANGENTS = np.stack([ONE[1] - ONE[0], ONE[-1] - ONE[-2]])


def same(found: Any, expected: Any) -> None:
    for one, other in zip(found, expected) if isinstance(found, tuple) else [(found, expected)]:
        assert_array_equal(one, other)
        assert np.shape(one) == np.shape(other)


QUESTIONS = {
    "distance": lambda p, r, **m: MESH.distance(p, r, **m),
    "minimum": lambda p, r, **m: MESH.minimum(p, r, **m),
    "per_link": lambda p, r, **m: MESH.per_link(p, r, **m),
    "clears": lambda p, r, **m: MESH.clears(p, r, margin=0.5, **m),
    "clears_inside": lambda p, r, **m: MESH.clears_inside(p, r, margin=0.5, **m),
    "within": lambda p, r, **m: MESH.contacts_within(p, r, margin=4.0, **m),
    "clearance": lambda p, r, **m: MESH.clearance(p, r, tolerance=0.5, **m),
    "clears_tube": lambda p, r, **m: MESH.clears_tube(p, r, margin=0.5, resolution=0.5, **m),
    "distance_and_gradient": lambda p, r, **m: MESH.distance_and_gradient(p, r, **m),
    "certify": lambda p, r, **m: MESH.certify(p, r, MESH.per_link(p, r, **m), **m),
    "pair.per_link": lambda p, r, pose=None: PAIR.per_link(ONE + 3, 0.1, p, r, pose_b=pose),
    "pair.within": lambda p, r, pose=None: PAIR.contacts_within(ONE + 3, 0.1, p, r, margin=9.0, pose_b=pose),
    "pair.clearance": lambda p, r, pose=None: PAIR.clearance(p, r, ONE + 3, 0.1, tolerance=1.0, pose_a=pose),
    "pair.clears_tubes": lambda p, r, pose=None: PAIR.clears_tubes(ONE + 3, 0.1, p, r, margin=1.0, resolution=1.0, pose_b=pose),
    "pair.certify": lambda p, r, pose=None: PAIR.certify(
        ONE + 3, 0.1, p, r, PAIR.minimum(ONE + 3, 0.1, p, r, pose_b=pose), pose_b=pose
    ),
    "scene.clears": lambda p, r, pose=None: SCENE.clears([(ONE + 3, 0.1), (p, r, pose)]),
    "scene.tightest": lambda p, r, pose=None: SCENE.tightest([(p, r, pose), (ONE + 3, 0.1)]),
    "scene.per_structure": lambda p, r, pose=None: SCENE.per_structure([(p, r, pose), (ONE[None] + 3, 0.1)]),
    "scene.contacts_within": lambda p, r, pose=None: SCENE.contacts_within([(p, r, pose)], reach=4.0),
    "rigid": lambda p, r, pose=None: MESH.clearance_of_motion(
        RigidMotion(p, r, np.eye(4) if pose is None else pose, np.eye(4)), tolerance=0.5
    )[:1],
}


@pytest.mark.parametrize("name", QUESTIONS)
def test_one_for_many(name: str) -> None:
    ask = QUESTIONS[name]
    for one in (ONE, ONE[None]):
        same(ask(one, 0.1, pose=POSES), ask(REPEATED, 0.1, pose=POSES))
        same(ask(one, RADII), ask(REPEATED, RADII))
        same(ask(one, RADII, pose=POSES), ask(REPEATED, RADII, pose=POSES))
        same(ask(one, RADII[:1], pose=POSES), ask(REPEATED, RADII[0], pose=POSES))
        same(ask(one, 0.1, pose=POSES[:0]), ask(REPEATED[:0], 0.1, pose=POSES[:0]))
    same(ask(MANY, RADII[:1], pose=POSES[:1]), ask(MANY, RADII[0], pose=POSES[0]))
    same(ask(ONE[None], 0.1), ask(MANY[:1], np.full((1, 11), 0.1)))
    same(ask(ONE, 0.1, pose=POSES[:1]), ask(MANY[:1], 0.1, pose=POSES[:1]))


def test_one_of_two() -> None:
    for a, b in ((MANY, ONE[None]), (ONE[None], MANY), (ONE, MANY)):
        repeated = [np.broadcast_to(points, MANY.shape) for points in (a, b)]
        same(PAIR.minimum(a, 0.1, b, 0.1), PAIR.minimum(repeated[0], 0.1, repeated[1], 0.1))
    same(PAIR.minimum(ONE, 0.1, ONE + 3, 0.1, pose_a=POSES), PAIR.minimum(REPEATED, 0.1, REPEATED + 3, 0.1, pose_a=POSES))
    same(PAIR.minimum(ONE, RADII, ONE + 3, 0.1, pose_b=POSES), PAIR.minimum(REPEATED, RADII, REPEATED + 3, 0.1, pose_b=POSES))
    same(SCENE.clears([(MANY, 0.1), (ONE[None], 0.1), (ONE, 0.1, POSES)]), SCENE.clears([(MANY, 0.1), (REPEATED, 0.1), (REPEATED, 0.1, POSES)]))


def test_curves() -> None:
    for tangents in (TANGENTS, TANGENTS[None]):
        for one in (ONE, ONE[None]):
            found = MESH.clearance(one, 0.1, tolerance=0.5, tangents=tangents, pose=POSES)
            same(found, MESH.clearance(REPEATED, 0.1, tolerance=0.5, tangents=np.stack([TANGENTS] * B), pose=POSES))
    each = np.stack([TANGENTS] * B)
    expected = MESH.clearance(REPEATED, 0.1, tolerance=0.5, tangents=each, pose=POSES)
    same(MESH.clearance(ONE, 0.1, tolerance=0.5, tangents=each, pose=POSES), expected)
    same(MESH.clearance(REPEATED, 0.1, tolerance=0.5, tangents=TANGENTS[None], pose=POSES), expected)
    same(MESH.clearance(REPEATED, 0.1, tolerance=0.5, tangents=TANGENTS, pose=POSES), expected)
    along = np.gradient(ONE, axis=0)
    assert MESH.clearance(ONE, 0.1, tolerance=0.5, tangents=along[None]).lower.shape == (1,)
    same(MESH.clearance(REPEATED, 0.1, tolerance=0.5, tangents=along[None]), MESH.clearance(REPEATED, 0.1, tolerance=0.5, tangents=np.stack([along] * B)))
    pair = PAIR.clearance(ONE, 0.1, MANY, 0.1, tolerance=0.5, tangents_a=TANGENTS)
    same(pair, PAIR.clearance(REPEATED, 0.1, MANY, 0.1, tolerance=0.5, tangents_a=each))
    with pytest.raises(ContinuumError, match="`tangents` has the shape"):
        MESH.clearance(MANY, 0.1, tolerance=0.5, tangents=each[1:])


def test_one_end_for_many() -> None:
    many = LinearMotion(MANY, REPEATED, 0.1)
    for start, end, expected in (
        (MANY, ONE[None], many),
        (MANY, ONE, many),
        (ONE, MANY, LinearMotion(REPEATED, MANY, 0.1)),
        (ONE[None], MANY, LinearMotion(REPEATED, MANY, 0.1)),
    ):
        found = MESH.clearance_of_motion(LinearMotion(start, end, 0.1), tolerance=0.5)
        same(found, MESH.clearance_of_motion(expected, tolerance=0.5))
        same(MESH.clearance_of_motion(start, end, 0.1, tolerance=0.5), found)
    same(MESH.clearance_of_motion(ONE, MANY, RADII, tolerance=0.5), MESH.clearance_of_motion(REPEATED, MANY, RADII, tolerance=0.5))
    with pytest.raises(ContinuumError, match=r"`end` has the shape \(20, 12, 3\), and `start` has \(21, 12, 3\); give both the same"):
        LinearMotion(MANY, MANY[1:], 0.1)
    with pytest.raises(ContinuumError, match="`end` has the shape"):
        LinearMotion(MANY, MANY[:, :5], 0.1)


def test_motions() -> None:
    sections = np.array([[9.0, 0.01, 0]])
    assert BendingMotion(sections[None], np.stack([sections] * B), 0.1).count == B
    assert BendingMotion(sections, sections, np.full((1, 1), 0.1), pose=POSES).count == B
    assert MovingBase(LinearMotion(ONE[None], ONE[None], 0.1), POSES, POSES[:1]).count == B
    assert RigidMotion(ONE[None], 0.1, POSES[:1], POSES).count == B
    pair = PAIR.clears_motions(LinearMotion(ONE[None], ONE[None], 0.1), LinearMotion(MANY, MANY, 0.1), margin=0.1, resolution=0.1)
    assert pair.is_clear.shape == (B,)
    found = MESH.clears_motion(ONE, ONE + 1, RADII, margin=0.1, resolution=0.1)
    assert_array_equal(found.decision, MESH.clears_motion(REPEATED, REPEATED + 1, RADII, margin=0.1, resolution=0.1).decision)
    path = MESH.clears_path([ONE, ONE + 1], RADII, 0.1, margin=0.1, resolution=0.1)
    assert path.is_clear.shape == (B,)


@pytest.mark.parametrize(
    ("ask", "kind", "text"),
    [
        (
            lambda: MESH.distance(MANY, np.ones(B)),
            "lengths_differ",
            "12 points need 11 radii, got 21 in `radii`; one radius for each robot is `radii[:, None] * np.ones(11)`, of the shape (B, 11)",
        ),
        (lambda: MESH.distance(MANY, np.ones((B, 1))), "lengths_differ", "one radius for each robot is `radii[:, None] * np.ones(11)`"),
        (lambda: PAIR.minimum(ONE, 0.1, MANY, np.ones(B)), "lengths_differ", "one radius for each robot is `radii_b[:, None] * np.ones(11)`"),
        (lambda: MESH.distance(MANY, np.ones(10)), "lengths_differ", "got 10 in `radii`"),
        (lambda: MESH.distance(MANY, np.ones((B - 1, 11))), "bad_shape", "(11,) or (21, 11)"),
        (lambda: MESH.distance(MANY, 0.1, pose=POSES[1:]), "bad_shape", "`pose` has the shape (20, 4, 4); give None, or the shape (4, 4) or (21, 4, 4)"),
        (lambda: MESH.distance(ONE, RADII, pose=POSES[1:]), "bad_shape", "`pose` has the shape (20, 4, 4)"),
        (lambda: MESH.distance(ONE, 0.1, pose=np.ones((2, 2, 4, 4))), "bad_shape", "(4, 4) or (B, 4, 4)"),
        (lambda: PAIR.minimum(MANY, 0.1, ONE, 0.1, pose_b=POSES[1:]), "bad_shape", "`points_a` has 21 robots and `points_b` 20"),
        (lambda: SCENE.clears([(ONE, 0.1, POSES), (MANY[:2], 0.1)]), "bad_shape", "`robots[0]` has 21 robots and `robots[1]` 2"),
        (lambda: RigidMotion(MANY, 0.1, POSES[1:], POSES), "bad_shape", "`points` has 21 and `start_pose` 20"),
    ],
)
def test_what_does_not_fit(ask: Any, kind: str, text: str) -> None:
    with pytest.raises(ContinuumError) as raised:
        ask()
    assert raised.value.kind == kind and text in str(raised.value)


def test_the_remedy() -> None:
    radii = np.linspace(0.1, 0.2, B)
    found = MESH.distance(MANY, radii[:, None] * np.ones(11))
    assert_array_equal(found, [MESH.distance(points, radius) for points, radius in zip(MANY, radii)])
