"""Robots of sections of constant curvature: the answers are those about points that numpy computes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from parry_continuum import ContinuumError, Mesh
from shapes import Array, sphere

MESH = Mesh(*sphere())
SEGMENTS = 5


def points_of(sections: Array, segments: int) -> Array:
    """The points of a robot: small steps of Rodrigues' formula."""
    at, frame, points = np.zeros(3), np.eye(3), [np.zeros(3)]
    steps = 4096 // segments
    for length, x, y in sections:
        step = length / segments / steps
        turn = np.array([-y, x, 0]) * step
        angle = np.linalg.norm(turn)
        cross = np.cross(np.eye(3), turn)
        # The rotation by a step, and by half of it.
        whole, half = (
            np.eye(3) + np.sinc(s * angle / np.pi) * s * cross.T + 0.5 * (s * np.sinc(s * angle / 2 / np.pi)) ** 2 * cross.T @ cross.T
            for s in (1.0, 0.5)
        )
        for _ in range(segments):
            for _ in range(steps):
                at = at + frame @ half @ [0, 0, step]
                frame = frame @ whole
            points.append(at)
    return np.array(points)


def some(count: int, sections: int, seed: int) -> Array:
    """Sections whose robots begin at the centre of the sphere and reach or cross its wall."""
    rng = np.random.default_rng(seed)
    reach = 2.5 * np.abs(MESH.vertices).max() / sections
    length = reach * rng.uniform(0.1, 1.0, (count, sections))
    curvature, angle = rng.uniform(0, 3, (count, sections)) / length, rng.uniform(0, 2 * np.pi, (count, sections))
    return np.stack([length, curvature * np.cos(angle), curvature * np.sin(angle)], axis=2)


@pytest.mark.parametrize("sections", [1, 3])
def test_answers_are_those_about_points(sections: int) -> None:
    given = some(30, sections, sections)
    radii = np.linspace(0.3, 0.1, sections)
    points = np.array([points_of(robot, SEGMENTS) for robot in given])
    pose = np.array([[0.0, 0, 1, 0.5], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    distances = MESH.distance(points, np.repeat(radii, SEGMENTS), pose=pose)
    for margin in (0.01, float(np.median(distances[distances > 0.01]))):
        clear = MESH.clears_sections(given, radii, segments=SEGMENTS, margin=margin, pose=pose)
        # The steps of the points err by about 1e-7 of their length.
        sure = np.abs(distances - margin) > 1e-5
        assert sure.sum() > 28 and 0 < clear.sum() < 30
        np.testing.assert_array_equal(clear[sure], (distances > margin)[sure])
        # One by one, with radii of each, and with a batch of one pose.
        one = MESH.clears_sections(given[7], radii, segments=SEGMENTS, margin=margin, pose=pose[None])
        assert one is bool(clear[7])
        each = np.broadcast_to(radii, (30, sections))
        np.testing.assert_array_equal(MESH.clears_sections(given, each, segments=SEGMENTS, margin=margin, pose=pose), clear)


def test_batches_of_none_and_one_radius() -> None:
    assert MESH.clears_sections(np.empty((0, 2, 3)), 0.1, segments=3, margin=0.5).shape == (0,)
    assert MESH.clears_sections([[0.1, 0, 0]], 0.1, segments=1, margin=0.0) is True


GOOD = some(5, 2, 9)


def bad(place: tuple[int, ...], value: float) -> Array:
    changed = GOOD.copy()
    changed[place] = value
    return changed


@pytest.mark.parametrize(
    "sections, radii, more, kind, robot, word",
    [
        (bad((3, 1, 0), -1.0), 0.1, {}, "bad_length", 3, "`sections`"),
        (bad((4, 0, 0), 0.0), 0.1, {}, "bad_length", 4, "`sections`"),
        (bad((0, 0, 1), np.nan), 0.1, {}, "bad_curvature", 0, "`sections`"),
        (GOOD, -0.1, {}, "bad_radius", 0, "`radii`"),
        (GOOD, [0.1, 0.1, 0.1], {}, "bad_shape", None, "`radii`"),
        (GOOD[:, :, :2], 0.1, {}, "bad_shape", None, "`sections`"),
        (np.empty((2, 0, 3)), 0.1, {}, "no_sections", None, "`sections`"),
        (np.empty((0, 3)), 0.1, {}, "no_sections", None, "`sections`"),
        (GOOD, np.full((4, 2), 0.1), {}, "bad_shape", None, "`radii`"),
        (GOOD, 0.1, {"margin": -1.0}, "negative", None, "`margin`"),
        (GOOD, 0.1, {"pose": np.full((4, 4), np.nan)}, "not_finite", None, "`pose`"),
        (GOOD, 0.1, {"pose": np.stack([np.eye(4)] * 5)}, "bad_shape", None, "`pose`"),
        (GOOD, 0.1, {"pose": 2 * np.eye(4)}, "", None, "`pose`"),
    ],
)
def test_refused(sections: Any, radii: Any, more: dict[str, Any], kind: str, robot: int | None, word: str) -> None:
    with pytest.raises(ContinuumError) as caught:
        MESH.clears_sections(sections, radii, **{"segments": 3, "margin": 0.1, **more})
    assert caught.value.robot == robot and word in str(caught.value), caught.value
    assert not kind or caught.value.kind == kind, caught.value.kind


@pytest.mark.parametrize("segments", [0, -1, 1.5, True, None, "3"])
def test_segments_are_a_whole_number(segments: Any) -> None:
    with pytest.raises(TypeError, match="`segments`"):
        MESH.clears_sections(GOOD, 0.1, segments=segments, margin=0.1)
