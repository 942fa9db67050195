"""Curved tubes, given by points alone, with directions, and measured: the bounds hold for the true curve."""

from __future__ import annotations

import numpy as np
import pytest

from parry_continuum import ContinuumError, Decision, Mesh, RobotPair, SelfQuery
from shapes import Array

FLOOR = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
RADIUS = 0.5


def arc(count: int) -> tuple[Array, Array, float]:
    """Points and directions of an arc that bends down towards the floor, and its true clearance: that of its end's rim."""
    angle = np.linspace(0, 1, count)
    points = np.stack([20 * np.sin(angle), 0 * angle, 20 * np.cos(angle)], axis=1)
    tangents = np.stack([np.cos(angle), 0 * angle, -np.sin(angle)], axis=1)
    # The end's disc is across the tangent: its lowest point is below the centre by the radius times cos.
    return points, tangents, float(20 * np.cos(1) - RADIUS * np.cos(1))


@pytest.mark.parametrize("count", [20, 60])
def test_bounds_hold(count: int) -> None:
    points, tangents, true = arc(count)
    widths = []
    for given in ({}, {"tangents": tangents[[0, -1]]}, {"tangents": tangents}):
        found = FLOOR.clearance(points, RADIUS, tolerance=1e-4, **given)
        assert found.lower <= true <= found.upper
        widths.append(found.upper - found.lower)
    # Directions at the ends tell how the faces are turned, and those at all points how the curve bends between them.
    assert widths[0] > widths[1] > 3 * widths[2] and widths[2] <= 1e-4
    assert found.resolved


def test_measured_points() -> None:
    points, _, true = arc(80)
    random = np.random.default_rng(51)
    for deviation in (0.01, 0.05):
        noise = random.normal(size=points.shape)
        noise *= (deviation * random.random(80) / np.linalg.norm(noise, axis=1))[:, None]
        found = FLOOR.clearance(points + noise, RADIUS, tolerance=1e-3, deviation=deviation)
        assert found.lower <= true <= found.upper
        assert 0 < found.uncertainty
    batch = FLOOR.clearance(np.stack([points] * 20), RADIUS, tolerance=1e-3, deviation=0.01)
    one = FLOOR.clearance(points, RADIUS, tolerance=1e-3, deviation=0.01)
    assert (batch.lower == one.lower).all() and (batch.upper == one.upper).all()


def test_turns() -> None:
    """Directions of measured points are known as far as somebody states them."""
    points, _, true = arc(80)
    unknown = FLOOR.clearance(points, RADIUS, tolerance=1e-3, deviation=0.01)
    assert unknown.upper - unknown.lower > 0.9 * RADIUS
    last = 0.0
    for turn in (0.01, 0.05, 0.2):
        found = FLOOR.clearance(points, RADIUS, tolerance=1e-3, deviation=0.01, turn=turn)
        assert found.lower <= true <= found.upper
        assert last < found.upper - found.lower < unknown.upper - unknown.lower
        last = found.upper - found.lower
    margin = true - 0.25 * RADIUS
    assert FLOOR.clears_tube(points, RADIUS, margin=margin, resolution=0.01, deviation=0.01) is Decision.UNDECIDED
    assert FLOOR.clears_tube(points, RADIUS, margin=margin, resolution=0.01, deviation=0.01, turn=0.05) is Decision.CLEAR
    for turn in (-0.1, np.nan):
        with pytest.raises(ContinuumError, match="`turn`"):
            FLOOR.clearance(points, RADIUS, tolerance=0.1, turn=turn)


def test_two_tubes() -> None:
    """An arc above its mirror image in the floor is twice as far from that as from the floor: the rims of both ends."""
    points, tangents, true = arc(60)
    mirror, pair = np.array([1, 1, -1]), RobotPair()
    given = (points, RADIUS, points * mirror, RADIUS)
    random = np.random.default_rng(53)
    noise = random.normal(size=points.shape)
    noise *= (0.01 * random.random(60) / np.linalg.norm(noise, axis=1))[:, None]
    noisy = (points + noise, RADIUS, points * mirror, RADIUS)
    widths = []
    for robots_of, stated in [
        (given, {}),
        (given, {"tangents_a": tangents, "tangents_b": tangents * mirror}),
        (given, {"tangents_a": tangents[[0, -1]]}),
        (noisy, {"deviation_a": 0.01, "turn_a": 0.05, "tangents_b": tangents * mirror}),
        (noisy, {"deviation_a": 0.01, "tangents_b": tangents * mirror}),
    ]:
        for _ in range(2):  # with and without a memory
            found = pair.clearance(*robots_of, tolerance=1e-3, **stated)
            assert found.lower <= 2 * true <= found.upper
        assert np.linalg.norm(found.on_first - found.on_second) <= found.upper + 1e-12
        widths.append(found.upper - found.lower)
    assert widths[1] < widths[2] < widths[0] and widths[1] <= 1e-3 and widths[1] < widths[3] < widths[4]
    for margin, decision in [(2 * true - 0.3, Decision.CLEAR), (2 * true + 0.3, Decision.CONTACT)]:
        ends = {"tangents_a": tangents, "tangents_b": tangents * mirror}
        assert pair.clears_tubes(*given, margin=margin, resolution=0.01, **ends) is decision
    shifts = np.eye(4) + np.zeros((30, 4, 4))
    shifts[:, 2, 3] = np.linspace(0, 5, 30)
    batch = (np.stack([points] * 30), RADIUS, points * mirror, RADIUS)
    many = pair.clearance(*batch, tolerance=0.2, pose_a=shifts)
    assert (many.lower <= 2 * true + shifts[:, 2, 3]).all() and (2 * true + shifts[:, 2, 3] <= many.upper).all()
    decided = pair.clears_tubes(*batch, margin=2 * true + 2.5, resolution=0.3, pose_a=shifts)
    assert decided[0] == Decision.CONTACT and decided[-1] == Decision.CLEAR
    spoilt = np.stack([points] * 3)
    spoilt[1, 5] = np.nan
    found = pair.clearance(spoilt, RADIUS, points * mirror, RADIUS, tolerance=0.2)
    assert found.status.tolist() == ["", "point_not_finite", ""] and np.isnan(found.lower).tolist() == [False, True, False]
    for text, stated in [
        ("`tangents_b` and a deviation", {"tangents_b": tangents, "deviation_b": 0.1}),
        ("`tangents_a` has the shape", {"tangents_a": tangents[:7]}),
        ("`turn_b`", {"turn_b": -1.0}),
    ]:
        with pytest.raises(ContinuumError, match=text):
            pair.clearance(*given, tolerance=0.1, **stated)
    with pytest.raises(ContinuumError, match="`tolerance`"):
        pair.clearance(*given, tolerance=np.nan)


def test_a_coil_keeps_a_margin_to_itself() -> None:
    """Its turns are as far apart as the chords of a helix say, which are least a little before a whole turn."""
    rise, radius = 4 / (2 * np.pi), 10.0
    chords = np.linspace(6, 2 * np.pi, 100001)
    true = np.sqrt(2 * radius**2 * (1 - np.cos(chords)) + (rise * chords) ** 2).min() - 2 * RADIUS
    angle = np.linspace(0, 4 * np.pi, 401)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), rise * angle], axis=1)
    tangents = np.stack([-radius * np.sin(angle), radius * np.cos(angle), rise + 0 * angle], axis=1)
    noise = np.random.default_rng(59).normal(size=points.shape)
    noise *= 0.01 / np.linalg.norm(noise, axis=1)[:, None]
    query = SelfQuery()
    for given, ways, off in [
        (points, {"tangents": tangents[[0, -1]]}, 0.02),
        (points, {"tangents": tangents}, 0.02),
        (points + noise, {"deviation": 0.02, "turn": 0.05}, 0.2),
    ]:
        for margin, decision in [(0.0, Decision.CLEAR), (true - off, Decision.CLEAR), (true + off, Decision.CONTACT)]:
            for asked in (query, SelfQuery()):
                assert asked.clears_tube(given, RADIUS, margin=margin, resolution=0.01, **ways) is decision
    stretched = np.stack([points, points * [1, 1, 2], points * [1, 1, 0.2]])
    decided = query.clears_tube(stretched, [RADIUS] * 400, margin=true + 0.1, resolution=0.05)
    assert decided.shape == (3,) and decided.tolist() == [Decision.CONTACT, Decision.CLEAR, Decision.CONTACT]
    for kind, radius, margin, resolution in [
        ("negative", RADIUS, -1.0, 0.01),
        ("negative", RADIUS, 1.0, np.nan),
        ("bends_within_radius", 11.0, 1.0, 0.01),
    ]:
        with pytest.raises(ContinuumError) as caught:
            query.clears_tube(points, radius, margin=margin, resolution=resolution)
        assert caught.value.kind == kind


def test_what_was_asked_before_does_not_count() -> None:
    """One engine, asked in all ways in turn."""
    points, tangents, _ = arc(40)
    ways: list[dict[str, object]] = [
        {},
        {"tangents": tangents},
        {"deviation": 0.01},
        {"tangents": tangents[[0, -1]], "turn": 0.1},
        {"tangents": tangents[[0, -1]]},
        {"deviation": 0.01, "turn": 0.05},
        {"turn": 0.1},
    ]
    fresh = [Mesh(FLOOR).clearance(points, RADIUS, tolerance=1e-3, **way) for way in ways]
    for turn in range(21):
        # In an order in which each comes after each.
        way = turn * (1 + turn // 7) % 7
        found = FLOOR.clearance(points, RADIUS, tolerance=1e-3, **ways[way])
        assert (found.lower, found.upper) == (fresh[way].lower, fresh[way].upper)


def test_decisions() -> None:
    points, tangents, true = arc(40)
    for margin, decision in [(true - 0.8, Decision.CLEAR), (true + 0.8, Decision.CONTACT)]:
        assert FLOOR.clears_tube(points, RADIUS, margin=margin, resolution=0.01, tangents=tangents) is decision
        assert FLOOR.clears_tube(np.stack([points] * 3), RADIUS, margin=margin, resolution=0.01, deviation=0.01).tolist() == [decision] * 3


def test_refused() -> None:
    points, tangents, _ = arc(40)
    with pytest.raises(ContinuumError, match="give one"):
        FLOOR.clearance(points, RADIUS, tolerance=0.1, tangents=tangents, deviation=0.1)
    for deviation in (-1.0, np.nan, np.inf):
        with pytest.raises(ContinuumError, match="`deviation`") as raised:
            FLOOR.clearance(points, RADIUS, tolerance=0.1, deviation=deviation)
        assert raised.value.kind == "negative"
