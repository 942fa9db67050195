"""What pyvista gets is the mesh, and the robot as the queries see it."""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from parry_continuum import ContinuumError, Mesh, to_pyvista
from shapes import Array, poses, robots, sphere

CAPS = ("fitted", "capsules", "cylinders")


class Surface(SimpleNamespace):
    """Stands for pyvista's class, which has the corners in one line, each face after their number."""

    def __init__(self, points: Array, faces: Any) -> None:
        super().__init__(points=points, faces=faces, cell_data={})


@pytest.fixture(params=["itself", "its class"])
def pyvista(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Any:
    """pyvista is large: without it, only what it would get is looked at."""
    if request.param == "itself":
        return pytest.importorskip("pyvista")
    monkeypatch.setitem(sys.modules, "pyvista", SimpleNamespace(PolyData=Surface))
    return None


def triangles(surface: Any) -> Any:
    rows = np.asarray(surface.faces).reshape(-1, 4)
    assert (rows[:, 0] == 3).all()
    return rows[:, 1:]


def test_a_mesh(pyvista: Any) -> None:
    vertices, faces = sphere()
    surface = to_pyvista(Mesh(vertices, faces))
    assert_array_equal(surface.points, vertices)
    assert_array_equal(triangles(surface), faces)
    assert_array_equal(surface.cell_data["triangle"], np.arange(len(faces)))
    if pyvista:
        assert isinstance(surface, pyvista.PolyData) and surface.is_all_triangles
        assert_array_equal(Mesh(surface).faces, faces)


def reach(robot: Array, radii: Any, direction: Array, **more: Any) -> float:
    """How far a robot reaches in a direction, by its distance to a wide wall far ahead."""
    far = 100.0
    across = np.linalg.svd(direction[None])[2][1:]
    corners = far * direction + 1e4 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) @ across
    return far - float(Mesh(corners, [[0, 1, 2], [0, 2, 3]]).distance(robot, radii, **more))


@pytest.mark.parametrize("caps", CAPS)
def test_a_robot_reaches_as_far_as_in_queries(pyvista: Any, caps: Any) -> None:
    random = np.random.default_rng(11)
    differ = 0.0
    for robot in robots(random, 12, points=7, step=0.6):
        radii = random.choice([0.3, 0.9, 0.9, 1.4], 6)
        robot[3] = robot[2]  # a segment without length
        surface = to_pyvista(robot, radii, caps=caps)
        # The two ends, where a round cap reaches one radius farther, and other directions.
        ends = np.stack([robot[0] - robot[1], robot[-1] - robot[-2]])
        for direction in np.concatenate([ends, random.normal(size=(40, 3))]):
            direction = direction / np.linalg.norm(direction)
            shown = float((np.asarray(surface.points) @ direction).max())
            true = reach(robot, radii, direction, caps=caps)
            assert true - 0.02 * radii.max() <= shown <= true + 1e-9
            differ = max(differ, reach(robot, radii, direction, caps="capsules") - true)
    assert (differ > 0.5) == (caps != "capsules")  # other caps would be seen


def test_each_link_is_closed_and_faces_outward(pyvista: Any) -> None:
    radius = 0.5
    points = [[0, 0, 0], [0, 0, 4], [3, 0, 8]]
    # Both ends at the bend are filled, and four half balls are two balls.
    for caps, balls in zip(CAPS, (1, 2, 0)):
        surface = to_pyvista(points, radius, caps=caps)  # type: ignore[arg-type]
        a, b, c = np.asarray(surface.points)[triangles(surface)].swapaxes(0, 1)
        volume = np.sum(np.cross(a, b) * c) / 6
        whole = np.pi * radius**2 * (4 + 5) + balls * 4 / 3 * np.pi * radius**3
        assert 0.97 * whole < volume < whole
        edges = np.concatenate([triangles(surface)[:, [k, (k + 1) % 3]] for k in range(3)])
        ways, counts = np.unique(edges, axis=0, return_counts=True)
        assert (counts == 1).all()
        assert {tuple(way) for way in ways} == {tuple(way[::-1]) for way in ways}


def test_segments_are_numbered_as_in_answers(pyvista: Any) -> None:
    points = [[0, 0, 0], [0, 0, 2], [0, 0, 2], [0, 0, 5]]
    surface = to_pyvista(points, 0.5)
    heights = np.asarray(surface.points)[triangles(surface)].mean(axis=1)[:, 2]
    segment = np.asarray(surface.cell_data["segment"])
    assert set(segment.tolist()) == {0, 2}
    assert (heights[segment == 0] < 2.6).all() and (heights[segment == 2] > 1.4).all()


def test_links_of_radius_0_have_no_surface(pyvista: Any) -> None:
    surface = to_pyvista([[0, 0, 0], [0, 0, 2], [0, 0, 5]], [0.5, 0.0])
    assert set(np.asarray(surface.cell_data["segment"]).tolist()) == {0}


def test_a_pose(pyvista: Any) -> None:
    random = np.random.default_rng(3)
    robot, (pose,) = robots(random, 1)[0], poses(random, 1)
    there = robot @ pose[:3, :3].T + pose[:3, 3]
    for given in (pose, pose.tolist(), SimpleNamespace(as_matrix=lambda: pose)):
        shown = np.asarray(to_pyvista(robot, 0.2, pose=given).points)
        assert_allclose(shown, np.asarray(to_pyvista(there, 0.2).points), atol=1e-5)
    turn = SimpleNamespace(as_matrix=lambda: pose[:3, :3])
    shown = np.asarray(to_pyvista(robot, 0.2, pose=turn).points)
    assert_allclose(shown, np.asarray(to_pyvista(robot @ pose[:3, :3].T, 0.2).points), atol=1e-5)


@pytest.mark.parametrize(
    ("ask", "text", "kind"),
    [
        (lambda: to_pyvista(np.zeros((4, 3))), "`radii` is missing", "bad_type"),
        (lambda: to_pyvista(Mesh(*sphere()), 0.5), "beside a mesh", "bad_type"),
        (lambda: to_pyvista(Mesh(*sphere()), caps="capsules"), "beside a mesh", "bad_type"),
        (lambda: to_pyvista(robots(np.random.default_rng(1), 2), 0.1), "one robot, and 2 are given", "bad_shape"),
        (lambda: to_pyvista([[0, 0, 0], [0, 0, np.nan]], 0.1), "not finite", "point_not_finite"),
    ],
)
def test_wrong_arguments_are_named(pyvista: Any, ask: Any, text: str, kind: str) -> None:
    with pytest.raises(ContinuumError, match=text) as raised:
        ask()
    assert raised.value.kind == kind


def test_without_pyvista_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"pip install 'parry-continuum\[pyvista\]'"):
        to_pyvista(Mesh(*sphere()))
