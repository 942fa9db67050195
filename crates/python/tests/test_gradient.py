"""Derivatives beside differences of distances."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from parry_continuum import ContinuumError, Mesh
from shapes import Array, poses, robots, sphere

MESH = Mesh(*sphere())
STEP = 1e-6


def differences(ask: object, given: Array) -> Array:
    """Central ones, of one number each."""
    found = np.zeros_like(given)
    for index in np.ndindex(given.shape):
        more, less = given.copy(), given.copy()
        more[index] += STEP
        less[index] -= STEP
        found[index] = (ask(more) - ask(less)) / (2 * STEP)  # type: ignore[operator]
    return found


def test_apart() -> None:
    """With respect to all points and radii, for flat and round ends."""
    random = np.random.default_rng(21)
    checked = 0
    for points, pose in zip(robots(random, 40, points=6), poses(random, 40)):
        radii = np.full(5, 0.2)
        for caps in ("fitted", "capsules", "cylinders"):
            found = MESH.distance_and_gradient(points, radii, pose=pose, caps=caps)
            assert found.value == MESH.distance(points, radii, pose=pose, caps=caps) or found.value <= 0
            of_points = differences(lambda p: MESH.distance(p, radii, pose=pose, caps=caps), points)
            if caps != "fitted":  # radii that differ are steps, with other caps
                of_radii = differences(lambda r: MESH.distance(points, r, pose=pose, caps=caps), radii)
            # A kink within the step of the differences: two links share a joint, or two triangles an edge.
            is_smooth = not found.kink and found.value > 1e-3
            links = np.sort(MESH.per_link(points, radii, pose=pose, caps=caps).distance)
            if is_smooth and links[1] - links[0] > 1e-4:
                checked += 1
                assert_allclose(found.points, of_points, atol=1e-6)
                if caps != "fitted":
                    assert_allclose(found.radii, of_radii, atol=1e-6)
    assert checked > 40


def test_pose() -> None:
    """Along rigid motions: the derivative with respect to the matrix, times how the matrix changes."""
    random = np.random.default_rng(22)
    checked = 0
    for points, pose in zip(robots(random, 40, points=6), poses(random, 40)):
        found = MESH.distance_and_gradient(points, 0.2, pose=pose, caps="capsules")
        links = np.sort(MESH.per_link(points, 0.2, pose=pose, caps="capsules").distance)
        if found.value < 1e-3 or found.kink or links[1] - links[0] < 1e-4:
            continue
        checked += 1
        x, y, z, *shift = random.normal(size=6)
        twist = np.array([[0, -z, y, shift[0]], [z, 0, -x, shift[1]], [-y, x, 0, shift[2]], [0, 0, 0, 0]])

        def moved(t: float) -> float:
            # exp(t twist) up to the third order, which is rigid but for 1e-18
            step = t * twist
            matrix = (np.eye(4) + step + step @ step / 2 + step @ step @ step / 6) @ pose
            matrix[3] = [0, 0, 0, 1]
            return float(MESH.distance(points, 0.2, pose=matrix, caps="capsules"))

        expected = (moved(STEP) - moved(-STEP)) / (2 * STEP)
        assert abs(np.sum(found.pose * (twist @ pose)) - expected) < 1e-6
    assert checked > 15


def test_overlapping() -> None:
    """Below the floor's surface the value goes on, and so does its slope."""
    floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    for height in (0.3, 0.1, 0.01):
        robot = np.array([[-1.0, 0, height + 1], [0, 0, height], [1, 0, height + 2]])
        found = floor.distance_and_gradient(robot, 0.5, caps="capsules")
        assert abs(found.value - (height - 0.5)) < 1e-15
        assert_allclose(found.points[1], [0, 0, 1], atol=1e-12)
        assert_allclose(np.delete(found.points, 1, axis=0), 0, atol=1e-12)
        assert found.radii.sum() == -1


def test_no_side() -> None:
    """A wire that lies in the wall has no derivative."""
    floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    found = floor.distance_and_gradient([[-1, 0, 0], [1, 0, 0]], 0.0)
    assert np.isnan(found.points).all() and np.isnan(found.pose).all() and found.value == 0


FLOOR = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
BEND = np.array([[-2, 0, 2], [0, 0, 1], [2, 0, 2.0]])


def test_a_bend_of_equal_radii_has_a_kink() -> None:
    """The wider side of a step is flat, and the narrower one decides: more of one radius changes nothing, less of it does."""
    equal = np.full(2, 0.5)
    found = FLOOR.distance_and_gradient(BEND, equal)
    assert found.value == 0.5 and found.kink is True
    for place in (0, 1):
        for off in (1e-6, -1e-6):
            other = equal.copy()
            other[place] += off
            assert FLOOR.distance(BEND, other) == pytest.approx(0.5 - min(off, 0), abs=1e-12)
            assert FLOOR.distance_and_gradient(BEND, other).kink is False
    # Radii that differ by rounding are equal.
    assert FLOOR.distance_and_gradient(BEND, equal * [1, 1 + 2e-16]).kink is True
    assert FLOOR.distance_and_gradient(BEND, 0.5).kink is True
    assert FLOOR.distance_and_gradient(BEND, equal, caps="capsules").kink is False


@pytest.mark.parametrize("behind", [0.2, 0.3])
def test_a_bend_turns_flat_where_one_radius_changes(behind: float) -> None:
    """A short segment that becomes wider has a face, and the bend is too near to it to stay filled."""
    along = (BEND[2] - BEND[1]) / np.linalg.norm(BEND[2] - BEND[1])
    points = np.stack([BEND[0], BEND[1], BEND[1] + behind * along, BEND[2]])
    equal = np.full(3, 0.5)
    found = FLOOR.distance_and_gradient(points, equal)
    assert found.value == 0.5 and found.kink is True
    assert FLOOR.distance(points, equal + [0, 1e-6, 0]) > 0.55
    # The radii at the bend differ, and those behind it are equal.
    narrow = np.array([0.6, 0.5, 0.5])
    assert FLOOR.distance_and_gradient(points, narrow).kink is (FLOOR.minimum(points, narrow).segment == 1)


def test_where_there_is_no_joint_there_is_no_such_kink() -> None:
    tilted = BEND[:2]  # its end is closest, which is flat
    assert FLOOR.distance_and_gradient(tilted, 0.5).kink is False
    arch = BEND * [1, 1, -1] + [0, 0, 5]  # its ends are closest
    found = FLOOR.distance_and_gradient(np.stack([BEND, arch + [0, 0, 1], BEND + [0, 0, 1]]), 0.5)
    assert found.kink[[0, 2]].all() and found.value.tolist() == pytest.approx([0.5, 3.553, 1.5], abs=1e-3)
    side = np.array([[-2, 0, 2], [0, 0, 2.1], [2, 0, 1.0], [4, 0, 2.0]])
    assert FLOOR.distance_and_gradient(side, 0.1).kink is True
    found = FLOOR.distance_and_gradient(BEND[None], [[0.5, 0.6]])
    assert found.kink.tolist() == [False]
    none = FLOOR.distance_and_gradient(BEND[None][:0], 0.5)
    assert none.kink.shape == (0,) and none.points.shape == (0, 3, 3)
    with pytest.raises(ContinuumError, match="`radii`"):
        FLOOR.distance_and_gradient(BEND, "wide")
