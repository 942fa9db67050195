"""Answers are those of the Rust library, bit for bit, whether one robot is asked about or many."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import BendingMotion, ContinuumError, Mesh, MovingBase, RigidMotion, RobotPair, SelfQuery
from shapes import Array, poses, robots, soup, sphere

CRATE = Path(__file__).parent.parent
MARGIN, TOLERANCE = 0.5, 0.01


def rust(*numbers: object) -> Array:
    command = ["cargo", "run", "--quiet", "--release", "--example", "answers"]
    given = np.concatenate([np.ravel(np.asarray(n, float)) for n in numbers]).tobytes()
    environment = {"CARGO_TARGET_DIR": str(CRATE / "target"), **os.environ}
    done = subprocess.run(command, cwd=CRATE, env=environment, input=given, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()
    return np.frombuffer(done.stdout)


def witness(found: object, at: object = ()) -> list[object]:
    fields = ["on_robot", "on_mesh", "segment", "arc_length", "triangle"]
    return [np.asarray(getattr(found, field))[at] for field in fields]


def fresh(mesh: Mesh) -> Mesh:
    """The same mesh, which was asked nothing yet."""
    return Mesh(mesh.vertices, mesh.faces)


def python(mesh: Mesh, points: Array, end: Array, radii: Array, pose: Array) -> Array:
    """The same numbers, from batches."""
    out: list[list[object]] = [[] for _ in points]
    for caps in ("fitted", "capsules", "cylinders"):
        closest = mesh.minimum(points, radii, pose=pose, caps=caps)
        links = mesh.per_link(points, radii, pose=pose, caps=caps)
        proof = mesh.certify(points, radii, links, pose=pose, caps=caps)
        inside = mesh.clears_inside(points, radii, margin=MARGIN, pose=pose, caps=caps)
        contacts = mesh.contacts_within(points, radii, margin=MARGIN, pose=pose, caps=caps)
        assert_array_equal(inside.clears, mesh.clears(points, radii, margin=MARGIN, pose=pose, caps=caps))
        assert_array_equal(closest.distance, mesh.distance(points, radii, pose=pose, caps=caps))
        for k, row in enumerate(out):
            row += [closest.distance[k], *witness(closest, k)]
            for s in np.flatnonzero(links.triangle[k] >= 0):
                row += [links.distance[k, s], links.on_robot[k, s], links.on_mesh[k, s], s]
                row += [links.arc_length[k, s], links.triangle[k, s], proof.lower[k, s], proof.upper[k, s]]
            row += [inside.clears[k], inside.base[k]]
            rows = range(*contacts.offsets[k : k + 2])
            row += [len(rows)]
            for c in rows:
                assert contacts.robot[c] == k
                row += [contacts.fraction[c], contacts.distance[c], contacts.depth[c], contacts.normal[c]]
                row += witness(contacts, c)
    # Where a tube touches, which common point is named depends on what was asked before: each is asked of a mesh of its own.
    many = mesh.clearance(points, radii, tolerance=TOLERANCE, pose=pose)
    motions = [mesh.clears_motion(points, end, radii, margin=0.0, resolution=TOLERANCE, caps=caps) for caps in ("fitted", "capsules")]
    for k, row in enumerate(out):
        tube = fresh(mesh).clearance(points[k], radii[k], tolerance=TOLERANCE, pose=pose[k])
        assert many.lower[k] <= tube.upper and tube.lower <= many.upper[k]
        row += [tube.lower, tube.upper, tube.resolved, tube.uncertainty, *witness(tube)]
        sections = [np.column_stack([[1, 1], 0.01 * shape[:2, :2]]) for shape in (points[k], end[k])]
        rigid = RigidMotion(points[k], radii[k], pose[k], np.eye(4))
        bending = BendingMotion(*sections, radii[k, 0], pose=pose[k])
        based = MovingBase(BendingMotion(*sections, radii[k, 0], pose=pose[k]), pose[k], np.eye(4))
        paths = np.stack([points[k], points[k] + [0.5, -0.25, 1.0]])
        for found in [
            *(fresh(mesh).clears_motion(motion, margin=0.0, resolution=TOLERANCE) for motion in (rigid, bending, based)),
            fresh(mesh).clears_path(paths, radii[k], 0.1, margin=MARGIN, resolution=TOLERANCE),
            fresh(mesh).clears_motion_while(0.9 * mesh.vertices, rigid, margin=0.0, resolution=TOLERANCE),
        ]:
            row += [found.interval, found.decision]
        two = (points[k], radii[k], end[k], radii[k])
        segments = RobotPair().per_link(*two, pose_a=pose[k])
        has_length = segments.segments[:, 0] >= 0
        row += [np.column_stack([segments.distance, segments.on_first, segments.on_second, segments.arc_lengths])[has_length]]
        places = RobotPair().contacts_within(*two, margin=4.0, pose_a=pose[k])
        row += [len(places.distance)]
        row += [np.column_stack([places.distance, places.on_first, places.on_second, places.arc_lengths])]
        # There and back, 2 beside. Some joints at the turn are too sharp for the query.
        try:
            own = SelfQuery().minimum(np.concatenate([points[k], points[k, ::-1] + [2.0, 0, 0]]), radii[k, 0])
        except ContinuumError as error:
            assert error.kind == "joint_too_sharp"
            row += [-1]
        else:
            row += [own.distance < np.inf]
            if own.distance < np.inf:
                row += [own.distance, own.on_first, own.on_second, own.arc_lengths]
        for motion in motions:
            row += [motion.interval[k], motion.decision[k]]
    return np.concatenate([np.ravel(np.asarray(n, float)) for row in out for n in row])


@pytest.mark.parametrize("name", ["sphere", "soup"])
def test_batches_are_the_librarys(name: str) -> None:
    random = np.random.default_rng(3)
    vertices, faces = sphere() if name == "sphere" else soup(random)
    points, pose = robots(random, 40), poses(random, 40)
    points[::5, 4] = points[::5, 3]  # segments without length
    end = points + random.normal(scale=2, size=points.shape)
    radii = np.repeat(random.uniform(0.05, 0.3, (40, 1)), 11, axis=1)
    radii[::3, 6:] *= 0.5
    given = [[p, e, r, t] for p, e, r, t in zip(points, end, radii, pose)]
    numbers = [n for robot in given for n in robot]
    expected = rust([len(vertices), len(faces), 40, 12], vertices, faces, *numbers)
    found = python(Mesh(vertices, faces), points, end, radii, pose)
    assert len(expected) > 15_000
    assert_array_equal(found.view(np.uint64), expected.view(np.uint64))


def test_one_is_as_many() -> None:
    random = np.random.default_rng(5)
    mesh = Mesh(*sphere())
    points, pose = robots(random, 30), poses(random, 30)
    radii = random.uniform(0.05, 0.3, (30, 11))
    for k, (p, r, t) in enumerate(zip(points, radii, pose)):
        for name, extra in [
            ("distance", {}),
            ("minimum", {}),
            ("per_link", {}),
            ("clears", {"margin": 1.0}),
            ("clears_inside", {"margin": 1.0}),
            ("distance_and_gradient", {}),
        ]:
            one = getattr(mesh, name)(p, r, **extra, pose=t)
            many = getattr(mesh, name)(points, radii, **extra, pose=pose)
            for a, b in zip(one if isinstance(one, tuple) else [one], many if isinstance(many, tuple) else [many]):
                assert_array_equal(a, b[k])
        # One radius and one pose for all.
        assert mesh.distance(p, 0.2, pose=t) == mesh.distance(points, 0.2, pose=t)[k]
        assert mesh.distance(p, r) == mesh.distance(points, r)[k]
        one = mesh.contacts_within(p, r, margin=1.0, pose=t)
        many = mesh.contacts_within(points, radii, margin=1.0, pose=pose)
        for a, b in zip(one[:9], many[:9]):
            assert_array_equal(a, b[many.offsets[k] : many.offsets[k + 1]])
