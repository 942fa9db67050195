"""Certificates are about the answer that was given: one that does not fit is refused, however plausible."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from parry_continuum import ContinuumError, Mesh, RobotPair, SelfQuery
from shapes import poses, robots, sphere

RANDOM = np.random.default_rng(8)
MESH = Mesh(*sphere())
PAIR = RobotPair()
MANY = robots(RANDOM, 4)
POSES = poses(RANDOM, 4)
SECOND = robots(RANDOM, 4, points=7)
MANY[2, 5] = MANY[2, 4]  # a segment without length
ANSWER = MESH.per_link(MANY, 0.2, pose=POSES)
BETWEEN = PAIR.minimum(MANY, 0.2, SECOND, 0.1, pose_a=POSES)
LINKS = PAIR.per_link(MANY, 0.2, SECOND, 0.1, pose_a=POSES)
HOOK = [[0, 0, 0], [0, 0, 9], [2, 0, 11], [4, 0, 9], [4, 0, 0]]


def test_own_answers_are_certified() -> None:
    proof = MESH.certify(MANY, 0.2, ANSWER, pose=POSES)
    has_length = np.isfinite(ANSWER.distance)
    assert has_length.sum() == 43 and np.isnan(proof.lower[~has_length]).all()
    gap = 1e-12
    for answer, proof in (
        (ANSWER, proof),
        (BETWEEN, PAIR.certify(MANY, 0.2, SECOND, 0.1, BETWEEN, pose_a=POSES)),
        (LINKS, PAIR.certify(MANY, 0.2, SECOND, 0.1, LINKS, pose_a=POSES)),
    ):
        known = np.isfinite(answer.distance)
        assert (proof.lower[known] - gap <= answer.distance[known]).all()
        assert (answer.distance[known] <= proof.upper[known] + gap).all()
        assert (proof.upper[known] - proof.lower[known] < gap).all()
    own = SelfQuery().minimum(HOOK, 0.5)
    proof = PAIR.certify(HOOK, 0.5, HOOK, 0.5, own)
    assert proof.lower <= 3.0 <= proof.upper + gap
    one = MESH.certify(MANY[0], 0.2, MESH.per_link(MANY[0], 0.2))
    assert one.lower.shape == (11,)
    none = MESH.certify(MANY[:0], 0.2, MESH.per_link(MANY[:0], 0.2))
    assert none.lower.shape == (0, 11)


ELSEWHERE = MANY + [0, 0, 1e-3]
OFF = 1e-6


@pytest.mark.parametrize(
    ("points", "radii", "pose"),
    [(ELSEWHERE, 0.2, POSES), (MANY, 0.2 + OFF, POSES), (MANY, 0.2, POSES[::-1]), (MANY, 0.2, None)],
)
def test_answers_for_another_robot(points: Any, radii: Any, pose: Any) -> None:
    with pytest.raises(ContinuumError, match=r"robot 0: the answer about link \d+ and triangle \d+ does not fit") as raised:
        MESH.certify(points, radii, ANSWER, pose=pose)
    assert (raised.value.kind, raised.value.robot) == ("answer_does_not_fit", 0)
    first = MESH.per_link(MANY[0], 0.2, pose=POSES[0])
    with pytest.raises(ContinuumError, match="does not fit them: its `"):
        MESH.certify(points[0], radii, first, pose=None if pose is None else pose[0])
    for answer in (BETWEEN, LINKS):
        with pytest.raises(ContinuumError, match=r"robot 0: the answer about the links \[\d+, \d+\] does not fit") as raised:
            PAIR.certify(points, radii, SECOND, 0.1, answer, pose_a=pose)
        assert raised.value.kind == "links_do_not_fit"


@pytest.mark.parametrize(
    ("second", "radii", "pose"), [(SECOND + OFF, 0.1, None), (SECOND, 0.1 + OFF, None), (SECOND, 0.1, POSES)]
)
def test_answers_for_another_second_robot(second: Any, radii: Any, pose: Any) -> None:
    with pytest.raises(ContinuumError, match="does not fit") as raised:
        PAIR.certify(MANY, 0.2, second, radii, BETWEEN, pose_a=POSES, pose_b=pose)
    assert raised.value.kind == "links_do_not_fit"


def test_a_mesh_that_has_moved() -> None:
    mesh = Mesh(*sphere())
    mesh.set_vertices(mesh.vertices * 1.001)
    with pytest.raises(ContinuumError, match="does not fit"):
        mesh.certify(MANY, 0.2, ANSWER, pose=POSES)


@pytest.mark.parametrize("field", ["distance", "on_robot", "on_mesh", "triangle"])
def test_each_field_counts(field: str) -> None:
    values = getattr(ANSWER, field).copy()
    values[3, 7] += 1
    with pytest.raises(ContinuumError, match="robot 3") as raised:
        MESH.certify(MANY, 0.2, ANSWER._replace(**{field: values}), pose=POSES)
    assert raised.value.kind == "answer_does_not_fit"
    values = getattr(ANSWER, field).astype(float)
    values[1, 2] = np.nan
    if field != "triangle":
        with pytest.raises(ContinuumError, match="robot 1"):
            MESH.certify(MANY, 0.2, ANSWER._replace(**{field: values}), pose=POSES)


@pytest.mark.parametrize("off", [1e-9, 3.0, np.nan])
def test_arc_lengths_count(off: float) -> None:
    for one, proof in ((ANSWER._replace(arc_length=ANSWER.arc_length * 0), "arc_length"), (ANSWER, "")):
        values = one.arc_length.copy()
        values[3, 7] += 0 if proof else off
        with pytest.raises(ContinuumError, match=r"robot \d: `answer.arc_length` is .* for link \d+, where the place is at") as raised:
            MESH.certify(MANY, 0.2, one._replace(arc_length=values), pose=POSES)
        assert raised.value.kind == "answer_does_not_fit"
    for answer in (BETWEEN, LINKS):
        for which in (0, 1):
            lengths = answer.arc_lengths.copy()
            lengths[1, ..., which] += off
            with pytest.raises(ContinuumError, match="robot 1: `answer.arc_lengths` is"):
                PAIR.certify(MANY, 0.2, SECOND, 0.1, answer._replace(arc_lengths=lengths), pose_a=POSES)


def test_segments_without_length_have_no_numbers() -> None:
    for field in ("distance", "arc_length", "on_robot", "on_mesh", "triangle"):
        values = getattr(ANSWER, field).copy()
        values[2, 4] = 3
        with pytest.raises(ContinuumError, match="robot 2: `answer` has numbers for segment 4, which has no length") as raised:
            MESH.certify(MANY, 0.2, ANSWER._replace(**{field: values}), pose=POSES)
        assert raised.value.kind == "answer_does_not_fit"
    triangles = ANSWER.triangle.copy()
    triangles[1, 3] = -1
    with pytest.raises(ContinuumError, match="robot 1: `answer.triangle` is -1 for segment 3, which has a length"):
        MESH.certify(MANY, 0.2, ANSWER._replace(triangle=triangles), pose=POSES)


def test_no_segments_are_no_proof() -> None:
    for distance in (164.0, np.inf, np.nan):
        nowhere = PAIR.minimum(MANY[0], 0.2, SECOND[0], 0.1)._replace(distance=distance, segments=np.array([-1, -1]))
        with pytest.raises(ContinuumError, match="names no pair of links; there is nothing to certify") as raised:
            PAIR.certify(MANY[0], 0.2, SECOND[0], 0.1, nowhere)
        assert raised.value.kind == "answer_does_not_fit"
    with pytest.raises(ContinuumError, match="names no pair of links"):
        PAIR.certify(HOOK[:3], 0.5, HOOK[:3], 0.5, SelfQuery().minimum(HOOK[:3], 0.5))
    segments = LINKS.segments.copy()
    segments[1, 6] = -1
    with pytest.raises(ContinuumError, match="robot 1: .*row 6.* names no pair of links"):
        PAIR.certify(MANY, 0.2, SECOND, 0.1, LINKS._replace(segments=segments), pose_a=POSES)
    distances = LINKS.distance.copy()
    distances[2, 4] = 3.0
    with pytest.raises(ContinuumError, match="robot 2: `answer.distance` is 3.0 for segment 4, which has no length"):
        PAIR.certify(MANY, 0.2, SECOND, 0.1, LINKS._replace(distance=distances), pose_a=POSES)


@pytest.mark.parametrize("field", ["distance", "on_first", "on_second"])
def test_each_field_of_a_pair_counts(field: str) -> None:
    values = getattr(BETWEEN, field).copy()
    values[2] += 1e-6
    with pytest.raises(ContinuumError, match="robot 2: .* does not fit"):
        PAIR.certify(MANY, 0.2, SECOND, 0.1, BETWEEN._replace(**{field: values}), pose_a=POSES)


@pytest.mark.parametrize(
    ("ask", "text"),
    [
        (lambda: MESH.certify(MANY, 0.2, 3), "`answer` has no `triangle`; give what `per_link` returned"),
        (lambda: MESH.certify(MANY, 0.2, MESH.minimum(MANY, 0.2)), r"`answer.triangle` has the shape \(4,\), but .* \(4, 11\)"),
        (lambda: MESH.certify(MANY, 0.2, ANSWER._replace(distance=[1.0])), r"`answer.distance` has the shape \(1,\)"),
        (lambda: MESH.certify(MANY, 0.2, ANSWER._replace(on_mesh="x")), "`answer.on_mesh`"),
        (
            lambda: MESH.certify(MANY, 0.2, ANSWER._replace(triangle=ANSWER.triangle * 0 - 1)),
            "robot 0: `answer.triangle` is -1 for segment 0, which has a length; give what `per_link` returned",
        ),
        (lambda: MESH.certify(MANY, 0.2, ANSWER._replace(triangle=ANSWER.triangle + 10**9), pose=POSES), "triangle"),
        (lambda: PAIR.certify(MANY, 0.2, SECOND, 0.1, None), "`answer` has no `segments`; give what `minimum` returned"),
        (lambda: PAIR.certify(MANY, 0.2, SECOND, 0.1, BETWEEN._replace(distance=1.0)), r"`answer.distance` has the shape \(\)"),
        (
            lambda: PAIR.certify(MANY, 0.2, SECOND, 0.1, BETWEEN._replace(segments=BETWEEN.segments * 0 + 99)),
            "`answer.segments` names the segment 99 of `points_a`, which is no link",
        ),
        (
            lambda: PAIR.certify(MANY, 0.2, SECOND, 0.1, BETWEEN._replace(segments=BETWEEN.segments * [1, 0] + [0, -1])),
            "`answer.segments` names the segment -1 of `points_b`, which is no link",
        ),
    ],
)
def test_no_answer(ask: Any, text: str) -> None:
    with pytest.raises(ContinuumError, match=text):
        ask()
