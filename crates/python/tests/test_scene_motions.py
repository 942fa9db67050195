"""Motions and tubes in a scene, against the questions about each mesh and pair."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from parry_continuum import (
    ContinuumError,
    Decision,
    LinearMotion,
    Mesh,
    Motion,
    MovingBase,
    RigidMotion,
    RobotPair,
    Scene,
    SelfQuery,
)

RESOLUTION = 1e-3
SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=float)
FACES = [[0, 1, 2], [0, 2, 3]]
POSES = [np.eye(4), np.array([[0, -1, 0, 2.0], [1, 0, 0, 1.0], [0, 0, 1, 1.5], [0, 0, 0, 1]])]
MARGINS = [0.2, 0.0]


def scene(robot_margin: float | None = None, self_margin: float | None = None) -> Scene:
    made = Scene(robot_margin=robot_margin, self_margin=self_margin)
    for place, (pose, margin) in enumerate(zip(POSES, MARGINS)):
        made.add(f"square {place}", Mesh(SQUARE, FACES), margin=margin, pose=pose)
    made.add("target", Mesh(SQUARE, FACES), margin=None)
    return made


def edges(count: int, seed: int) -> tuple[list[LinearMotion], list[LinearMotion]]:
    """Two robots of three links each, at both ends of each edge."""
    random = np.random.default_rng(seed)
    robots = []
    for _ in range(2):
        starts = random.uniform(-2, 2, (count, 1, 3)) + np.array([[0, 0, 0], [0, 0, 0.8], [0.3, 0, 1.6], [0.3, 0.5, 2.2]])
        ends = starts + random.uniform(-0.7, 0.7, (count, 1, 3)) + random.uniform(-0.1, 0.1, (count, 4, 3))
        robots.append([LinearMotion(start, end, 0.1, caps="capsules") for start, end in zip(starts, ends)])
    return robots[0], robots[1]


def singles(a: Motion, b: Motion, between: float, itself: float) -> list[Decision]:
    """The decisions of all single questions, in order."""
    found = []
    for pose, margin in zip(POSES, MARGINS):
        for motion in (a, b):
            seen = MovingBase(motion, np.linalg.inv(pose), np.linalg.inv(pose))
            found.append(Mesh(SQUARE, FACES).clears_motion(seen, margin=margin, resolution=RESOLUTION).decision)
    found.append(RobotPair().clears_motions(a, b, margin=between, resolution=RESOLUTION).decision)
    for motion in (a, b):
        found.append(SelfQuery().clears_motion(motion, margin=itself, resolution=RESOLUTION).decision)
    return found


def test_a_scene_decides_as_the_single_questions() -> None:
    asked = scene(robot_margin=0.3, self_margin=0.1)
    seen = set()
    for a, b in zip(*edges(60, 1)):
        expected = singles(a, b, 0.3, 0.1)
        found = asked.clears_motion([a, b], resolution=RESOLUTION)
        if Decision.CONTACT in expected:
            assert found.decision is Decision.CONTACT
            names = [(0, [0, -1]), (0, [1, -1]), (1, [0, -1]), (1, [1, -1]), (-1, [0, 1]), (-1, [0, 0]), (-1, [1, 1])]
            touching = [name for name, decision in zip(names, expected) if decision is Decision.CONTACT]
            assert (found.structure, found.robots.tolist()) in touching
            # Structures come first, then pairs, then each robot and itself.
            assert (found.structure >= 0) == (touching[0][0] >= 0)
            assert np.linalg.norm(found.on_first - found.on_second) <= found.upper + 1e-9
            assert found.interval.tolist() == [0, found.t]
            when = asked.time_of_contact([a, b], resolution=RESOLUTION)
            assert when.decision is Decision.CONTACT and when.t <= found.t + 1e-2
            assert when.interval[0] <= when.t == when.interval[1]
        else:
            assert found.decision in (Decision.CLEAR, Decision.UNDECIDED)
            assert found.structure == -1 and np.isnan(found.t) and np.isnan(found.on_first).all()
        assert found.is_clear == all(decision is Decision.CLEAR for decision in expected)
        seen.add(found.decision)
    assert {Decision.CLEAR, Decision.CONTACT} <= seen


def test_the_least_slack_is_that_of_the_single_questions() -> None:
    asked, places = scene(robot_margin=0.3), set()
    for a, b in zip(*edges(40, 2)):
        found = asked.clearance_of_motion([a, b], tolerance=1e-3)
        slacks = []
        for pose, margin in zip(POSES, MARGINS):
            for motion in (a, b):
                seen = MovingBase(motion, np.linalg.inv(pose), np.linalg.inv(pose))
                one = Mesh(SQUARE, FACES).clearance_of_motion(seen, tolerance=1e-6)
                slacks.append([one.lower - margin, one.upper - margin])
        both = RobotPair().clearance_of_motion(a, b, tolerance=1e-6)
        slacks.append([both.lower - 0.3, both.upper - 0.3])
        least = np.min(slacks, axis=0)
        assert found.resolved and found.upper - found.lower <= 1e-3
        assert found.lower <= least[1] + 1e-9 and least[0] <= found.upper + 1e-9
        places.add(int(found.structure))
    assert len(places) > 1


def test_a_batch_answers_as_one_by_one_and_names_what_is_refused() -> None:
    asked = scene(robot_margin=0.3, self_margin=0.1)
    a, b = edges(20, 3)
    starts = np.stack([[[x, 0.0, 1.0], [x, 0.0, 2.0], [x, 0.4, 1.1 if x == 5 else 3.0]] for x in range(20)])
    batch = LinearMotion(starts, starts + [0, 0, 0.2], 0.3)
    found = asked.clears_motion([batch, a[0]], resolution=RESOLUTION)
    assert found.decision.shape == (20,) and found.robots.shape == (20, 2)
    for place, start in enumerate(starts):
        one = LinearMotion(start, start + [0, 0, 0.2], 0.3)
        if place == 5:
            assert found.status[place] == "joint_too_sharp" and found.decision[place] is Decision.UNDECIDED
            with pytest.raises(ContinuumError, match=r"^`motions\[0\]`: ") as refused:
                asked.clears_motion([one, a[0]], resolution=RESOLUTION)
            assert refused.value.kind == "joint_too_sharp"
            continue
        alone = asked.clears_motion([one, a[0]], resolution=RESOLUTION)
        assert found.status[place] == alone.status == ""
        for name in ("decision", "interval", "t", "structure", "robots", "on_first"):
            np.testing.assert_array_equal(getattr(found, name)[place], getattr(alone, name))
    assert asked.clearance_of_motion([batch, b[0]], tolerance=0.1).lower.shape == (20,)


def test_structures_move_meanwhile() -> None:
    asked = Scene()
    asked.add("square", Mesh(SQUARE, FACES), margin=0.5)
    waits = RigidMotion([[0, 0, 3], [0, 0, 5]], 0.25, np.eye(4), np.eye(4))
    for height, is_clear in [(2.0, True), (2.6, False)]:
        pose = np.eye(4)
        pose[2, 3] = height
        for end in (pose, SQUARE + [0, 0, height]):
            found = asked.clears_motion_while({0: end}, [waits], resolution=RESOLUTION)
            assert found.is_clear == is_clear
            if not is_clear:
                # The flat end is at 3, and the square at the height times t.
                assert found.t >= 2.5 / height - 1e-6 and abs(found.on_second[2] - height * found.t) < 1e-9
    for bad in ({0: SQUARE[:3]}, {1: np.eye(4)}, {0: 2 * np.eye(4)}, {"square": np.eye(4)}):
        with pytest.raises(ContinuumError):
            asked.clears_motion_while(bad, [waits], resolution=RESOLUTION)  # type: ignore[arg-type]


def test_tubes_are_bounded_and_decided() -> None:
    asked = Scene(robot_margin=0.5)
    asked.add("square", Mesh(SQUARE, FACES), margin=0.5)
    robots = [(np.array([[0, 0, 2], [0, 0, 4]]), 0.25), (np.array([[2, 0, 2], [3, 0, 2]]), 0.25)]
    found = asked.clearance(robots, tolerance=1e-3)
    # 2 - 0.5 from the square; 2 - 0.25 - 0.5 from one another.
    assert found.lower <= 1.25 <= found.upper <= found.lower + 1e-3
    assert found.structure == -1 and found.robots.tolist() == [0, 1]
    assert asked.clears_tube(robots, resolution=1e-3) is Decision.CLEAR
    low = [(np.array([[0, 0, 0.4], [0, 0, 4]]), 0.25), robots[1]]
    assert asked.clears_tube(low, resolution=1e-3) is Decision.CONTACT
    assert np.isinf(Scene().clearance(robots, tolerance=1e-3).lower)


def test_what_is_refused_as_a_whole() -> None:
    asked, (a, _) = scene(), edges(1, 4)
    for motions, resolution, kind in [([], 1e-3, "bad_type"), ([a[0]], -1.0, "negative"), ([a[0]], np.nan, "negative")]:
        with pytest.raises(ContinuumError) as refused:
            asked.clears_motion(motions, resolution=resolution)
        assert refused.value.kind == kind
    with pytest.raises(ContinuumError) as refused:
        Scene().clears_motion([a[0]], resolution=1e-3)
    assert refused.value.kind == "no_margin"
    with pytest.raises(ContinuumError):
        Scene(self_margin=-1.0)
    two, three = (LinearMotion(np.zeros((n, 2, 3)) + [[0, 0, 2], [0, 0, 3]], np.ones((n, 2, 3)), 0.1) for n in (2, 3))
    with pytest.raises(ContinuumError, match=r"motions\[1\]"):
        asked.clears_motion([two, three], resolution=1e-3)


def test_a_copy_keeps_the_margin_of_robots_to_themselves() -> None:
    asked = Scene(self_margin=0.7)
    hairpin = np.array([[0, 0, 0], [0, 0, 9], [1, 0, 9], [1, 0, 0]], dtype=float)
    for one in (asked, copy.copy(asked), copy.deepcopy(asked), pickle.loads(pickle.dumps(asked))):
        assert one.clears([(hairpin, 0.2)], caps="capsules") is False
        moved = LinearMotion(hairpin, hairpin, 0.2, caps="capsules")
        assert one.clears_motion([moved], resolution=1e-3).robots.tolist() == [0, 0]
    assert Scene(self_margin=0.5).clears([(hairpin, 0.2)], caps="capsules") is True


def test_a_margin_to_themselves_by_arc_length() -> None:
    # Inner edges of an arc of radius 10 by discs of radius 2 are 16 sin(arc / 20) apart.
    angle = np.radians(np.arange(151))
    bend = np.stack([10 * np.cos(angle), 0 * angle, 10 * np.sin(angle)], axis=1)
    expected = 16 * np.sin(0.7)
    for margin, clears in [(0.99 * expected, True), (1.01 * expected, False)]:
        asked = Scene(self_margin=margin, self_arc=14.0)
        for one in (asked, copy.copy(asked), copy.deepcopy(asked), pickle.loads(pickle.dumps(asked))):
            assert one.clears([(bend, 2.0)]) is clears
            assert one.clears_tube([(bend, 2.0)], resolution=1e-3).is_clear is clears
        assert Scene(self_margin=margin).clears([(bend, 2.0)]) is True
    with pytest.raises(ContinuumError) as refused:
        asked.clears_motion([LinearMotion(bend, bend, 2.0)], resolution=1e-3)
    assert refused.value.kind == "self_arc_of_motion"
    for wrong in (-1.0, np.nan):
        with pytest.raises(ContinuumError, match="self_arc"):
            Scene(self_margin=1.0, self_arc=wrong)
