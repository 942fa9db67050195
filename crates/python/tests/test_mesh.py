"""What a mesh is made of, how it moves, is copied and is sent."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import ContinuumError, Mesh, load, simplify
from shapes import robots, sphere

VERTICES, FACES = sphere()
ROBOTS = robots(np.random.default_rng(2), 25)


@pytest.mark.parametrize("dtype", ["i2", "i4", "i8", "u1", "u4", "u8", ">i4"])
def test_any_integers(dtype: str) -> None:
    few = FACES[(FACES < 128).all(axis=1)]
    mesh = Mesh(VERTICES.astype("f4"), np.asfortranarray(few.astype(dtype)))
    assert_array_equal(mesh.faces, few)
    assert mesh.faces.dtype == np.int64 and mesh.vertices.dtype == np.float64


def test_what_has_vertices_and_faces() -> None:
    mesh = Mesh(SimpleNamespace(vertices=VERTICES, faces=FACES))
    again = Mesh(mesh)
    assert_array_equal(again.vertices, VERTICES)
    assert_array_equal(again.faces, FACES)
    assert repr(again) == f"Mesh({len(VERTICES)} vertices, {len(FACES)} faces)"


@pytest.mark.parametrize(
    ("make", "kind", "index"),
    [
        (lambda: Mesh(VERTICES, [[0, 1, 2], [0, 1, 266]]), "no_such_vertex", 1),
        (lambda: Mesh(VERTICES, [[0, -1, 2]]), "no_such_vertex", 0),
        (lambda: Mesh(VERTICES, np.array([[0, 1, 2**64 - 1]], "u8")), "no_such_vertex", 0),
        (lambda: Mesh(VERTICES, [[0.0, 1.0, 2.0]]), "bad_type", None),
        (lambda: Mesh(VERTICES, FACES.T), "bad_shape", None),
        (lambda: Mesh(VERTICES, [[0, 1, 2, 3]]), "bad_shape", None),
        (lambda: Mesh(VERTICES, []), "empty", None),
        (lambda: Mesh(VERTICES, np.zeros((0, 3), int)), "empty", None),
        (lambda: Mesh(VERTICES.T, FACES), "bad_shape", None),
        (lambda: Mesh(VERTICES), "bad_type", None),
        (lambda: Mesh(np.where(VERTICES > 9.9, np.inf, VERTICES), FACES), "not_finite", 0),
        (lambda: Mesh(VERTICES * 1e300, FACES), "out_of_range", 0),
        (lambda: Mesh(VERTICES, FACES).set_vertices(VERTICES[1:]), "vertex_count", None),
        (lambda: Mesh(VERTICES, FACES).set_vertices(VERTICES * np.nan), "not_finite", 0),
        (lambda: load("there/is/none.stl"), "file", None),
        (lambda: load("none.txt"), "file", None),
    ],
)
def test_refused(make: object, kind: str, index: int | None) -> None:
    with pytest.raises(ContinuumError) as raised:
        make()  # type: ignore[operator]
    assert (raised.value.kind, raised.value.index) == (kind, index)


def test_load(tmp_path: Path) -> None:
    file = tmp_path / "wall.obj"
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in VERTICES.tolist()]
    file.write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in (FACES + 1).tolist()]))
    mesh = load(file)
    assert_array_equal(mesh.vertices, VERTICES)
    assert_array_equal(mesh.faces, FACES)
    assert_array_equal(load(str(file), scale=1000).vertices, VERTICES * 1000)
    with pytest.raises(ContinuumError, match="label"):
        load(file, label=3)


def test_move() -> None:
    mesh = Mesh(VERTICES, FACES)
    mesh.prepare()
    before = mesh.per_link(ROBOTS, 0.1)
    moved = VERTICES * [1.0, 1.2, 0.9] + [0.5, 0, 0]
    assert mesh.set_vertices(moved) is None
    assert_array_equal(mesh.vertices, moved)
    for field, fresh in zip(mesh.per_link(ROBOTS, 0.1), Mesh(moved, FACES).per_link(ROBOTS, 0.1)):
        assert_array_equal(field, fresh)
    with pytest.raises(ContinuumError):
        mesh.set_vertices(moved * np.nan)
    assert_array_equal(mesh.vertices, moved)
    mesh.set_vertices(VERTICES)
    assert_array_equal(mesh.per_link(ROBOTS, 0.1).distance, before.distance)


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda mesh: pickle.loads(pickle.dumps(mesh))])
def test_copies(copied: object) -> None:
    mesh = Mesh(VERTICES, FACES)
    other = copied(mesh)  # type: ignore[operator]
    assert_array_equal(other.distance(ROBOTS, 0.1), mesh.distance(ROBOTS, 0.1))
    other.set_vertices(VERTICES + 1)
    assert_array_equal(mesh.vertices, VERTICES)
    mesh.set_vertices(VERTICES - 1)
    assert_array_equal(other.vertices, VERTICES + 1)


def test_errors_are_sent() -> None:
    error = ContinuumError("text", "kind", robot=3, index=4, possible=0.5)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), vars(again)) == ("text", vars(error))


def test_fewer_points() -> None:
    straight = np.linspace([0, 0, 0], [0, 0, 9], 30)
    points, radii = simplify(straight, 0.5, tolerance=0.01)
    assert_array_equal(points, straight[[0, -1]])
    assert radii.tolist() == [0.5]
    with pytest.raises(ContinuumError):
        simplify(straight, 0.5, tolerance=-1.0)
    with pytest.raises(ContinuumError):
        simplify(straight[None], 0.5, tolerance=0.01)
