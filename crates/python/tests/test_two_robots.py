"""Two robots, and one robot and itself, beside numpy's distances between segments."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import (
    ContinuumError,
    Decision,
    LinearMotion,
    MotionPath,
    RigidMotion,
    RobotPair,
    SelfQuery,
)
from shapes import Array, poses, robots

RADIUS = 0.2


def to_axis(points: Array, start: Array, end: Array) -> Array:
    along = end - start
    share = np.clip((points - start) @ along / (along @ along), 0, 1)
    return np.linalg.norm(points - start - share[:, None] * along, axis=1)


def sampled(a: Array, b: Array) -> tuple[float, float]:
    """Of capsules: no more than the first number, and no less than the second."""
    share = np.linspace(0, 1, 200)[:, None]
    least = min(
        to_axis(p + share * (q - p), s, e).min() for p, q in zip(a[:-1], a[1:]) for s, e in zip(b[:-1], b[1:])
    )
    step = np.linalg.norm(np.diff(a, axis=0), axis=1).max() / 199
    return max(0.0, least - 2 * RADIUS), max(0.0, least - step - 2 * RADIUS)


def test_two_robots_beside_samples() -> None:
    random = np.random.default_rng(41)
    a, b = robots(random, 20, points=5), robots(random, 20, points=6)
    found = RobotPair().minimum(a, RADIUS, b, RADIUS, caps="capsules")
    touching = 0
    for k in range(20):
        most, least = sampled(a[k], b[k])
        touching += found.distance[k] == 0
        assert least - 1e-12 <= found.distance[k] <= most + 1e-12
        ends = found.on_first[k] - found.on_second[k]
        assert abs(np.linalg.norm(ends) - found.distance[k]) < 1e-12
        for robot, point, segment, length in [
            (a[k], found.on_first[k], *np.array([found.segments[k], found.arc_lengths[k]])[:, 0]),
            (b[k], found.on_second[k], *np.array([found.segments[k], found.arc_lengths[k]])[:, 1]),
        ]:
            start, end = robot[int(segment)], robot[int(segment) + 1]
            assert to_axis(point[None], start, end)[0] <= RADIUS + 1e-12
            before = np.linalg.norm(np.diff(robot[: int(segment) + 1], axis=0), axis=1).sum()
            assert before - 1e-12 <= length <= before + np.linalg.norm(end - start) + 1e-12
    assert touching < 15


def test_one_and_many() -> None:
    random = np.random.default_rng(42)
    a, b, pose_a, pose_b = robots(random, 30), robots(random, 30), poses(random, 30), poses(random, 30)
    all_pairs = RobotPair().minimum(a, RADIUS, b, 0.1, pose_a=pose_a, pose_b=pose_b)
    margin = float(np.median(all_pairs.distance))
    clears = RobotPair().clears(a, RADIUS, b, 0.1, margin=margin, pose_a=pose_a, pose_b=pose_b)
    assert_array_equal(clears, all_pairs.distance > margin)
    first_and_all = RobotPair().minimum(a[0], RADIUS, b, 0.1, pose_a=pose_a[0], pose_b=pose_b)
    all_and_first = RobotPair().minimum(b, 0.1, a[0], RADIUS, pose_a=pose_b, pose_b=pose_a[0])
    for k in range(30):
        one = RobotPair().minimum(a[k], RADIUS, b[k], 0.1, pose_a=pose_a[k], pose_b=pose_b[k])
        for field, fields in zip(one, all_pairs):
            assert_array_equal(field, fields[k])
        one = RobotPair().minimum(a[0], RADIUS, b[k], 0.1, pose_a=pose_a[0], pose_b=pose_b[k])
        for field, fields in zip(one, first_and_all):
            assert_array_equal(field, fields[k])
    np.testing.assert_allclose(first_and_all.distance, all_and_first.distance, rtol=0, atol=1e-14)


def test_itself() -> None:
    angle = np.linspace(0, 1.9 * np.pi, 60)
    ring = 5 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    found = SelfQuery().minimum(ring, RADIUS, caps="capsules")
    gap = np.linalg.norm(ring[0] - ring[-1]) - 2 * RADIUS
    assert abs(found.distance - gap) < 1e-12
    assert_array_equal(np.sort(found.segments), [0, 58])
    straight = np.linspace([0, 0, 0], [9, 0, 0], 60)
    none = SelfQuery().minimum(straight, RADIUS)
    assert none.distance == np.inf and (none.segments == -1).all() and np.isnan(none.on_first).all()
    both = np.stack([ring, straight] * 20)
    distances = SelfQuery().minimum(both, RADIUS, caps="capsules").distance
    assert_array_equal(distances, [found.distance, np.inf] * 20)
    for margin in (gap - 0.01, gap + 0.01):
        assert_array_equal(SelfQuery().clears(both, RADIUS, margin=margin, caps="capsules"), distances > margin)
        assert SelfQuery().clears(ring, RADIUS, margin=margin, caps="capsules") is bool(found.distance > margin)


def test_segments_are_the_inputs() -> None:
    """Where points are repeated, too."""
    a = np.array([[0, 0, 0], [0, 0, 0], [0, 0, 4], [0, 0, 4], [0, 0, 8], [4, 0, 12], [4, 0, 12.0]])
    for height, segment in [(1, 1), (5, 3)]:
        found = RobotPair().minimum(a, RADIUS, [[-3, -1, height], [-3, 1, height]], RADIUS)
        assert_array_equal(found.segments, [segment, 0])


def test_pairs_remember_and_answer_alike() -> None:
    random = np.random.default_rng(43)
    a, b, pose = robots(random, 30), robots(random, 30), poses(random, 30)
    pair, query = RobotPair(), SelfQuery()
    given = (a, RADIUS, b, 0.1)
    for _ in range(2):
        for field, expected in zip(pair.minimum(*given, pose_b=pose), RobotPair().minimum(*given, pose_b=pose)):
            assert_array_equal(field, expected)
        for k in range(30):
            one = pair.minimum(a[k], RADIUS, b[k], 0.1, pose_b=pose[k])
            assert one.distance == RobotPair().minimum(a[k], RADIUS, b[k], 0.1, pose_b=pose[k]).distance
        margin = float(np.median(RobotPair().minimum(*given).distance))
        assert_array_equal(pair.clears(*given, margin=margin), RobotPair().clears(*given, margin=margin))
        assert_array_equal(query.minimum(a, RADIUS).distance, SelfQuery().minimum(a, RADIUS).distance)
        assert_array_equal(query.clears(a, RADIUS, margin=0.1), SelfQuery().clears(a, RADIUS, margin=0.1))
        pair.forget()
        query.forget()


def test_each_segment() -> None:
    """That of the first robot by itself; without length it has none."""
    random = np.random.default_rng(44)
    a, b, pose = robots(random, 20, points=7), robots(random, 20, points=5), poses(random, 20)
    a[::4, 3] = a[::4, 2]
    found = RobotPair().per_link(a, RADIUS, b, RADIUS, pose_a=pose, caps="capsules")
    assert found.distance.shape == (20, 6) and found.on_first.shape == (20, 6, 3) and found.segments.shape == (20, 6, 2)
    for k in range(20):
        for segment in range(6):
            if k % 4 == 0 and segment == 2:
                assert np.isnan(found.distance[k, segment]) and (found.segments[k, segment] == -1).all()
                continue
            alone = RobotPair().minimum(a[k, segment : segment + 2], RADIUS, b[k], RADIUS, pose_a=pose[k], caps="capsules")
            assert abs(found.distance[k, segment] - alone.distance) < 1e-12
            assert found.segments[k, segment].tolist() == [segment, alone.segments[1]] or alone.distance == 0
    least = RobotPair().minimum(a, RADIUS, b, RADIUS, pose_a=pose, caps="capsules").distance
    assert_array_equal(np.nanmin(found.distance, axis=1), least)
    one = RobotPair().per_link(a[1], RADIUS, b[1], RADIUS, pose_a=pose[1], caps="capsules")
    for field, fields in zip(one, found):
        assert_array_equal(field, fields[1])


def test_every_place() -> None:
    """Pairs of segments of which no neighbours are closer, by all pairs of segments."""
    random = np.random.default_rng(45)
    a, b = np.cumsum(random.normal(size=(2, 20, 8, 3)), axis=2)
    found, margin, several = RobotPair().contacts_within(a, 0.1, b, 0.1, margin=3.0, caps="capsules"), 3.0, 0
    for k in range(20):
        distance = np.array(
            [[RobotPair().minimum(a[k, i : i + 2], 0.1, b[k, j : j + 2], 0.1, caps="capsules").distance for j in range(7)] for i in range(7)]
        )
        padded = np.pad(distance, 1, constant_values=np.inf)
        around = np.stack([padded[1 + i : 8 + i, 1 + j : 8 + j] for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)])
        rows = slice(*found.offsets[k : k + 2])
        assert (found.pair[rows] == k).all()
        places = {(int(i), int(j)) for i, j in found.segments[rows]}
        # Where neighbours are as close, up to rounding, one stands for all.
        strict = {(int(i), int(j)) for i, j in np.argwhere((distance < around.min(axis=0) - 1e-12) & (distance <= margin))}
        loose = {(int(i), int(j)) for i, j in np.argwhere((distance <= around.min(axis=0) + 1e-12) & (distance <= margin))}
        assert strict <= places <= loose and len(places) == len(found.segments[rows])
        np.testing.assert_allclose(found.distance[rows], [distance[i, j] for i, j in found.segments[rows]], atol=1e-12)
        assert bool(places) == (distance.min() <= margin)
        several += len(places) > 1
    assert several > 0 and 0 < len(found.distance)


def test_both_move() -> None:
    random = np.random.default_rng(8)
    ends = random.uniform(-3, 3, (2, 2, 40, 4, 3))
    ends[1] += [2.5, 0, 0]
    first, second = (LinearMotion(*way, 0.3) for way in ends)
    pair, steps = RobotPair(), np.linspace(0, 1, 201)
    found = pair.clears_motions(first, second, margin=0.2, resolution=1e-3)
    assert set(found.decision) == {Decision.CLEAR, Decision.CONTACT}
    for place in range(40):
        alone = pair.clears_motions(*(LinearMotion(*way[:, place], 0.3) for way in ends), margin=0.2, resolution=1e-3)
        assert alone.decision is Decision(found.decision[place])
        for one, of_all in zip(alone[1:], found[1:]):
            assert_array_equal(one, of_all[place])
        a, b = (start + steps[:, None, None] * (end - start) for start, end in ends[:, :, place])
        distances = RobotPair().minimum(a, 0.3, b, 0.3).distance
        if alone.decision is Decision.CLEAR:
            assert distances.min() > 0.2
        else:
            a, b = (start + alone.t * (end - start) for start, end in ends[:, :, place])
            assert RobotPair().minimum(a, 0.3, b, 0.3).distance <= alone.upper <= 0.2
            assert np.linalg.norm(alone.on_first - alone.on_second) <= alone.upper + 1e-12
            # Steps come as near, but for what moves between two of them.
            most = sum(np.abs(end - start).max() for start, end in ends[:, :, place]) * 3**0.5
            assert distances.min() <= 0.2 + most / 400
    # One beside all of a batch, and a path of them.
    one = LinearMotion(*ends[0][:, 0], 0.3)
    beside = pair.clears_motions(one, second, margin=0.2, resolution=1e-3)
    assert beside.decision.shape == (40,) and beside.decision[0] == found.decision[0]
    there_and_back = MotionPath([one, LinearMotion(*ends[0][::-1, 0], 0.3)])
    still = RigidMotion(ends[1][0, 0], 0.3, np.eye(4), np.eye(4))
    answers = {pair.clears_motions(moving, still, margin=0.2, resolution=1e-3).decision for moving in (one, there_and_back)}
    assert len(answers) == 1


@pytest.mark.parametrize("caps", ["fitted", "capsules", "cylinders"])
def test_answers_have_proofs(caps: Literal["fitted", "capsules", "cylinders"]) -> None:
    random = np.random.default_rng(10)
    points = random.uniform(-3, 3, (2, 50, 4, 3))
    points[1] += [2.0, 0, 0]
    points[0, :, 2] = points[0, :, 1]  # a segment without length
    pose, pair = poses(random, 50), RobotPair()
    given = points[0], 0.3, points[1], 0.2
    for ask in (pair.minimum, pair.per_link):
        found = ask(*given, pose_b=pose, caps=caps)
        proof = pair.certify(*given, found, pose_b=pose, caps=caps)
        assert np.shape(proof.lower) == np.shape(found.distance)
        assert_array_equal(np.isnan(proof.lower), np.isnan(found.distance))
        known = ~np.isnan(found.distance)
        lower, distance, upper = (np.asarray(of)[known] for of in (proof.lower, found.distance, proof.upper))
        assert (upper - lower < 1e-13).all() and (abs(distance - lower) < 1e-13).all() and (lower > 0).sum() > 20
        alone = pair.certify(*(robot[0] if np.ndim(robot) else robot for robot in given), ask(
            *(robot[0] if np.ndim(robot) else robot for robot in given), pose_b=pose[0], caps=caps
        ), pose_b=pose[0], caps=caps)
        assert_array_equal(alone.lower, np.asarray(proof.lower)[0])
    for wrong, text in [
        (found._replace(segments=found.segments[:3]), "shape"),
        (found._replace(segments=found.segments + 7), "link"),
        (None, "segments"),
    ]:
        with pytest.raises(ContinuumError, match=text):
            pair.certify(*given, wrong, pose_b=pose, caps=caps)  # type: ignore[arg-type]


def test_a_robot_moves_beside_itself() -> None:
    random = np.random.default_rng(9)

    def hairpins() -> Array:
        tips = random.uniform([1, -8, 1], [7, 8, 12], (40, 3))
        fixed = [[0, 0, 0], [0, 0, 30], [3, 0, 33], [6, 0, 30]]
        return np.concatenate([np.broadcast_to(fixed, (40, 4, 3)), tips[:, None]], axis=1)

    starts, ends = hairpins(), hairpins()
    swings, query, steps = LinearMotion(starts, ends, 0.5), SelfQuery(), np.linspace(0, 1, 201)
    found = query.clears_motion(swings, margin=1.5, resolution=1e-3)
    assert {Decision.CLEAR, Decision.CONTACT} <= set(found.decision)
    for place, (start, end) in enumerate(zip(starts, ends)):
        alone = SelfQuery().clears_motion(LinearMotion(start, end, 0.5), margin=1.5, resolution=1e-3)
        assert alone.decision is Decision(found.decision[place])
        for one, of_all in zip(alone[1:], found[1:]):
            assert_array_equal(one, of_all[place])
        clear = SelfQuery().clears(start + steps[:, None, None] * (end - start), 0.5, margin=1.5)
        if alone.decision is Decision.CLEAR:
            assert clear.all()
        elif alone.decision is Decision.CONTACT:
            assert SelfQuery().minimum(start + alone.t * (end - start), 0.5).distance <= alone.upper <= 1.5
            assert np.linalg.norm(alone.on_first - alone.on_second) <= alone.upper + 1e-12
    with pytest.raises(ContinuumError) as caught:
        SelfQuery().clears_motion(swings, margin=-1.0, resolution=1e-3)
    assert caught.value.kind == "negative"


@pytest.mark.parametrize(
    ("ask", "kind", "text"),
    [
        (lambda r: RobotPair().contacts_within(r[0], 0.1, r[1], 0.1, margin=-1.0), "negative", "`margin`"),
        (lambda r: RobotPair().per_link(r[:3], 0.1, r[:4], 0.1), "bad_shape", "`points_a` has 3 robots and `points_b` 4"),
        (lambda r: RobotPair().minimum(r[0], -0.1, r[1], 0.1), "bad_radius", "radius 0"),
        (lambda r: RobotPair().minimum(r[:3], 0.1, r[:4], 0.1), "bad_shape", "`points_a` has 3 robots and `points_b` 4"),
        (lambda r: RobotPair().minimum(r[0], 0.1, r[1].T, 0.1), "bad_shape", "`points_b`"),
        (lambda r: RobotPair().minimum(r[0], 0.1, r[1], 0.1, pose_b=np.diag([2, 2, 2, 1])), "scales", "scales by 2"),
        (lambda r: RobotPair().clears(r[0], 0.1, r[1], 0.1, margin=-1.0), "negative", "`margin`"),
        (lambda r: SelfQuery().minimum([[0, 0, 0], [0, 0, 1], [0, 0.1, 0]], 0.5), "joint_too_sharp", "joint"),
        (lambda r: SelfQuery().clears(r, 0.1, margin=np.nan), "negative", "`margin`"),
    ],
)
def test_refused(ask: object, kind: str, text: str) -> None:
    with pytest.raises(ContinuumError, match=text) as raised:
        ask(robots(np.random.default_rng(0), 5))  # type: ignore[operator]
    assert raised.value.kind == kind


def test_by_arc_length() -> None:
    straight = np.stack([[k, 0.0, 0.0] for k in range(11)])
    query = SelfQuery()
    found = query.minimum_beyond(straight, RADIUS, arc=4.0)
    assert abs(found.lower - 4) < 1e-9 and abs(found.upper - 4) < 1e-9 and found.resolved
    assert abs(found.arc_lengths[1] - found.arc_lengths[0] - 4) < 1e-9
    short = query.minimum_beyond(straight, RADIUS, arc=11.0)
    assert short.lower == short.upper == np.inf and short.resolved and np.isnan(short.on_first).all()
    # Inner edges of a circle of radius 5 at an arc of 4 are 2 (5 - RADIUS) sin(0.4) apart.
    angle = np.linspace(0, 2, 200)
    circle = 5 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    expected, ends = 2 * (5 - RADIUS) * np.sin(0.4), [[0, 1, 0], [-np.sin(2), np.cos(2), 0]]
    chain = query.minimum_beyond(circle, RADIUS, arc=4.0)
    tube = query.clearance_beyond(circle, RADIUS, arc=4.0, tolerance=0.05, tangents=ends)
    assert abs(chain.upper - expected) < 5e-3 and tube.lower - 1e-3 <= expected <= tube.upper + 1e-3
    both = query.minimum_beyond(np.stack([straight[:10], circle[:10]]), RADIUS, arc=4.0)
    assert both.lower.shape == (2,) and both.on_first.shape == (2, 3) and np.isinf(both.lower[1])
    for margin in (3.0, 3.9):
        assert query.clears_beyond(circle, RADIUS, arc=4.0, margin=margin) is bool(margin < expected)
        decided = query.clears_tube_beyond(
            circle, RADIUS, arc=4.0, margin=margin, resolution=0.01, tangents=ends
        )
        assert decided == (Decision.CLEAR if margin < expected else Decision.CONTACT)
    for arc in (-1.0, np.nan):
        with pytest.raises(ContinuumError, match="arc"):
            query.minimum_beyond(straight, RADIUS, arc=arc)
