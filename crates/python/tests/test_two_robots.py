"""Robots against each other and against themselves, beside numpy's distances between segments."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import ContinuumError, between, clears_between, self_clears, self_minimum
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
    found = between(a, RADIUS, b, RADIUS, caps="capsules")
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
    all_pairs = between(a, RADIUS, b, 0.1, pose_a=pose_a, pose_b=pose_b)
    margin = float(np.median(all_pairs.distance))
    clears = clears_between(a, RADIUS, b, 0.1, margin, pose_a=pose_a, pose_b=pose_b)
    assert_array_equal(clears, all_pairs.distance > margin)
    first_and_all = between(a[0], RADIUS, b, 0.1, pose_a=pose_a[0], pose_b=pose_b)
    all_and_first = between(b, 0.1, a[0], RADIUS, pose_a=pose_b, pose_b=pose_a[0])
    for k in range(30):
        one = between(a[k], RADIUS, b[k], 0.1, pose_a=pose_a[k], pose_b=pose_b[k])
        for field, fields in zip(one, all_pairs):
            assert_array_equal(field, fields[k])
        one = between(a[0], RADIUS, b[k], 0.1, pose_a=pose_a[0], pose_b=pose_b[k])
        for field, fields in zip(one, first_and_all):
            assert_array_equal(field, fields[k])
    np.testing.assert_allclose(first_and_all.distance, all_and_first.distance, rtol=0, atol=1e-14)


def test_itself() -> None:
    angle = np.linspace(0, 1.9 * np.pi, 60)
    ring = 5 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    found = self_minimum(ring, RADIUS, caps="capsules")
    gap = np.linalg.norm(ring[0] - ring[-1]) - 2 * RADIUS
    assert abs(found.distance - gap) < 1e-12
    assert_array_equal(np.sort(found.segments), [0, 58])
    straight = np.linspace([0, 0, 0], [9, 0, 0], 60)
    none = self_minimum(straight, RADIUS)
    assert none.distance == np.inf and (none.segments == -1).all() and np.isnan(none.on_first).all()
    both = np.stack([ring, straight] * 20)
    distances = self_minimum(both, RADIUS, caps="capsules").distance
    assert_array_equal(distances, [found.distance, np.inf] * 20)
    for margin in (gap - 0.01, gap + 0.01):
        assert_array_equal(self_clears(both, RADIUS, margin, caps="capsules"), distances > margin)
        assert self_clears(ring, RADIUS, margin, caps="capsules") is bool(found.distance > margin)


def test_segments_are_the_inputs() -> None:
    """Where points are repeated, too."""
    a = np.array([[0, 0, 0], [0, 0, 0], [0, 0, 4], [0, 0, 4], [0, 0, 8], [4, 0, 12], [4, 0, 12.0]])
    for height, segment in [(1, 1), (5, 3)]:
        found = between(a, RADIUS, [[-3, -1, height], [-3, 1, height]], RADIUS)
        assert_array_equal(found.segments, [segment, 0])


@pytest.mark.parametrize(
    ("ask", "kind", "text"),
    [
        (lambda r: between(r[:3], 0.1, r[:4], 0.1), "bad_shape", "there are 3 robots beside 4"),
        (lambda r: between(r[0], 0.1, r[1].T, 0.1), "bad_shape", "`points_b`"),
        (lambda r: between(r[0], 0.1, r[1], 0.1, pose_b=np.diag([2, 2, 2, 1])), "scales", "scales by 2"),
        (lambda r: clears_between(r[0], 0.1, r[1], 0.1, -1.0), "negative", "`margin`"),
        (lambda r: between(r[0], -0.1, r[1], 0.1), "bad_radius", "radius 0"),
        (lambda r: self_minimum([[0, 0, 0], [0, 0, 1], [0, 0.1, 0]], 0.5), "joint_too_sharp", "joint"),
        (lambda r: self_clears(r, 0.1, np.nan), "negative", "`margin`"),
    ],
)
def test_refused(ask: object, kind: str, text: str) -> None:
    with pytest.raises(ContinuumError, match=text) as raised:
        ask(robots(np.random.default_rng(0), 5))  # type: ignore[operator]
    assert raised.value.kind == kind
