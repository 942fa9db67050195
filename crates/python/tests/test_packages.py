"""What other packages call a mesh, a pose or a file is taken as it is."""

from __future__ import annotations

import io
import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from parry_continuum import (
    BendingMotion,
    ContinuumError,
    Mesh,
    MovingBase,
    RigidMotion,
    RobotPair,
    Scene,
    load,
    load_centreline,
)
from shapes import robots, sphere

VERTICES, FACES = sphere()
MESH = Mesh(VERTICES, FACES)
MANY = robots(np.random.default_rng(7), 4)
ONE = MANY[0]


def is_sphere(mesh: Mesh) -> None:
    assert len(mesh.faces) == len(FACES)
    assert_allclose(mesh.distance(MANY, 0.1), MESH.distance(MANY, 0.1), atol=1e-5)


@pytest.mark.parametrize("take", [Mesh, load])
def test_trimesh(take: Any) -> None:
    trimesh = pytest.importorskip("trimesh")
    whole = trimesh.Trimesh(VERTICES, FACES, process=False)
    is_sphere(take(whole))
    scene = trimesh.Scene()
    scene.add_geometry(whole, transform=np.diag([2.0, 2, 2, 1]))
    scene.add_geometry(trimesh.creation.box(extents=[1, 1, 1]), transform=trimesh.transformations.translation_matrix([50, 0, 0]))
    mesh = take(scene)
    assert len(mesh.faces) == len(FACES) + 12
    assert_allclose(np.linalg.norm(mesh.vertices[np.linalg.norm(mesh.vertices, axis=1) < 40], axis=1), 20)
    assert mesh.vertices[:, 0].max() == pytest.approx(50.5)
    with pytest.raises(ContinuumError):
        take(trimesh.Scene())


@pytest.mark.parametrize("take", [Mesh, load])
def test_a_mesh_that_states_another_frame_is_turned(take: Any) -> None:
    mesh = Mesh(VERTICES + [1, 2, 3], FACES, frame="RAS", unit="mm")
    turned = take(mesh, frame="LPS")
    assert turned.frame == "LPS"
    assert_allclose(turned.vertices, mesh.vertices * [-1, -1, 1])
    same = take(mesh, frame="RAS")
    assert same.frame == take(mesh).frame == "RAS"
    assert_allclose(same.vertices, mesh.vertices)
    assert Mesh(mesh, frame="LPS").unit == "mm"
    # A mesh that states none takes the frame as it is.
    assert_allclose(take(MESH, frame="LPS").vertices, MESH.vertices)


@pytest.mark.parametrize("take", [Mesh, load])
def test_pyvista(take: Any) -> None:
    pyvista = pytest.importorskip("pyvista")
    flat = np.column_stack([np.full(len(FACES), 3), FACES]).ravel()
    surface = pyvista.PolyData(VERTICES, flat)
    is_sphere(take(surface))
    is_sphere(take(surface.strip()))
    # Polygons whose outlines cross keep all their triangles, in faces of one size and of several.
    crossed = np.array([[0, 0, 0], [4, 0, 0], [1, 3, 0], [6, 3, 0.0]])
    for more in ([], [3, 0, 1, 2]):
        assert len(take(pyvista.PolyData(crossed, [4, 0, 1, 2, 3, *more])).faces) == 2 + bool(more)
    box = pyvista.Box()  # of quadrilaterals
    assert len(take(box).faces) == 12
    assert len(take(surface.cast_to_unstructured_grid()).faces) == len(FACES)
    with pytest.raises(ContinuumError, match=r"the mesh is a MultiBlock; give one of its blocks, .*combine\(\)") as raised:
        take(pyvista.MultiBlock([surface, box]))
    assert raised.value.kind == "bad_type"
    assert len(take(pyvista.MultiBlock([surface, box]).combine().extract_surface()).faces) == len(FACES) + 12


@pytest.mark.parametrize("take", [Mesh, load])
def test_meshio(take: Any) -> None:
    meshio = pytest.importorskip("meshio")
    half = len(FACES) // 2
    is_sphere(take(meshio.Mesh(VERTICES, [("triangle", FACES[:half]), ("line", FACES[:3, :2]), ("triangle", FACES[half:])])))
    with pytest.raises(ContinuumError, match="cells of the type tetra; give its surface, cut into triangles") as raised:
        take(meshio.Mesh(VERTICES, [("tetra", [[0, 1, 2, 3]])]))
    assert raised.value.kind == "bad_type"
    with pytest.raises(ContinuumError) as raised:
        take(meshio.Mesh(VERTICES, [("line", [[0, 1]])]))
    assert raised.value.kind == "empty"


def area(mesh: Mesh) -> float:
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


@pytest.mark.parametrize("take", [Mesh, load])
def test_polygons_of_meshio(take: Any) -> None:
    meshio = pytest.importorskip("meshio")
    square = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0.0]])
    for turn in range(4):
        quads = take(meshio.Mesh(square, [("quad", [np.roll([0, 1, 2, 3], turn)])]))
        assert (len(quads.faces), area(quads)) == (2, 4.0)
        dart = square.copy()
        dart[2] = [0.5, 0.5, 0]  # concave there: one diagonal is outside
        assert area(take(meshio.Mesh(dart, [("quad", [np.roll([0, 1, 2, 3], turn)])]))) == pytest.approx(1.0)
    corner = np.array([[0, 0, 0], [4, 0, 0], [4, 1, 0], [1, 1, 0], [1, 4, 0], [0, 4, 0.0]])  # an L
    found = take(meshio.Mesh(corner, [("polygon", [[0, 1, 2, 3, 4, 5]])]))
    assert_array_equal(found.vertices, corner)
    assert (len(found.faces), area(found)) == (4, pytest.approx(7.0))
    normals = np.cross(*(corner[found.faces[:, k]] - corner[found.faces[:, 0]] for k in (1, 2)))
    assert (normals[:, 2] > 0).all()
    mixed = [("vertex", [[0]]), ("line", [[0, 1]]), ("triangle", [[0, 1, 3]]), ("quad", [[0, 3, 4, 5]]), ("triangle", [[1, 2, 3]])]
    assert len(take(meshio.Mesh(corner, mixed)).faces) == 4


@pytest.mark.parametrize("take", [Mesh, load])
def test_open3d(take: Any) -> None:
    """Open3D is large, so that its two classes are stood in for where it is not installed."""
    try:
        import open3d
    except ImportError:
        legacy = SimpleNamespace(vertices=[tuple(v) for v in VERTICES], triangles=[tuple(f) for f in FACES])
        tensor = lambda array: SimpleNamespace(cpu=lambda: SimpleNamespace(numpy=lambda: array))
        new = SimpleNamespace(vertex=SimpleNamespace(positions=tensor(VERTICES)), triangle=SimpleNamespace(indices=tensor(FACES)))
    else:
        legacy = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(VERTICES), open3d.utility.Vector3iVector(FACES))
        new = open3d.t.geometry.TriangleMesh.from_legacy(legacy)
    is_sphere(take(legacy))
    is_sphere(take(new))


def obj(folder: Path) -> Path:
    file = folder / "wall.obj"
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in VERTICES.tolist()]
    file.write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in (FACES + 1).tolist()]))
    return file


def test_paths_and_files(tmp_path: Path) -> None:
    path = obj(tmp_path)
    for given in (path, str(path), os.fsencode(path)):
        assert_array_equal(load(given).vertices, VERTICES)
    for mode in ("rb", "r"):
        with path.open(mode) as file:
            assert_array_equal(load(file, scale=2, frame="LPS").vertices, VERTICES * 2)
    named = io.BytesIO(path.read_bytes())
    with pytest.raises(ContinuumError, match="a file object without a name.*file.name = 'wall.stl'") as raised:
        load(named)
    assert raised.value.kind == "bad_type"
    named.name = "wall.obj"  # type: ignore[misc]
    assert_array_equal(load(named).vertices, VERTICES)
    named.seek(0)
    named.name = "wall.stl"  # type: ignore[misc]
    with pytest.raises(ContinuumError, match="wall.stl"):
        load(named)
    empty = io.BytesIO()
    empty.name = "wall.obj"  # type: ignore[misc]
    with pytest.raises(ContinuumError, match="wall.obj holds no triangles"):
        load(empty)
    named.name = "wall.obj"  # type: ignore[misc]
    named.seek(0, io.SEEK_END)
    for read in (load, load_centreline):
        with pytest.raises(ContinuumError, match=r"`path` is a file object at its end; call its `seek\(0\)` first") as raised:
            read(named)
        assert raised.value.kind == "bad_type"


def test_centrelines_of_files(tmp_path: Path) -> None:
    path = tmp_path / "robot.csv"
    path.write_text("0,0,0\n0,0,1\n0,0,2\n")
    for given in (path, str(path), os.fsencode(path)):
        assert load_centreline(given).points.shape == (3, 3)
    with path.open("rb") as file:
        assert_array_equal(load_centreline(file, scale=2).points[:, 2], [0, 2, 4])
    with path.open() as text:
        assert_array_equal(load_centreline(text).points[:, 2], [0, 1, 2])


class Fails:
    name = "wall.obj"

    def read(self) -> bytes:
        raise OSError("the tape is torn")


@pytest.mark.parametrize(
    ("ask", "error", "text"),
    [
        (lambda: load(3), ContinuumError, "`path` is neither a path nor a file object"),
        (lambda: load(None), ContinuumError, "`path` is neither"),
        (lambda: load_centreline(None), ContinuumError, "`path` is neither"),
        (lambda: load_centreline(MESH), ContinuumError, "`path` is a mesh"),
        (lambda: load(MESH, label=1), ContinuumError, "`label` is given beside a mesh"),
        (lambda: load(Fails()), OSError, "the tape is torn"),
        (lambda: load(SimpleNamespace(name="a.stl", read=lambda: 3)), TypeError, "str"),
        (lambda: Mesh(SimpleNamespace(points=3)), ContinuumError, "a mesh of trimesh, pyvista, meshio or Open3D"),
        (lambda: Mesh(VERTICES), ContinuumError, "`faces` is missing"),
        (lambda: Mesh(None), ContinuumError, "`faces` is missing"),
    ],
)
def test_wrong_types(ask: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        ask()


def test_a_mesh_of_this_package_is_loaded_scaled() -> None:
    mesh = load(MESH, scale=3, frame="RAS")
    assert_array_equal(mesh.vertices, VERTICES * 3)
    assert mesh.frame == "RAS"


def transforms(count: int | None) -> tuple[Any, np.ndarray]:
    spatial = pytest.importorskip("scipy.spatial.transform")
    rotations = spatial.Rotation.random(count, random_state=5)
    shape = () if count is None else (count,)
    matrices = np.zeros((*shape, 4, 4))
    matrices[..., :3, :3] = rotations.as_matrix()
    matrices[..., 3, 3] = 1
    return rotations, matrices


@pytest.mark.parametrize("count", [None, 1, 4])
def test_rotations(count: int | None) -> None:
    rotations, matrices = transforms(count)
    assert_array_equal(MESH.distance(ONE, 0.1, pose=rotations), MESH.distance(ONE, 0.1, pose=matrices))
    if hasattr(pytest.importorskip("scipy.spatial.transform"), "RigidTransform"):
        from scipy.spatial.transform import RigidTransform

        shift = np.broadcast_to([1.0, 2, 3], matrices[..., :3, 3].shape)
        rigid = RigidTransform.from_components(shift, rotations)
        matrices = matrices.copy()
        matrices[..., :3, 3] = shift
        assert_allclose(MESH.distance(ONE, 0.1, pose=rigid), MESH.distance(ONE, 0.1, pose=matrices), atol=1e-15)
        rotations = rigid
    for ask in (
        lambda pose: MESH.per_link(ONE, 0.1, pose=pose).distance,
        lambda pose: RobotPair().minimum(ONE, 0.1, ONE + 5, 0.1, pose_b=pose).distance,
        lambda pose: MESH.clearance_of_motion(RigidMotion(ONE, 0.1, np.eye(4), pose), tolerance=0.5).lower,
        lambda pose: MESH.clearance_of_motion(MovingBase(BendingMotion([[1, 0, 0]], [[1, 0, 0]], 0.1), pose, pose), tolerance=0.5).lower,
        lambda pose: Scene(robot_margin=0.1).tightest([(ONE, 0.1, pose), (ONE, 0.1)]).slack,
    ):
        assert_allclose(ask(rotations), ask(matrices), atol=1e-14)
    if count is None:
        scene = Scene()
        scene.add("wall", MESH, margin=0.1, pose=rotations)
        assert scene.tightest([(ONE, 0.1)]).structure == 0


@pytest.mark.parametrize("kind", ["Rotation", "RigidTransform"])
def test_lists_of_transforms(kind: str) -> None:
    rotations, matrices = transforms(4)
    spatial = pytest.importorskip("scipy.spatial.transform")
    if kind == "RigidTransform":
        if not hasattr(spatial, kind):
            pytest.skip("an older scipy")
        rotations = spatial.RigidTransform.from_rotation(rotations)
    for given in ([rotations[k] for k in range(4)], tuple(rotations[k] for k in range(4))):
        assert_allclose(MESH.distance(ONE, 0.1, pose=given), MESH.distance(ONE, 0.1, pose=matrices), atol=1e-15)
        assert RigidMotion(ONE, 0.1, given, np.eye(4)).count == 4
    with pytest.raises(ContinuumError, match="`pose`"):
        MESH.distance(ONE, 0.1, pose=[rotations[0], np.eye(4)])


def test_lists_are_poses() -> None:
    rows = [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert MESH.distance(ONE, 0.1, pose=rows) == MESH.distance(ONE, 0.1, pose=np.array(rows, float))
    assert MESH.distance(ONE, 0.1, pose=[rows, rows]).shape == (2,)
    with pytest.raises(ContinuumError, match="`pose` is no array of numbers"):
        MESH.distance(ONE, 0.1, pose=rows[:3] + [[0, 0]])


class NoMatrix:
    def as_matrix(self) -> np.ndarray:
        raise RuntimeError("mine")


def test_what_a_pose_raises_is_raised() -> None:
    with pytest.raises(RuntimeError, match="mine"):
        MESH.distance(ONE, 0.1, pose=NoMatrix())
    with pytest.raises(ContinuumError, match=r"`pose_b` has the shape \(2, 2\)"):
        RobotPair().minimum(ONE, 0.1, ONE, 0.1, pose_b=SimpleNamespace(as_matrix=lambda: np.eye(2)))
