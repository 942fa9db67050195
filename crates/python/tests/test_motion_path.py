"""Paths begin where they ended before, and what a motion states is tested."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from parry_continuum import (
    BendingMotion,
    ContinuumError,
    LinearMotion,
    Mesh,
    MotionPath,
    MovingBase,
    RigidMotion,
    RobotPair,
    SelfQuery,
    verify_motion,
)
from shapes import poses, robots

RANDOM = np.random.default_rng(21)
WALL = Mesh([[0, -90, -90], [0, 90, -90], [0, 0, 90]], [[0, 1, 2]])
LEFT = np.array([[-9, 0, 0.0], [-9, 3, 0.0]])
RIGHT = LEFT * [-1, 1, 1]
MANY = robots(RANDOM, 4)
POSES = poses(RANDOM, 4)
SHIFT = np.array([1.0, 0, 0])
LEGS = [LinearMotion(LEFT, LEFT + SHIFT, 0.1), LinearMotion(RIGHT - SHIFT, RIGHT, 0.1)]


def test_no_path_jumps_through_a_wall() -> None:
    with pytest.raises(ContinuumError) as raised:
        MotionPath(LEGS)
    assert (raised.value.kind, raised.value.index, raised.value.robot) == ("motions_apart", 1, None)
    text = str(raised.value)
    assert text.startswith("motion 1 of `motions` begins 15.99") and "let each motion begin where the previous one ends" in text
    through = MotionPath([LEGS[0], LinearMotion(LEFT + SHIFT, RIGHT - SHIFT, 0.1), LEGS[1]])
    assert not WALL.clears_motion(through, margin=0.0, resolution=0.01).is_clear
    assert WALL.prove_motion(through, margin=0.0, resolution=0.01) is None


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (LinearMotion(MANY, MANY + 1, 0.1), LinearMotion(MANY + 1, MANY, 0.1)),
        (LinearMotion(MANY[0], MANY[0] + 1, 0.1, caps="capsules"), LinearMotion(MANY[0] + 1, MANY[0], 0.1, caps="capsules")),
        (RigidMotion(MANY[0], 0.1, POSES, POSES[1]), RigidMotion(MANY[0], 0.1, POSES[1], POSES[::-1])),
        (RigidMotion.of_curve(MANY, 0.1, POSES, POSES[1]), RigidMotion.of_curve(MANY, 0.1, POSES[1], POSES)),
        (BendingMotion([[9, 0, 0]], [[8, 0.1, 0]], 0.1), BendingMotion([[8, 0.1, 0]], [[9, 0, 0.1]], 0.1)),
        (
            MovingBase(BendingMotion([[9, 0, 0]], [[8, 0.1, 0]], 0.1), POSES, POSES[1]),
            RigidMotion.of_curve([[0, 0, 0], [0, 0, 1]], 0.1, POSES[1], POSES),
        ),
    ],
)
def test_what_meets_is_joined_and_what_is_apart_is_not(first: Any, second: Any) -> None:
    shifted = [second, MovingBase(second, np.eye(4), np.eye(4))]
    if isinstance(first, MovingBase):
        with pytest.raises(ContinuumError) as raised:
            MotionPath([first, second])
        assert raised.value.kind == "motions_apart"
        return
    for behind in shifted:
        verify_motion(MotionPath([first, behind]), 8)
    off = np.eye(4)
    off[1, 3] = 1e-9
    with pytest.raises(ContinuumError, match="motion 1 of `motions` begins") as raised:
        MotionPath([first, MovingBase(second, off, off)])
    assert raised.value.kind == "motions_apart"
    assert raised.value.robot == (None if first.count is None else 0)


def test_of_a_batch_the_one_that_jumps_is_named() -> None:
    start = MANY.copy()
    start[2, 3, 0] += 1e-6
    with pytest.raises(ContinuumError, match="robot 2: motion 2 of `motions`") as raised:
        MotionPath([LinearMotion(MANY, MANY, 0.1), LinearMotion(MANY, MANY, 0.1), LinearMotion(start, MANY, 0.1)])
    assert (raised.value.robot, raised.value.index) == (2, 2)
    empty = LinearMotion(MANY[:0], MANY[:0], 0.1)
    assert MotionPath([empty, empty]).count == 0
    verify_motion(MotionPath([empty, empty]), 3)


def test_sections_stay_the_same() -> None:
    with pytest.raises(ContinuumError, match="other sections, radii or faces") as raised:
        MotionPath([LinearMotion(LEFT, LEFT, 0.1), LinearMotion(LEFT, LEFT, 0.2)])
    assert raised.value.kind == "sections_change"


def test_paths_of_two_robots() -> None:
    there_and_back = MotionPath([LEGS[0], LinearMotion(LEFT + SHIFT, LEFT, 0.1)])
    at_rest = LinearMotion(LEFT - SHIFT, LEFT - SHIFT, 0.1)
    for motions in ((there_and_back, at_rest), (at_rest, there_and_back)):
        assert RobotPair().clears_motions(*motions, margin=0.7, resolution=0.01).is_clear
    assert SelfQuery().clears_motion(there_and_back, margin=0.1, resolution=0.01).is_clear


@pytest.mark.parametrize(
    ("ask", "error", "text"),
    [
        (lambda: MotionPath([LEGS[0], 3]), TypeError, "motions"),
        (lambda: MotionPath(LEGS[0]), TypeError, "motions"),
        (lambda: verify_motion(3, 8), TypeError, "motion"),
        (lambda: verify_motion(LEGS[0], 0), TypeError, "`steps` is 0; give a whole number from 1"),
        (lambda: verify_motion(LEGS[0], -1), TypeError, "`steps` is -1; give a whole number from 1"),
        (lambda: verify_motion(LEGS[0], 10**30), TypeError, "`steps` is .*; give a whole number"),
        (lambda: verify_motion(LEGS[0], 8.5), TypeError, "`steps` is .*; give a whole number"),
        (lambda: verify_motion(LEGS[0], "8"), TypeError, "`steps` is .*; give a whole number"),
    ],
)
def test_wrong_types(ask: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        ask()
