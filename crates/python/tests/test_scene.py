"""Scenes beside the answers about each mesh and each pair of robots."""

from __future__ import annotations

import copy
import pickle
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import ContinuumError, Decision, LinearMotion, Mesh, RobotPair, Scene
from shapes import poses, robots, sphere

RANDOM = np.random.default_rng(61)
WALL = Mesh(*sphere(12.0))
VESSEL = Mesh(*sphere(1.0))
AWAY = poses(RANDOM, 1)[0]
AWAY[:3, 3] = [2, 1, -3]
A, B = robots(RANDOM, 60), robots(RANDOM, 60)
POSES = poses(RANDOM, 60)


def made(robot_margin: float | None = None) -> Scene:
    scene = Scene(robot_margin=robot_margin)
    assert scene.add("wall", WALL, margin=0.5) == 0
    assert scene.add("seen", VESSEL, margin=None) == 1
    assert scene.add("vessel", VESSEL, margin=2.0, pose=AWAY) == 2
    assert len(scene) == 3
    return scene


def slacks(robot_margin: float | None) -> np.ndarray:
    """What each pair has, (60, pairs)."""
    back = np.linalg.inv(AWAY)
    columns = []
    for points, pose in ((A, POSES), (B, np.tile(np.eye(4), (60, 1, 1)))):
        columns += [WALL.distance(points, 0.1, pose=pose) - 0.5, VESSEL.distance(points, 0.1, pose=back @ pose) - 2.0]
    if robot_margin is not None:
        columns.append(RobotPair().minimum(A, 0.1, B, 0.1, pose_a=POSES).distance - robot_margin)
    return np.stack(columns, axis=1)


@pytest.mark.parametrize("robot_margin", [None, 0.2])
def test_scenes(robot_margin: float | None) -> None:
    scene, expected = made(robot_margin), slacks(robot_margin)
    given = [(A, 0.1, POSES), (B, 0.1)]
    found = scene.tightest(given)
    np.testing.assert_allclose(found.slack, expected.min(axis=1), atol=1e-12)
    assert_array_equal(scene.clears(given), found.slack > 0)
    which = expected.argmin(axis=1)
    assert_array_equal(found.structure, np.array([0, 2, 0, 2, -1])[which])
    assert_array_equal(found.robots, np.array([[0, -1], [0, -1], [1, -1], [1, -1], [0, 1]])[which])
    assert len(set(which)) >= (4 if robot_margin is None else 5)
    ends = np.linalg.norm(found.on_first - found.on_second, axis=1)
    np.testing.assert_allclose(ends, found.distance, atol=1e-12)
    assert ((found.segments >= 0) == (found.robots >= 0)).all()
    for k in (0, 17):
        one = scene.tightest([(A[k], 0.1, POSES[k]), (B[k], 0.1)])
        for field, fields in zip(one, found):
            assert_array_equal(field, fields[k])
        assert scene.clears([(A[k], 0.1, POSES[k]), (B[k], 0.1)]) is bool(found.slack[k] > 0)


def test_structures_in_two_frames_warn() -> None:
    meshes = [Mesh(*sphere(1.0), frame=frame) for frame in ("RAS", "LPS")]  # type: ignore[arg-type]
    scene = Scene()
    scene.add("bone", meshes[0], margin=1.0)
    with pytest.warns(UserWarning, match="`vessel` is in the frame LPS, and `bone` RAS: x and y have opposite signs"):
        scene.add("vessel", meshes[1], margin=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # One that has a pose is placed on purpose, and one that states none may be anywhere.
        scene.add("placed", meshes[1], margin=1.0, pose=np.diag([-1.0, -1, 1, 1]))
        scene.add("unknown", VESSEL, margin=1.0)


def test_a_tube_inside_another_does_not_collide_with_it() -> None:
    outer, inner = [[0, 0, 0], [0, 0, 5]], [[0, 0, 0], [0, 0, 9]]
    beside = np.eye(4)
    beside[0, 3] = 4
    robots = [(outer, 1.0), (inner, 0.5), (outer, 1.0, beside)]
    assert Scene(robot_margin=0.25).tightest(robots).slack == -0.25
    scene = Scene(robot_margin=0.25, nested=[(1, 0)])
    found = scene.tightest(robots)
    assert scene.clears(robots) is True and found.slack == 1.75
    assert_array_equal(found.robots, [0, 2])
    with pytest.raises((TypeError, OverflowError)):
        Scene(nested=[(0, -1)])


def test_per_structure() -> None:
    scene = made()
    found = scene.per_structure([(A, 0.1, POSES), (B, 0.1)])
    back = np.linalg.inv(AWAY)
    distances = np.stack(
        [
            [mesh.distance(A, 0.1, pose=pose @ POSES), mesh.distance(B, 0.1, pose=np.tile(pose, (60, 1, 1)))]
            for mesh, pose in ((WALL, np.eye(4)), (VESSEL, np.eye(4)), (VESSEL, back))
        ]
    )  # (structure, robot, batch)
    assert found.distance.shape == (60, 3) and found.on_mesh.shape == (60, 3, 3)
    np.testing.assert_allclose(found.distance, distances.min(axis=1).T, atol=1e-12)
    assert_array_equal(found.robot[distances.min(axis=1).T > 0], distances.argmin(axis=1).T[distances.min(axis=1).T > 0])
    np.testing.assert_allclose(found.slack, found.distance - [0.5, np.nan, 2.0], atol=1e-15)
    assert np.isnan(found.slack[:, 1]).all() and set(found.robot.ravel()) == {0, 1}
    np.testing.assert_allclose(np.linalg.norm(found.on_robot - found.on_mesh, axis=-1), found.distance, atol=1e-12)
    one = scene.per_structure([(A[7], 0.1, POSES[7]), (B[7], 0.1)])
    for field, fields in zip(one, found):
        assert_array_equal(field, fields[7])
    assert Scene().per_structure([(A, 0.1)]).distance.shape == (60, 0)


def test_contacts() -> None:
    scene, back = made(), np.linalg.inv(AWAY)
    found = scene.contacts_within([(A, 0.1, POSES), (B, 0.1)], reach=1.0)
    count = 0
    for structure, (mesh, pose) in enumerate([(WALL, np.eye(4)), (VESSEL, np.eye(4)), (VESSEL, back)]):
        for robot, (points, poses_of) in enumerate([(A, POSES), (B, np.tile(np.eye(4), (60, 1, 1)))]):
            for k in range(60):
                own = mesh.contacts_within(points[k], 0.1, margin=1.0, pose=pose @ poses_of[k])
                rows = np.arange(*found.offsets[k : k + 2])
                rows = rows[(found.structure[rows] == structure) & (found.robot[rows] == robot)]
                assert (found.batch[rows] == k).all()
                # Of triangles that share the place, another one may be named in another frame.
                assert_array_equal(found.segment[rows], own.segment)
                assert ((found.triangle[rows] >= 0) & (found.triangle[rows] < len(mesh.faces))).all()
                for name in ("distance", "depth", "fraction", "arc_length"):
                    np.testing.assert_allclose(getattr(found, name)[rows], getattr(own, name), atol=1e-12)
                there = np.linalg.inv(pose)
                on_mesh = own.on_mesh @ there[:3, :3].T + there[:3, 3]
                np.testing.assert_allclose(found.on_mesh[rows], on_mesh, atol=1e-12)
                np.testing.assert_allclose(found.normal[rows], own.normal @ there[:3, :3].T, atol=1e-9)
                count += len(rows)
    assert count == len(found.distance) > 50 and set(found.structure) == {0, 1, 2}
    one = scene.contacts_within([(A[7], 0.1, POSES[7]), (B[7], 0.1)], reach=1.0)
    assert_array_equal(one.distance, found.distance[slice(*found.offsets[7:9])])


def test_meshes_move() -> None:
    vertices, faces = sphere(12.0)
    mesh, scene = Mesh(vertices, faces), Scene()
    scene.add("wall", mesh, margin=0.5)
    before = scene.tightest([(A, 0.1)]).slack
    mesh.set_vertices(vertices * 2)
    assert_array_equal(scene.tightest([(A, 0.1)]).slack, mesh.distance(A, 0.1) - 0.5)
    assert (scene.tightest([(A, 0.1)]).slack > before).all()


def test_threads_share_a_scene() -> None:
    scene = made(0.2)
    expected = scene.tightest([(A, 0.1), (B[0], 0.1)]).slack
    with ThreadPoolExecutor(6) as threads:
        for found in threads.map(lambda _: scene.tightest([(A, 0.1), (B[0], 0.1)]).slack, range(12)):
            assert_array_equal(found, expected)


def test_without_margins() -> None:
    scene = Scene()
    for number in range(2):
        found = scene.tightest([(A[0], 0.1)])
        assert found.slack == np.inf and found.structure == -1 and found.is_clear is False
        for robots in ([(A[0], 0.1)], [(A, 0.1)], [(A, 0.1), (B[0], 0.1, POSES[0])]):
            with pytest.raises(ContinuumError, match="nothing in the scene has a margin.*give a structure or the robots a") as raised:
                scene.clears(robots)
            assert raised.value.kind == "no_margin"
        scene.add(f"seen {number}", WALL, margin=None)
    between_robots = Scene(robot_margin=0.1)
    between_robots.add("seen", WALL, margin=None)
    assert between_robots.clears([(A[0], 0.1)]) is True


def test_a_margin_is_said() -> None:
    with pytest.raises(TypeError, match="margin"):
        Scene().add("wall", WALL)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="positional"):
        Scene().add("wall", WALL, 0.5)  # type: ignore[misc]
    with pytest.raises(TypeError, match="`margin` is 'far'; give a number"):
        Scene().add("wall", WALL, margin="far")  # type: ignore[arg-type]
    scene = Scene()
    scene.add("touches", WALL, margin=0.0)
    assert scene.clears([([[0, 0, 0], [0, 0, 20]], 0.1)]) is False


def test_contacts_have_a_prominence() -> None:
    random = np.random.default_rng(5)
    vertices, faces = sphere(8.0, 48, 24)
    rough = Mesh(vertices + 0.05 * random.normal(size=vertices.shape), faces)
    scene = Scene()
    scene.add("rough", rough, margin=None)
    counts = []
    for prominence in (0.0, 0.3, np.inf):
        found = scene.contacts_within([(A, 0.1, POSES)], reach=5.0, prominence=prominence)
        expected = rough.contacts_within(A, 0.1, margin=5.0, prominence=prominence, pose=POSES)
        assert_array_equal(found.distance, expected.distance)
        assert_array_equal(found.offsets, expected.offsets)
        counts.append(len(found.distance))
    assert counts[0] > counts[1] > 0 and counts[0] > counts[2] > 0
    one = scene.contacts_within([(A[3], 0.1, POSES[3])], reach=5.0, prominence=0.3)
    assert_array_equal(one.distance, rough.contacts_within(A[3], 0.1, margin=5.0, prominence=0.3, pose=POSES[3]).distance)


@pytest.mark.parametrize("robots", [[(A[0], 0.1)], [(A, 0.1)], [(A[:0], 0.1)], [(A[0], 0.1), (B[0], 0.1)]])
def test_bad_lengths_have_their_own_names_without_structures_too(robots: list[object]) -> None:
    for scene in (Scene(), made()):
        for reach, prominence, name in ((-1.0, 0.0, "reach"), (np.nan, 0.0, "reach"), (1.0, -2.0, "prominence")):
            with pytest.raises(ContinuumError, match=f"^`{name}` is .*; it must be at least 0") as raised:
                scene.contacts_within(robots, reach=reach, prominence=prominence)  # type: ignore[arg-type]
            assert raised.value.kind == "negative"


@pytest.mark.parametrize(
    ("ask", "kind"),
    [
        (lambda: Scene(robot_margin=-1.0), "negative"),
        (lambda: Scene().add("wall", WALL, margin=np.nan), "negative"),
        (lambda: Scene().add("wall", WALL, margin=1.0, pose=np.eye(3)), "bad_shape"),
        (lambda: Scene().add("wall", WALL, margin=1.0, pose=np.diag([2, 2, 2, 1])), "scales"),
        (lambda: made().clears([]), "bad_type"),
        (lambda: made().clears([A]), "bad_type"),
        (lambda: made().clears([(A, 0.1), (B[:5], 0.1)]), "bad_shape"),
        (lambda: made().tightest([(A[0].T, 0.1)]), "bad_shape"),
        (lambda: made().tightest([(A[0], -0.1)]), "bad_radius"),
        (lambda: made().contacts_within([(A[0], 0.1)], reach=-1.0), "negative"),
        (lambda: made().contacts_within([(A[0], -0.1)], reach=1.0), "bad_radius"),
        (lambda: made().per_structure([(A[0], 0.1, np.eye(3))]), "bad_shape"),
    ],
)
def test_refused(ask: object, kind: str) -> None:
    with pytest.raises(ContinuumError) as raised:
        ask()  # type: ignore[operator]
    assert raised.value.kind == kind


def box(half: float) -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([[x, y, z] for x in (-half, half) for y in (-half, half) for z in (-half, half)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners, np.array([face for a, b, c, d in quads for face in ([a, b, c], [a, c, d])])


INSIDE = np.array([[0.0, 0, 0], [1, 0, 0]])


def test_a_robot_inside_of_a_solid_is_in_contact() -> None:
    surface, solid = Scene(), Scene()
    surface.add("box", Mesh(*box(5.0)), margin=0.5)
    solid.add("box", Mesh(*box(5.0)), margin=0.5, solid=True)
    offsets = np.array([[0.0, 0, 0], [4.5, 0, 0], [5.3, 0, 0], [9, 0, 0]])
    given = [(INSIDE + offsets[:, None], 0.25)]
    np.testing.assert_allclose(surface.tightest(given).distance, [4, 0, 0.3, 4], atol=1e-12)
    expected = np.array([0, 0, 0.3, 4])
    for scene in (solid, copy.copy(solid), pickle.loads(pickle.dumps(solid)), copy.deepcopy(solid)):
        found = scene.tightest(given)
        np.testing.assert_allclose(found.distance, expected, atol=1e-12)
        assert_array_equal(found.on_first[0], found.on_second[0])
        assert_array_equal(scene.clears(given), [False, False, False, True])
        np.testing.assert_allclose(scene.per_structure(given).distance[:, 0], expected, atol=1e-12)
        assert_array_equal(scene.clears_tube(given, resolution=1e-3), [-1, -1, -1, 1])
        bounds = scene.clearance(given, tolerance=1e-3)
        assert ((bounds.lower <= expected - 0.5 + 1e-12) & (expected - 0.5 <= bounds.upper + 1e-12)).all()
        moves = LinearMotion(INSIDE, INSIDE + [1, 0, 0], 0.25)
        answer = scene.clears_motion([moves], resolution=1e-3)
        assert answer.decision is Decision.CONTACT and answer.t == 0 and answer.name == "box"
        assert scene.clearance_of_motion([moves], tolerance=1e-3)[:2] == (-0.5, -0.5)
    assert surface.clears_motion([moves], resolution=1e-3).is_clear


def test_an_open_mesh_cannot_be_solid() -> None:
    vertices, faces = box(1.0)
    scene = Scene()
    with pytest.raises(ContinuumError, match="`lid`.* 3 open edges and 0 edges whose") as refused:
        scene.add("lid", Mesh(vertices, faces[1:]), margin=1.0, solid=True)
    assert refused.value.kind == "not_solid" and len(scene) == 0
    soup = Mesh(vertices[faces].reshape(-1, 3), np.arange(36).reshape(-1, 3))
    scene.add("soup", soup, margin=0.0, solid=True)
    assert not scene.clears([(INSIDE * 0.1, 0.01)])
    torn = vertices[faces].reshape(-1, 3).copy()
    torn[0] *= 1.5
    soup.set_vertices(torn)
    with pytest.raises(ContinuumError, match="`soup` cannot be solid"):
        scene.clears([(INSIDE * 0.1, 0.01)])


def test_margins_by_pair() -> None:
    scene = Scene(robot_margin=0.1)
    target = scene.add("target", Mesh(*box(1.0)), margin=5.0)
    needle, probe = (INSIDE - [0, 0, 0.5], 0.25), (INSIDE + [7.5, 0, 0], 0.25)
    assert not scene.clears([needle, probe])
    scene.set_margin_between(target, 0, margin=None)
    for one in (scene, copy.copy(scene), pickle.loads(pickle.dumps(scene))):
        assert one.clears([needle, probe]) and not one.clears([probe, needle])
        found = one.per_structure([needle, probe])
        assert found.robot[0] == 1 and found.slack[0] == 1.5 and found.name[0] == "target"
    scene.set_margin_between(target, 1, margin=7.0)
    assert scene.tightest([needle, probe]).slack == -0.5
    with pytest.raises(ContinuumError, match="no structure 3"):
        scene.set_margin_between(3, 0, margin=1.0)
    with pytest.raises(ContinuumError, match="`margin`"):
        scene.set_margin_between(target, 0, margin=-1.0)
    with pytest.raises(TypeError, match="`robot`"):
        scene.set_margin_between(target, -1, margin=1.0)


def test_names_are_answered_and_unique() -> None:
    scene = made(0.2)
    with pytest.raises(ContinuumError, match="`wall`") as refused:
        scene.add("wall", WALL, margin=None)
    assert refused.value.kind == "name_taken" and len(scene) == 3
    given = [(A, 0.1, POSES), (B, 0.1)]
    names = np.array(["wall", "seen", "vessel", ""])
    found = scene.tightest(given)
    assert_array_equal(found.name, names[found.structure])
    assert scene.tightest([(A[0], 0.1)]).name in names[:3]
    assert_array_equal(scene.per_structure(given).name, np.tile(names[:3], (60, 1)))
    contacts = scene.contacts_within(given, reach=1.0)
    assert_array_equal(contacts.name, names[contacts.structure])
    bounds = scene.clearance([(A[0], 0.1), (B[0], 0.1)], tolerance=0.1)
    assert bounds.name == names[bounds.structure]
    with pytest.raises(ContinuumError, match=r"`motions\[0\]` beside structure `wall`"):
        moves = LinearMotion(A[0], B[0], 0.1)
        scene.clears_motion([moves], resolution=1e-30)


def test_several_robots_without_a_margin_are_warned_of_once() -> None:
    given = [(A[0], 0.1), (B[0], 0.1)]
    motions = [LinearMotion(A[0], A[0], 0.1), LinearMotion(B[0], B[0], 0.1)]
    queries = {
        "clears": lambda scene: scene.clears(given),
        "tightest": lambda scene: scene.tightest(given),
        "clears_tube": lambda scene: scene.clears_tube(given, resolution=0.1),
        "clearance": lambda scene: scene.clearance(given, tolerance=0.1),
        "clears_motion": lambda scene: scene.clears_motion(motions, resolution=0.1),
    }
    for query in queries.values():
        scene = made()
        with pytest.warns(UserWarning, match="no `robot_margin`, so robots 0 and 1"):
            query(scene)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            query(scene)
            nested = Scene(nested=[(1, 0)])
            nested.add("wall", WALL, margin=0.5)
            query(nested)
            scene.clears(given[:1])
            made(0.1).tightest(given)
            made().per_structure(given)
            made().contacts_within(given, reach=1.0)
