"""Motions as objects, a planner's shapes, and a mesh that moves, beside their shapes at many times."""

from __future__ import annotations

from typing import Callable

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import (
    BendingMotion,
    ContinuumError,
    Decision,
    LinearMotion,
    Mesh,
    Motion,
    MotionPath,
    MovingBase,
    RigidMotion,
    RobotPair,
    UndecidedReason,
)
from shapes import Array, poses, robots, sphere

RADIUS = 0.3
MESH = Mesh(*sphere())
TIMES = np.linspace(0, 1, 200)


def rotation(axis: Array, angle: Array) -> Array:
    """Rodrigues' formula, (T, 3, 3)."""
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    sin, cos = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + sin * cross + (1 - cos) * (cross @ cross)


def ways(random: np.random.Generator) -> tuple[Array, Array, Array]:
    """Two poses, and all between them, (T, 4, 4): the origin goes straight, and the frame turns about one axis of its own."""
    start, axis, shift = poses(random, 1)[0], random.normal(size=3), random.normal(scale=4, size=3)
    axis /= np.linalg.norm(axis)
    angle = random.uniform(0.2, 2.5)
    all_poses = np.tile(start, (len(TIMES), 1, 1))
    all_poses[:, :3, :3] = start[:3, :3] @ rotation(axis, angle * TIMES)
    all_poses[:, :3, 3] += shift * TIMES[:, None]
    return start, all_poses[-1], all_poses


def bent(sections: Array) -> Array:
    """40 points along each section of constant curvature, by small turns."""
    points, frame = [np.zeros(3)], np.eye(3)
    for length, x, y in sections:
        step = length / 40
        curvature = np.hypot(x, y)
        axis = np.array([-y, x, 0]) / curvature if curvature > 0 else np.array([1.0, 0, 0])
        half, whole = rotation(axis, curvature * step * np.array([0.5, 1.0]))
        for _ in range(40):
            # The chord of an arc is along the direction in its middle.
            chord = step * np.sinc(curvature * step / 2 / np.pi)
            points.append(points[-1] + chord * (frame @ half)[:, 2])
            frame = frame @ whole
    return np.array(points)


def placed(pose: Array, points: Array) -> Array:
    return points @ np.swapaxes(pose[..., :3, :3], -1, -2) + pose[..., None, :3, 3]


def hold(motion: Motion, distances: Array, step: float, loose: float = 1e-9) -> int:
    """Whether answers fit the distances of shapes between which nothing moves farther than `step`; and how many touch.

    `loose` is what a chain leaves of the curve that the motion is of."""
    least = distances.min()
    found = MESH.clearance_of_motion(motion, tolerance=0.01)
    assert found.lower - loose <= least and least - step <= found.upper + loose
    assert found.resolved and found.upper - found.lower <= 0.01
    near = distances[np.abs(TIMES - found.t).argmin()]
    assert near - step <= found.upper + loose
    if least > step + 0.02 + loose:
        kept = MESH.clears_motion(motion, margin=least - step - 0.02 - loose, resolution=0.01)
        assert kept.decision is Decision.CLEAR and kept.interval.tolist() == [1, 1]
    margin = least + 0.02 + loose
    answer = MESH.clears_motion(motion, margin=margin, resolution=0.01)
    assert answer.decision is Decision.CONTACT and answer.upper <= margin
    at = MESH.time_of_contact(motion, margin=margin, resolution=0.01)
    assert (distances[TIMES < at.interval[0]] > margin - loose).all()
    assert at.interval[0] <= TIMES[distances <= margin - loose][0]
    return int(least == 0)


def test_reasons() -> None:
    """A motion that is undecided says why; of a batch there is a number for each."""
    floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    start, end = np.array([[0, 0, 2.0], [0, 0, 5.0]]), np.array([[0, 0, 1.0], [0, 0, 5.0]])
    motion = LinearMotion(start, end, RADIUS)
    near = floor.clears_path(np.stack([start, end]), RADIUS, deviation=0.3, margin=0.8, resolution=0.01)
    assert near.decision is Decision.UNDECIDED and near.reason is UndecidedReason.NEAR
    for margin, decision in [(0.5, Decision.CLEAR), (1.5, Decision.CONTACT)]:
        found = floor.clears_motion(motion, margin=margin, resolution=0.1)
        assert found.decision is decision and found.reason is UndecidedReason.NONE
    many = floor.clears_motion(np.stack([start] * 2), np.stack([end, start]), RADIUS, margin=1.5, resolution=0.1)
    assert many.reason.dtype == np.int8 and many.reason.tolist() == [UndecidedReason.NONE] * 2
    at_rest = RobotPair().clears_motions(motion, LinearMotion(start + [9, 0, 0], end + [9, 0, 0], RADIUS), margin=0.5, resolution=0.1)
    assert at_rest.decision is Decision.CLEAR and at_rest.reason is UndecidedReason.NONE


def test_rigid_motions() -> None:
    random = np.random.default_rng(81)
    shapes = robots(random, 12, points=8)
    touching = 0
    for robot in shapes:
        start, end, between = ways(random)
        for caps in ("fitted", "capsules", "cylinders"):
            distances = MESH.distance(np.tile(robot, (len(TIMES), 1, 1)), RADIUS, pose=between, caps=caps)
            step = np.linalg.norm(np.diff(placed(between, robot), axis=0), axis=-1).max() + 2 * RADIUS * 2.5 / 199
            motion = RigidMotion(robot, RADIUS, start, end, caps=caps)
            touching += hold(motion, distances, step)
    assert 3 < touching < 30


def test_bending_motions_on_a_moving_base() -> None:
    random = np.random.default_rng(82)
    touching = 0
    for _ in range(8):
        start = np.stack([random.uniform(3, 6, 2), *random.normal(scale=0.15, size=(2, 2))], axis=1)
        end = np.stack([random.uniform(3, 6, 2), *random.normal(scale=0.15, size=(2, 2))], axis=1)
        shapes = np.stack([bent((1 - t) * start + t * end) for t in TIMES])
        first, last, between = ways(random)
        alone = BendingMotion(start, end, RADIUS, pose=first)
        fixed = np.tile(first, (len(TIMES), 1, 1))
        for motion, pose in [(alone, fixed), (MovingBase(BendingMotion(start, end, RADIUS), first, last), between)]:
            moved = placed(pose, shapes)
            step = 2 * np.linalg.norm(np.diff(moved, axis=0), axis=-1).max()
            # Chords of 0.15 leave an arc by less than this, and tilt the faces of the tip by less than that.
            touching += hold(motion, MESH.distance(shapes, RADIUS, pose=pose), step, loose=2e-3 + RADIUS * 0.05)
    assert 1 < touching < 15


def test_paths_of_motions() -> None:
    random = np.random.default_rng(83)
    for robot in robots(random, 10, points=6):
        corners = robot + random.normal(scale=1.5, size=(4, 1, 3))
        path = MotionPath([LinearMotion(a, b, RADIUS, caps="capsules") for a, b in zip(corners, corners[1:])])
        leg = np.minimum((3 * TIMES).astype(int), 2)
        share = (3 * TIMES - leg)[:, None, None]
        shapes = (1 - share) * corners[leg] + share * corners[leg + 1]
        step = np.linalg.norm(np.diff(shapes, axis=0), axis=-1).max()
        hold(path, MESH.distance(shapes, RADIUS, caps="capsules"), step)


def test_linear_motions_are_those_of_shapes() -> None:
    random = np.random.default_rng(84)
    start = robots(random, 40, points=6)
    end = start + random.normal(scale=2, size=(40, 1, 3))
    for caps in ("fitted", "capsules"):
        motion = LinearMotion(start, end, RADIUS, caps=caps)
        for ask in ("clears_motion", "time_of_contact"):
            found = getattr(MESH, ask)(motion, margin=0.1, resolution=0.01)
            expected = getattr(MESH, ask)(start, end, RADIUS, margin=0.1, resolution=0.01, caps=caps)
            for field, fields in zip(found[:3], expected[:3]):
                assert_array_equal(field, fields)
        assert_array_equal(
            MESH.clearance_of_motion(motion, tolerance=0.01).upper,
            MESH.clearance_of_motion(start, end, RADIUS, tolerance=0.01, caps=caps).upper,
        )


def test_batches() -> None:
    """One robot and many poses, many sections and one pose, and the same one by one."""
    random = np.random.default_rng(85)
    robot, first, last = robots(random, 1)[0], poses(random, 30), poses(random, 30)
    sections = np.stack([random.uniform(3, 6, (30, 2)), *random.normal(scale=0.1, size=(2, 30, 2))], axis=-1)
    radii = random.uniform(0.1, 0.3, (30, 2))
    makes: list[Callable[[object], Motion]] = [
        lambda k: RigidMotion(robot, RADIUS, first[k], last[k]),
        lambda k: RigidMotion(robot, RADIUS, first[0], last[k], caps="capsules"),
        lambda k: RigidMotion.of_curve(robot, RADIUS, first[k], last[k], deviation=0.01, turn=0.1),
        lambda k: BendingMotion(sections[0], sections[k], 0.2, pose=first[k]),
        lambda k: BendingMotion(sections[k], sections[k][..., ::-1, :], radii[k][..., :1].repeat(2, -1)),
        lambda k: MovingBase(BendingMotion(sections[0], sections[1], 0.2), first[k], last[k]),
        lambda k: MovingBase(BendingMotion(sections[0], sections[k], 0.2), first[1], last[1]),
        lambda k: MotionPath([RigidMotion(robot, RADIUS, first[k], last[k]), RigidMotion(robot, RADIUS, last[k], first[0])]),
    ]
    decisions = set()
    for make in makes:
        motions = make(slice(None))
        assert motions.count == 30 and make(3).count is None and "30" in repr(motions)
        many = MESH.clearance_of_motion(motions, tolerance=0.05)
        margin = float(np.median(many.upper)) + 0.01
        decided = MESH.clears_motion(motions, margin=margin, resolution=0.2)
        assert many.lower.shape == (30,) and decided.interval.shape == (30, 2)
        for k in (1, 2, 29):
            one = MESH.clearance_of_motion(make(k), tolerance=0.05)
            assert many.lower[k] <= one.upper and one.lower <= many.upper[k]
            alone = MESH.clears_motion(make(k), margin=margin, resolution=0.2)
            assert abs(one.upper - margin) < 0.4 or alone.decision == decided.decision[k]
        decisions |= set(decided.decision.tolist())
    assert decisions >= {Decision.CONTACT, Decision.CLEAR}


def test_curves_move_as_they_stand() -> None:
    """A motion that stands still comes as near as the tube."""
    angle = np.linspace(0, 1, 40)
    points = np.stack([5 * np.sin(angle), 0 * angle, 5 * np.cos(angle)], axis=1)
    tangents = np.stack([np.cos(angle), 0 * angle, -np.sin(angle)], axis=1)
    for given in ({}, {"tangents": tangents}, {"deviation": 0.01}, {"deviation": 0.01, "turn": 0.05}):
        still = RigidMotion.of_curve(points, RADIUS, np.eye(4), np.eye(4), **given)
        found = MESH.clearance_of_motion(still, tolerance=0.01)
        tube = MESH.clearance(points, RADIUS, tolerance=0.01, **given)
        assert found.lower <= tube.upper and tube.lower <= found.upper
        assert abs(found.uncertainty - tube.uncertainty) < 1e-12


def test_shapes_of_a_planner() -> None:
    random = np.random.default_rng(86)
    first = robots(random, 20, points=6)
    shapes = first[:, None] + np.cumsum(random.normal(scale=0.4, size=(20, 5, 1, 3)), axis=1)
    deviation, decisions = 0.05, []
    leg = np.minimum((4 * TIMES).astype(int), 3)
    share = (4 * TIMES - leg)[:, None, None]
    for path in shapes:
        between = (1 - share) * path[leg] + share * path[leg + 1]
        step = np.linalg.norm(np.diff(between, axis=0), axis=-1).max()
        distance = MESH.distance(between, RADIUS, caps="capsules").min()
        # Every tube so near keeps this much; and where the sides of links are nearest, it keeps no more than this.
        safe = max(0.0, distance - deviation - step - 0.011)
        if distance > deviation + step + 0.02:
            assert MESH.clears_path(path, RADIUS, deviation, margin=safe, resolution=0.01).decision is Decision.CLEAR
        if distance > 0.3:  # a tube within 0.3 is nearer than that by as much
            assert MESH.clears_path(path, RADIUS, 0.3, margin=distance - 0.1, resolution=0.01).decision is not Decision.CLEAR
        far = distance + deviation + RADIUS + 0.011
        found = MESH.clears_path(path, RADIUS, deviation, margin=far, resolution=0.01)
        assert found.decision is Decision.CONTACT and 0 <= found.t <= 1 and found.upper <= far
        decisions.append(MESH.clears_path(path, RADIUS, deviation, margin=0.5, resolution=0.01))
    many = MESH.clears_path(shapes, RADIUS, deviation, margin=0.5, resolution=0.01)
    assert_array_equal(many.decision, [one.decision for one in decisions])
    assert_array_equal(many.interval, [one.interval for one in decisions])
    assert len(set(many.decision.tolist())) > 1
    radii = np.full((20, 5), RADIUS)
    assert_array_equal(MESH.clears_path(shapes, radii, deviation, margin=0.5, resolution=0.01).decision, many.decision)
    assert MESH.clears_path(shapes[0, :1], RADIUS, 0.0, margin=0.0, resolution=0.01).decision in (Decision.CLEAR, Decision.CONTACT)


def test_meshes_that_move_meanwhile() -> None:
    random = np.random.default_rng(87)
    vertices, faces = sphere()
    mesh = Mesh(vertices, faces)
    start = robots(random, 12, points=6)
    end = start + random.normal(scale=0.5, size=(12, 1, 3))
    to = vertices * [0.8, 1.1, 0.7] + [0.5, 0, 0]
    step = np.linalg.norm(to - vertices, axis=1).max() / 99 + np.linalg.norm(end - start, axis=-1).max() / 99
    moved, least = Mesh(mesh), np.full(12, np.inf)
    for t in np.linspace(0, 1, 100):
        moved.set_vertices((1 - t) * vertices + t * to)
        least = np.minimum(least, moved.distance((1 - t) * start + t * end, RADIUS, caps="capsules"))
    assert (least > 0.1).sum() > 3
    for sign in (-1, 1):
        for k in range(12):
            margin = least[k] + sign * (step + 0.02)
            if margin < 0:
                continue
            motion = LinearMotion(start[k], end[k], RADIUS, caps="capsules")
            found = mesh.clears_motion_while(to, motion, margin=margin, resolution=0.01)
            assert found.decision is (Decision.CLEAR if sign < 0 else Decision.CONTACT)
            shapes = mesh.clears_motion_while(to, start[k], end[k], RADIUS, margin=margin, resolution=0.01, caps="capsules")
            assert shapes.decision is found.decision
    many = mesh.clears_motion_while(to, start, end, RADIUS, margin=0.3, resolution=0.01)
    assert many.decision.shape == (12,)
    assert_array_equal(mesh.vertices, vertices)


def nested(motion: Motion, pose: Array) -> Motion:
    for _ in range(100):
        motion = MovingBase(motion, pose, pose)
    return motion


def doubled(motion: Motion) -> Motion:
    for _ in range(5):
        motion = MotionPath([motion] * 100)
    return motion


@pytest.mark.parametrize(
    ("ask", "kind", "text"),
    [
        (lambda r, p: RigidMotion(r[0], 0.1, p[:2], p[:3]), "bad_shape", "`start_pose` has 2 and `end_pose` 3"),
        (lambda r, p: RigidMotion(r[:3], 0.1, p[:2], p[0]), "bad_shape", "`points` has 3 and `start_pose` 2"),
        (lambda r, p: RigidMotion(r[0], 0.1, p[0], np.eye(3)), "bad_shape", r"`end_pose` has the shape \(3, 3\)"),
        (lambda r, p: RigidMotion(r[0], 0.1, p[0], np.diag([2, 2, 2, 1])), "scales", "`end_pose`: the matrix scales"),
        (lambda r, p: RigidMotion(r[0], 0.1, p[0] * np.nan, p[0]), "not_finite", "`start_pose`"),
        (lambda r, p: RigidMotion(r[0], -0.1, p[0], p[0]), "bad_radius", "radius 0"),
        (lambda r, p: RigidMotion.of_curve(r[0], 0.1, p[0], p[0], turn=-1.0), "negative", "`turn`"),
        (lambda r, p: BendingMotion(r[0], r[0].T, 0.1), "bad_shape", "`end`"),
        (lambda r, p: BendingMotion([[1, 0, 0]], [[1, 0, 0]] * 2, 0.1), "sections_differ", "1 sections"),
        (lambda r, p: BendingMotion([[1, 0, 0]], [[-1, 0, 0]], 0.1), "bad_length", "`end`"),
        (lambda r, p: BendingMotion([[1, 0, 0]], [[1, 0, 0]], -0.1), "bad_radius", "`radii`"),
        (lambda r, p: BendingMotion([[1, 0, 0]], [[1, 0, 0]], [0.1, 0.1]), "bad_shape", "`radii`"),
        (lambda r, p: BendingMotion([[1, 0, 0]], [[1, 20, 0]], 0.1), "bends_within_radius", "radius"),
        (lambda r, p: LinearMotion(r[0], r[0], 0.1, caps="cylinders"), "bad_caps", "cylinders"),
        (lambda r, p: MotionPath([]), "no_motions", "motions"),
        # Arrays without numbers, of any number of rows.
        (lambda r, p: MESH.distance(np.zeros((10**15, 0, 3)), 0.1), "too_few_points", "robots without points"),
        (lambda r, p: LinearMotion(np.zeros((10**15, 0, 3)), r, 0.1), "too_few_points", "`start`"),
        (lambda r, p: BendingMotion(np.zeros((10**15, 0, 3)), r, 0.1), "no_sections", "`start`"),
        (lambda r, p: MESH.clears_path(np.zeros((10**15, 0, 2, 3)), 0.1, 0.1, margin=0.1, resolution=0.1), "too_few_points", "`shapes`"),
        (lambda r, p: nested(MotionPath([LinearMotion(r[0], r[0], 0.1)]), p[0]), "nested_too_deep", "7 deep"),
        (lambda r, p: doubled(LinearMotion(r[0], r[0], 0.1)), "nested_too_deep", "make one path"),
        (
            lambda r, p: MESH.clears_motion(LinearMotion(r[0], r[0], 0.1), radii=0.1, margin=1.0, resolution=0.1),
            "bad_type",
            "`radii` is given beside a motion",
        ),
        (lambda r, p: MESH.clears_path(r[0], 0.1, 0.1, margin=0.1, resolution=0.1), "bad_shape", r"\(S, N, 3\)"),
        (lambda r, p: MESH.clears_path(r[:0], 0.1, 0.1, margin=0.1, resolution=0.1), "no_motions", "shapes"),
        (lambda r, p: MESH.clears_path(r, 0.1, -0.1, margin=0.1, resolution=0.1), "negative", "`deviation`"),
        (lambda r, p: MESH.clears_path(r * [[[np.nan]], [[1]], [[1]]], 0.1, 0, margin=1, resolution=0.1), "point_not_finite", r"shapes\[0\]"),
        (
            lambda r, p: MESH.clears_motion_while(MESH.vertices[:5], r[0], r[0], 0.1, margin=0.1, resolution=0.1),
            "vertex_count",
            "5",
        ),
    ],
)
def test_refused(ask: Callable[[Array, Array], object], kind: str, text: str) -> None:
    random = np.random.default_rng(0)
    with pytest.raises(ContinuumError, match=text) as raised:
        ask(robots(random, 3, points=4), poses(random, 3))
    assert raised.value.kind == kind


def test_one_of_a_batch_is_named() -> None:
    random = np.random.default_rng(0)
    with pytest.raises(ContinuumError, match="robot 1: `end_pose`") as raised:
        RigidMotion(robots(random, 1)[0], 0.1, np.eye(4), np.stack([np.eye(4), np.diag([2, 2, 2, 1])]))
    assert raised.value.robot == 1


def test_missing_arguments() -> None:
    robot = robots(np.random.default_rng(0), 1)[0]
    with pytest.raises(ContinuumError, match="`radii` is missing"):
        MESH.clears_motion(robot, robot, margin=0.1, resolution=0.1)  # type: ignore[call-overload]
    with pytest.raises(TypeError, match="missing 1 required keyword argument: 'resolution'"):
        MESH.time_of_contact(LinearMotion(robot, robot, 0.1), margin=0.1)  # type: ignore[call-overload]
