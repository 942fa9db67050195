"""What arrays may look like, and what is said of those that do not fit."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import ContinuumError, Mesh
from shapes import Array, robots, sphere

MESH = Mesh(*sphere())
ROBOTS = np.round(robots(np.random.default_rng(1), 20), 3)


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", ">f8", "g", "i1", "i8", "u2"])
def test_any_type(dtype: str) -> None:
    points = np.abs(np.rint(ROBOTS)).astype(dtype)
    assert_array_equal(MESH.distance(points, 0.25), MESH.distance(points.astype(float), 0.25))
    assert_array_equal(MESH.distance(points[0], 0.25), MESH.distance(points[0].tolist(), 0.25))


def test_any_order() -> None:
    expected = MESH.distance(ROBOTS, 0.25)
    packed = np.zeros(ROBOTS.shape[:2], [("flag", "u1"), ("place", "f8", 3)])  # numbers at odd addresses
    packed["place"] = ROBOTS
    for points in [
        np.asfortranarray(ROBOTS),
        np.ascontiguousarray(ROBOTS[::-1])[::-1],
        np.repeat(ROBOTS, 2, axis=2)[:, :, ::2],
        np.ascontiguousarray(ROBOTS.swapaxes(0, 2)).swapaxes(0, 2),
        packed["place"],
        [robot for robot in ROBOTS],
    ]:
        assert_array_equal(MESH.distance(points, 0.25), expected)
    for k in range(3):
        assert MESH.distance(np.asfortranarray(ROBOTS[k]), 0.25) == expected[k]


def test_radii_and_poses() -> None:
    expected = MESH.distance(ROBOTS, 0.25)
    for radii in [np.float32(0.25), np.array(0.25), np.full(11, 0.25), np.full((20, 11), 0.25), [0.25] * 11]:
        assert_array_equal(MESH.distance(ROBOTS, radii), expected)
    for pose in [None, np.eye(4), np.eye(4, dtype=int), np.tile(np.eye(4, order="F"), (20, 1, 1))]:
        assert_array_equal(MESH.distance(ROBOTS, 0.25, pose=pose), expected)
    assert MESH.distance(ROBOTS[0], 1) == MESH.distance(ROBOTS[0], 1.0)


def test_scalars_and_arrays() -> None:
    one = MESH.distance(ROBOTS[0], 0.1)
    assert type(one) is float and type(MESH.clears(ROBOTS[0], 0.1, margin=0.1)) is bool
    many = MESH.distance(ROBOTS[:1], 0.1)
    assert many.shape == (1,) and many.dtype == np.float64
    assert MESH.clears(ROBOTS, 0.1, margin=0.1).dtype == np.bool_
    links = MESH.per_link(ROBOTS, 0.1)
    assert links.distance.shape == (20, 11) and links.on_mesh.shape == (20, 11, 3)
    assert links.triangle.dtype == np.int64


def test_no_robots() -> None:
    none = np.zeros((0, 5, 3))
    assert MESH.distance(none, 0.1).shape == (0,)
    assert MESH.per_link(none, 0.1).on_robot.shape == (0, 4, 3)
    assert MESH.contacts_within(none, 0.1, margin=1.0).offsets.tolist() == [0]
    assert MESH.clearance(none, 0.1, tolerance=0.1).status.shape == (0,)
    assert MESH.distance_and_gradient(none, 0.1).points.shape == (0, 5, 3)
    assert MESH.clears_motion(none, none, 0.1, margin=0.1, resolution=0.1).interval.shape == (0, 2)
    assert MESH.side(np.zeros((0, 3))).shape == (0,)


def test_numbers_are_copied() -> None:
    points = ROBOTS.copy()
    before = MESH.distance(points, 0.1)
    points += 100
    assert_array_equal(before, MESH.distance(ROBOTS, 0.1))
    # A copy of the mesh's that could be written to would look like the mesh itself.
    for numbers in (MESH.vertices, MESH.faces, Mesh(*sphere(), frame="RAS").vertices):
        with pytest.raises(ValueError, match="read-only"):
            numbers[:] = 0


class Table:
    """What a table of pandas has, as far as the package sees it."""

    def __init__(self, columns: list[object], rows: Array) -> None:
        self.columns, self._rows = columns, rows

    def __array__(self, dtype: object = None, copy: object = None) -> Array:
        return self._rows


def test_columns_of_a_table_are_in_order() -> None:
    for names in (["z", "y", "x"], ["Y", "X", "Z"], ["s", "a", "r"], ["p", "l", "s"]):
        with pytest.raises(ContinuumError, match=f"has the columns {', '.join(names)}; give them in the order"):
            MESH.distance(Table([*names], ROBOTS[0]), 0.1)
    expected = MESH.distance(ROBOTS[0], 0.1)
    for columns in (["x", "y", "z"], ["l", "p", "s"], [0, 1, 2], ["c", "b", "a"], ["x", 1, "z"]):
        assert MESH.distance(Table(columns, ROBOTS[0]), 0.1) == expected


def test_segments_without_length() -> None:
    points = ROBOTS[0, [0, 0, 1, 2, 2, 2, 3, 4, 4]]
    links = MESH.per_link(points, 0.1)
    has_length = np.array([0, 1, 1, 0, 0, 1, 1, 0], bool)
    assert_array_equal(np.isfinite(links.distance), has_length)
    assert_array_equal(links.triangle >= 0, has_length)
    assert np.isnan(links.on_robot[~has_length]).all()
    assert_array_equal(links.distance[has_length], MESH.per_link(ROBOTS[0, :5], 0.1).distance)
    assert set(MESH.contacts_within(points, 0.1, margin=20.0).segment) <= set(np.flatnonzero(has_length))


ONE, MANY = ROBOTS[0], ROBOTS


@pytest.mark.parametrize(
    ("ask", "kind", "advice"),
    [
        (lambda: MESH.distance(ONE.T, 0.1), "bad_shape", "transpose"),
        (lambda: MESH.distance(MANY.swapaxes(1, 2), 0.1), "bad_shape", "swapaxes"),
        (lambda: MESH.distance(ONE[0], 0.1), "bad_shape", "row of three"),
        (lambda: MESH.distance(MANY[None], 0.1), "bad_shape", "row of three"),
        (lambda: MESH.distance(ONE * 1j, 0.1), "bad_type", "complex128"),
        (lambda: MESH.distance(ONE > 0, 0.1), "bad_type", "bool"),
        (lambda: MESH.distance("tube", 0.1), "bad_type", "`points`"),
        (lambda: MESH.distance(None, 0.1), "bad_type", "`points`"),
        (lambda: MESH.distance([[0, 0, 0], [1, 1]], 0.1), "bad_type", "`points`"),
        (lambda: MESH.distance(ONE, None), "bad_type", "`radii`"),
        (lambda: MESH.distance(ONE, [0.1] * 12), "lengths_differ", "11 radii"),
        (lambda: MESH.distance(MANY, [0.1] * 20), "lengths_differ", "11 radii"),
        (lambda: MESH.distance(MANY, np.ones((19, 11))), "bad_shape", "(20, 11)"),
        (lambda: MESH.distance(ONE, np.ones((2, 12))), "bad_shape", "(11,) or (B, 11)"),
        (lambda: MESH.distance(ONE, 0.1, pose=np.eye(3)), "bad_shape", "(4, 4)"),
        (lambda: MESH.distance(ONE, 0.1, pose=np.tile(np.eye(4), (1, 1, 1, 1))), "bad_shape", "(4, 4) or (B, 4, 4)"),
        (lambda: MESH.distance(ONE, 0.1, pose=2 * np.eye(4)), "last_row", "0 0 0 1"),
        (lambda: MESH.distance(ONE, 0.1, pose=np.diag([2, 2, 2, 1])), "scales", "scales by 2"),
        (lambda: MESH.distance(ONE, 0.1, caps="round"), "bad_caps", "'capsules'"),
        (lambda: MESH.distance(ONE[:1], 0.1), "too_few_points", "at least 2"),
        (lambda: MESH.per_link(ONE[:1], 0.1), "too_few_points", "at least 2"),
        (lambda: MESH.per_link(MANY[:, :1], 0.1), "too_few_points", "robot 0"),
        (lambda: MESH.clears(ONE, 0.1, margin=-1.0), "negative", "`margin`"),
        (lambda: MESH.contacts_within(ONE, 0.1, margin=np.nan), "negative", "`margin`"),
        (lambda: MESH.clearance(ONE, 0.1, tolerance=-1.0), "negative", "`tolerance`"),
        (lambda: MESH.clearance(MANY, 0.1, tolerance=np.nan), "negative", "`tolerance`"),
        (lambda: MESH.clearance(ONE, 0.1, tolerance=0.1, tangents=np.ones((3, 3))), "bad_shape", "two directions"),
        (lambda: MESH.clearance(ONE, 0.1, tolerance=0.1, tangents=np.zeros((2, 3))), "bad_tangent", "`tangents`"),
        (lambda: MESH.clears_motion(ONE, MANY[:, 1:], 0.1, margin=0.1, resolution=0.1), "bad_shape", "same shape"),
        (lambda: MESH.clears_motion(ONE, ONE, 0.1, margin=0.1, resolution=0.1, caps="cylinders"), "bad_caps", "'fitted'"),
        (lambda: MESH.clears_motion(ONE, ONE, 0.1, margin=0.1, resolution=-0.1), "negative", "`resolution`"),
        (lambda: MESH.clears_motion(ONE, ONE * np.nan, 0.1, margin=0.1, resolution=0.1), "point_not_finite", "`end`"),
        (lambda: MESH.side([1.0, 2.0]), "bad_shape", "(..., 3)"),
        (lambda: MESH.certify(ONE, 0.1, MESH.per_link(ONE[:5], 0.1)), "answer_does_not_fit", "(4,)"),
        (lambda: MESH.certify(ONE, 0.1, 3), "answer_does_not_fit", "per_link"),
    ],
)
def test_refused(ask: object, kind: str, advice: str) -> None:
    with pytest.raises(ContinuumError) as raised:
        ask()  # type: ignore[operator]
    assert raised.value.kind == kind
    assert advice in str(raised.value)


def test_what_is_at_fault() -> None:
    points = MANY.copy()
    points[17, 3, 1] = np.nan
    points[18, 2, 1] = np.nan
    with pytest.raises(ContinuumError) as raised:
        MESH.distance(points, 0.1)
    assert (raised.value.robot, raised.value.index, raised.value.kind) == (17, 3, "point_not_finite")
    assert "robot 17" in str(raised.value)
    with pytest.raises(ValueError) as raised:
        MESH.distance(points[17], 0.1)
    assert (raised.value.robot, raised.value.index) == (None, 3)
    with pytest.raises(ContinuumError) as raised:
        MESH.clears_tube(MANY[0], 0.1, margin=MESH.clearance(MANY[0], 0.1, tolerance=0.0).lower, resolution=1e-300)
    assert raised.value.kind == "tolerance_too_fine"
    assert raised.value.possible is not None and raised.value.possible > 1e-300


def test_status_of_a_batch() -> None:
    points = MANY.copy()
    points[3, 4, 0] = np.inf
    points[5, 6] = points[5, 4]  # there and back
    found = MESH.clearance(points, 0.1, tolerance=0.01)
    assert found.status[3] == "point_not_finite" and found.status[5] == "turns_too_sharply"
    refused = found.status != ""
    assert_array_equal(np.flatnonzero(refused), [3, 5])
    assert np.isnan(found.lower[refused]).all() and (found.triangle[refused] == -1).all()
    assert (found.lower <= found.upper)[~refused].all()
