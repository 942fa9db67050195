"""Answers as tables: columns of equal length, which pandas takes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import LinearMotion, Mesh, RobotPair, Scene
from shapes import robots, sphere

MESH = Mesh(*sphere())
B, N = 7, 12
MANY = robots(np.random.default_rng(12), B)
ONE = MANY[0]
PAIR, SCENE = RobotPair(), Scene()
SCENE.add("wall", MESH, margin=0.1)
SCENE.add("vessel", Mesh(*sphere(1.0)), margin=None)


def motion(points: Any) -> LinearMotion:
    return LinearMotion(points, points + 0.1, 0.1)


CONTACTS = len(MESH.contacts_within(MANY, 0.1, margin=5.0).distance)
# Of each answer: of one, of a batch and of none, how many rows it has.
ANSWERS = {
    "minimum": (lambda p: MESH.minimum(p, 0.1), 1, B),
    "per_link": (lambda p: MESH.per_link(p, 0.1), N - 1, B * (N - 1)),
    "within": (lambda p: MESH.contacts_within(p, 0.1, margin=5.0), len(MESH.contacts_within(ONE, 0.1, margin=5.0).distance), CONTACTS),
    "clearance": (lambda p: MESH.clearance(p, 0.1, tolerance=1.0), 1, B),
    "clears_inside": (lambda p: MESH.clears_inside(p, 0.1, margin=0.1), 1, B),
    "clears_motion": (lambda p: MESH.clears_motion(motion(p), margin=0.1, resolution=0.1), 1, B),
    "clearance_of_motion": (lambda p: MESH.clearance_of_motion(motion(p), tolerance=1.0), 1, B),
    "certify": (lambda p: MESH.certify(p, 0.1, MESH.per_link(p, 0.1)), N - 1, B * (N - 1)),
    "gradient": (lambda p: MESH.distance_and_gradient(p, 0.1), 1, B),
    "pair.minimum": (lambda p: PAIR.minimum(p, 0.1, ONE + 1, 0.1), 1, B),
    "pair.per_link": (lambda p: PAIR.per_link(p, 0.1, ONE + 1, 0.1), N - 1, B * (N - 1)),
    "pair.clearance": (lambda p: PAIR.clearance(p, 0.1, ONE + 1, 0.1, tolerance=1.0), 1, B),
    "pair.clears_motions": (lambda p: PAIR.clears_motions(motion(p), motion(ONE + 1), margin=0.1, resolution=0.1), 1, B),
    "per_structure": (lambda p: SCENE.per_structure([(p, 0.1)]), 2, 2 * B),
    "tightest": (lambda p: SCENE.tightest([(p, 0.1)]), 1, B),
}


@pytest.mark.parametrize("name", ANSWERS)
def test_columns(name: str) -> None:
    ask, one, many = ANSWERS[name]
    names = None
    for given, rows in ((MANY, many), (ONE, one), (MANY[:0], 0)):
        answer = ask(given)
        columns = answer.to_dict()
        assert all(column.shape == (rows,) and type(column) is np.ndarray for column in columns.values()), columns
        own = [name for name in columns if name not in ("robot", "segment", "batch", "structure")]
        assert names is None or names == own
        names = own
        assert list(answer._asdict()) == list(answer._fields)


def test_what_the_columns_are() -> None:
    links = MESH.per_link(MANY, 0.1)
    table = links.to_dict()
    assert list(table) == [
        "robot", "segment", "distance", "on_robot_x", "on_robot_y", "on_robot_z", "on_mesh_x", "on_mesh_y", "on_mesh_z", "arc_length",
        "triangle",
    ]  # fmt: skip
    assert_array_equal(table["on_mesh_y"], links.on_mesh[..., 1].ravel())
    assert_array_equal(table["robot"], np.repeat(np.arange(B), N - 1))
    assert_array_equal(table["segment"], np.tile(np.arange(N - 1), B))
    pair = PAIR.minimum(ONE, 0.1, ONE + 3, 0.1)
    assert pair.to_dict()["segments_1"].tolist() == [pair.segments[1]]
    near = MESH.contacts_within(MANY, 0.1, margin=5.0).to_dict()
    assert "offsets" not in near and (np.diff(near["robot"]) >= 0).all()
    decided = MESH.clears_motion(motion(MANY), margin=0.1, resolution=0.1).to_dict()
    assert decided["decision"].dtype == np.int8 and decided["interval_0"].shape == (B,)
    structures = SCENE.per_structure([(MANY, 0.1)]).to_dict()
    assert_array_equal(structures["structure"], np.tile([0, 1], B))
    assert_array_equal(structures["batch"], np.repeat(np.arange(B), 2))
    gradient = MESH.distance_and_gradient(ONE, 0.1)
    assert gradient.to_dict()["points_3_z"].tolist() == [gradient.points[3, 2]]
    assert gradient.to_dict()["pose_1_2"].tolist() == [gradient.pose[1, 2]]


@pytest.mark.parametrize("name", ANSWERS)
def test_pandas(name: str) -> None:
    pandas = pytest.importorskip("pandas")
    ask, one, many = ANSWERS[name]
    for given, rows in ((ONE, one), (MANY, many), (MANY[:0], 0)):
        answer = ask(given)
        frame = pandas.DataFrame(answer.to_dict())
        assert len(frame) == rows and len(frame.columns) == len(answer.to_dict())
