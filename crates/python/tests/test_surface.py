"""Meshes that are open or badly joined, and robots that leave through an opening."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from parry_continuum import ContinuumError, Mesh, Side, load
from shapes import Array, sphere

# A box of 60, whose last two triangles are the side x = 60.
CORNERS = np.array([[60.0 * (k & 1), 30.0 * (k & 2), 15.0 * (k & 4)] for k in range(8)])
QUADS = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
FACES = np.array([[a, b, c] for a, *rest in QUADS for b, c in zip(rest, rest[1:])])
CLOSED, OPEN = Mesh(CORNERS, FACES), Mesh(CORNERS, FACES[:-2])
LEAVES = np.array([[30.0, 30, 30], [50, 30, 30], [70, 30, 30], [130, 30, 30]])


def obj(path: Path, faces: Array) -> Path:
    lines = [f"v {x} {y} {z}" for x, y, z in CORNERS] + ["f {} {} {}".format(*(face + 1)) for face in faces]
    path.write_text("\n".join(lines))
    return path


def test_a_surface_is_described() -> None:
    assert CLOSED.surface().is_sound
    surface = OPEN.surface()
    assert not surface.is_sound and (surface.nonmanifold_edges, surface.misoriented_edges) == (0, 0)
    assert_allclose(surface.width, [60 * np.sqrt(2)])
    assert_allclose(surface.centre, [[60, 30, 30]])
    assert_array_equal(surface.edges, [4])
    turned = FACES.copy()
    turned[0] = turned[0][::-1]
    assert Mesh(CORNERS, turned).surface().misoriented_edges == 3
    doubled = Mesh(CORNERS, np.concatenate([FACES, FACES[:1]])).surface()
    assert (doubled.nonmanifold_edges, len(doubled.width)) == (3, 0)
    with pytest.raises(TypeError, match="is_sound"):
        bool(surface)
    # It follows the vertices.
    mesh = Mesh(CORNERS, FACES[:-2])
    mesh.surface()
    mesh.set_vertices(CORNERS * 2)
    assert_allclose(mesh.surface().width, [120 * np.sqrt(2)])


def test_load_and_doubts_announce_an_open_mesh(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match=r"open.obj: the mesh is open: one opening 84.85 wide at \(60, 30, 30\)"):
        mesh = load(obj(tmp_path / "open.obj", FACES[:-2]))
    assert [doubt.startswith("the mesh is open: ") for doubt in mesh.doubts(LEAVES, 1.0)] == [True]
    with pytest.warns(UserWarning, match="the mesh is open"):
        load(OPEN)
    turned = FACES.copy()
    turned[::2] = turned[::2, ::-1]
    with pytest.warns(UserWarning, match="edges whose triangles face opposite ways"):
        load(obj(tmp_path / "turned.obj", turned))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert load(obj(tmp_path / "closed.obj", FACES)).doubts(LEAVES - [20, 0, 0], 1.0) == []


def test_a_robot_that_leaves_is_not_inside() -> None:
    within = LEAVES * [0.3, 1, 1] + [5, 0, 0]
    answer = OPEN.clears_inside(np.stack([LEAVES, within]), 1.0, margin=2.0)
    assert_array_equal(answer.clears, [True, True])
    assert_array_equal(answer.holds, [False, True])
    assert_array_equal(answer.crosses_opening, [True, False])
    assert list(answer.base) == [Side.INSIDE, Side.INSIDE] and list(answer.tip) == [Side.OUTSIDE, Side.UNDECIDED]
    alone = OPEN.clears_inside(LEAVES, 1.0, margin=2.0)
    assert alone.holds is False and OPEN.clears_inside(within, 1.0, margin=2.0).holds is True
    assert list(OPEN.link_sides(LEAVES, 1.0)) == [Side.INSIDE, Side.UNDECIDED, Side.OUTSIDE]
    both = OPEN.link_sides(np.stack([LEAVES, within]), 1.0)
    assert both.shape == (2, 3) and both.is_inside[1].all() and not both.is_inside[0].all()
    # Through the wall; and a segment without length, which is no link.
    through = OPEN.link_sides([[30, 30, 30], [30, 30, 30], [30, 30, 50], [30, 30, 90], [30, 30, 99]], 1.0)
    assert list(through) == [Side.UNDECIDED, Side.INSIDE, Side.UNDECIDED, Side.OUTSIDE]
    assert OPEN.link_sides(np.zeros((0, 4, 3)), 1.0).shape == (0, 3)
    moved = OPEN.link_sides(LEAVES, 1.0, pose=np.array([[1, 0, 0, -20], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]))
    assert list(moved) == [Side.INSIDE, Side.INSIDE, Side.UNDECIDED]
    with pytest.raises(ContinuumError, match=r"`points` has the shape \(4, 2\)"):
        OPEN.link_sides(LEAVES[:, :2], 1.0)


def test_sides_agree_on_all_cores() -> None:
    """A batch and one by one; in a closed mesh, a link that touches nothing has the side of its ends."""
    random = np.random.default_rng(7)
    ball = Mesh(*sphere())
    robots = random.uniform(-12, 12, (60, 1, 3)) + np.cumsum(random.normal(size=(60, 5, 3)), axis=1)
    sides, free = ball.link_sides(robots, 0.2), ball.per_link(robots, 0.2).distance > 0
    assert_array_equal(sides, np.stack([ball.link_sides(robot, 0.2) for robot in robots]))
    assert_array_equal(sides[free].astype(int), ball.side(robots[:, 1:])[free].astype(int))
    assert (sides[~free].astype(int) == 0).all() and 20 < free.sum() < free.size - 20


def test_the_first_question_about_sides_warns_of_triangles_that_face_both_ways() -> None:
    turned = FACES.copy()
    turned[::2] = turned[::2, ::-1]
    inside = LEAVES[:2]
    for ask in (
        lambda mesh: mesh.side(inside[0]),
        lambda mesh: mesh.link_sides(inside, 1.0),
        lambda mesh: mesh.clears_inside(inside, 1.0, margin=1),
    ):
        mesh = Mesh(CORNERS, turned)
        with pytest.warns(UserWarning, match="edges whose triangles face opposite ways") as found:
            ask(mesh)
        assert len(found) == 1
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            ask(mesh)
            # Faces that all look inward, and openings, which the answers themselves tell.
            ask(Mesh(CORNERS, FACES[:, ::-1]))
            ask(OPEN)
