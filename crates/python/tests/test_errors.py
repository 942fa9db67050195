"""Errors are about what the user passed, under the name that it was passed by; what the user's own code raises is the user's."""

from __future__ import annotations

import io
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from parry_continuum import (
    BendingMotion,
    ContinuumError,
    LinearMotion,
    Mesh,
    MotionPath,
    MovingBase,
    RigidMotion,
    RobotPair,
    Scene,
    SelfQuery,
    load,
    load_centreline,
    simplify,
    verify_motion,
)
from shapes import poses, robots, sphere

RANDOM = np.random.default_rng(33)
VERTICES, FACES = sphere()
MESH = Mesh(VERTICES, FACES)
MANY, POSES = robots(RANDOM, 5), poses(RANDOM, 5)
ONE = MANY[0]
PAIR, QUERY, SCENE = RobotPair(), SelfQuery(), Scene(robot_margin=0.1)
SCENE.add("wall", MESH, margin=0.1)
HUGE = 10**400
SCALED = 2 * POSES
SCALED[:, 3, 3] = 1


def spoilt(batch: int, point: int) -> np.ndarray:
    points = MANY.copy()
    points[batch, point, 1] = np.nan
    return points


FOLDED = ONE.copy()
FOLDED[5] = FOLDED[3]  # there and back
EQUAL = np.zeros((12, 3))


@pytest.mark.parametrize(
    ("ask", "text"),
    [
        # The second robot, and the first one of two.
        (lambda a: a(ONE, 0.1, ONE.T, 0.1), "`points_b` has the shape (3, 12)"),
        (lambda a: a(ONE, 0.1, "x", 0.1), "`points_b` has the type <U1; give an array of floats"),
        (lambda a: a(ONE, 0.1, ONE, None), "`radii_b` has the type object"),
        (lambda a: a(ONE, 0.1, ONE, np.ones((2, 2))), "`radii_b` has the shape (2, 2)"),
        (lambda a: a(ONE, 0.1, ONE, np.ones(4)), "12 points need 11 radii, got 4 in `radii_b`"),
        (lambda a: a(ONE, 0.1, ONE, -1.0), "radius 0 is -1; `radii_b` must be finite"),
        (lambda a: a(ONE, -1.0, ONE, 0.1), "radius 0 is -1; `radii_a` must be finite"),
        (lambda a: a(ONE, 0.1, spoilt(0, 4)[0], 0.1), "point 4 has a coordinate that is not finite (NaN); remove or repair it in `points_b`"),
        (lambda a: a(spoilt(0, 4)[0], 0.1, ONE, 0.1), "repair it in `points_a`"),
        (lambda a: a(ONE, 0.1, spoilt(3, 4), 0.1), "robot 3: point 4 has a coordinate that is not finite (NaN); remove or repair it in `points_b`"),
        (lambda a: a(ONE, 0.1, EQUAL, 0.1), "`points_b`: all points of the centreline are the same"),
        (lambda a: a(ONE, 0.1, ONE[:1], 0.1), "a centreline needs at least 2 points, got 1 in `points_b`"),
        (lambda a: a(MANY, 0.1, MANY[:2], 0.1), "`points_a` has 5 robots and `points_b` 2; give as many of both, or one of either"),
        (lambda a: a(ONE, 0.1, ONE, 0.1, pose_b=np.eye(3)), "`pose_b` has the shape (3, 3)"),
        (lambda a: a(ONE, 0.1, ONE, 0.1, pose_b=SCALED[0]), "`pose_b`: the matrix scales by 2"),
        (lambda a: a(ONE, 0.1, MANY, 0.1, pose_b=SCALED), "robot 0: `pose_b`: the matrix scales by 2"),
        (lambda a: a(ONE, 0.1, ONE, 0.1, pose_a=SCALED[0]), "`pose_a`: the matrix scales by 2"),
    ],
)
@pytest.mark.parametrize(
    "question",
    [
        lambda *given, **more: PAIR.minimum(*given, **more),
        lambda *given, **more: PAIR.per_link(*given, **more),
        lambda *given, **more: PAIR.contacts_within(*given, margin=1.0, **more),
        lambda *given, **more: PAIR.clears(*given, margin=1.0, **more),
        lambda *given, **more: PAIR.clears_tubes(*given, margin=1.0, resolution=0.1, **more),
    ],
)
def test_the_second_robot(question: Any, ask: Any, text: str) -> None:
    with pytest.raises(ContinuumError) as raised:
        ask(question)
    assert text in str(raised.value)


@pytest.mark.parametrize(
    ("more", "text"),
    [
        ({"tangents_b": np.ones((3, 3))}, "`tangents_b` has the shape (3, 3)"),
        ({"tangents_b": np.zeros((2, 3))}, "tangent 0 in `tangents_b`"),
        ({"tangents_a": np.zeros((2, 3))}, "tangent 0 in `tangents_a`"),
        ({"deviation_b": -1.0}, "`deviation_b` is -1"),
        ({"deviation_a": np.nan}, "`deviation_a` is NaN"),
        ({"turn_b": -1.0}, "`turn_b` is -1"),
        ({"tangents_b": np.ones((2, 3)), "deviation_b": 0.1}, "`tangents_b` and a deviation are given"),
    ],
)
def test_curves_of_the_second_robot(more: dict[str, Any], text: str) -> None:
    for ask in (lambda: PAIR.clearance(ONE, 0.1, ONE + 1, 0.1, tolerance=1.0, **more), lambda: PAIR.clears_tubes(ONE, 0.1, ONE + 1, 0.1, margin=1.0, resolution=0.1, **more)):
        with pytest.raises(ContinuumError) as raised:
            ask()
        assert text in str(raised.value)
    with pytest.raises(ContinuumError, match="`points_b`: the centreline turns so sharply at point"):
        PAIR.clearance(ONE, 0.1, FOLDED, 0.1, tolerance=1.0)


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        (ONE, "`robots[1]` is no tuple (points, radii) or (points, radii, pose)"),
        ((ONE,), "`robots[1]` is no tuple"),
        ((ONE.T, 0.1), "`robots[1]`: `points` has the shape (3, 12)"),
        ((ONE, [0.1]), "`robots[1]`: 12 points need 11 radii, got 1 in `radii`"),
        ((ONE, -0.1), "`robots[1]`: radius 0 is -0.1"),
        ((spoilt(0, 2)[0], 0.1), "`robots[1]`: point 2 has a coordinate"),
        ((spoilt(3, 2), 0.1), "robot 3: `robots[1]`: point 2 has a coordinate"),
        ((ONE, 0.1, np.eye(3)), "`robots[1]`: `pose` has the shape (3, 3)"),
        ((ONE, 0.1, SCALED[0]), "`robots[1]`: `pose`: the matrix scales by 2"),
        ((EQUAL, 0.1), "`robots[1]`: all points of the centreline are the same"),
    ],
)
def test_an_entry_of_a_scene(entry: Any, text: str) -> None:
    given = [(ONE, 0.1), entry, (ONE, 0.1, None)]
    for ask in (SCENE.clears, SCENE.tightest, SCENE.per_structure, lambda robots: SCENE.contacts_within(robots, reach=1.0)):
        with pytest.raises(ContinuumError) as raised:
            ask(given)
        assert str(raised.value).startswith(text)
    with pytest.raises(ContinuumError, match=r"`robots\[0\]` has 5 robots and `robots\[1\]` 2"):
        SCENE.clears([(MANY, 0.1), (MANY[:2], 0.1)])
    far = np.eye(4)
    far[0, 3] = 1e200
    with pytest.raises(ContinuumError, match=r"^`robots\[1\]`: the pose moves link 0 beyond") as raised:
        SCENE.tightest([(ONE, 0.1), (ONE, 0.1, far)])
    assert raised.value.kind == "out_of_range"


def test_single_robots_keep_their_names() -> None:
    for ask, text in (
        (lambda: MESH.distance(ONE, 0.1, pose=SCALED[0]), "`pose`: the matrix scales by 2"),
        (lambda: MESH.distance(MANY, 0.1, pose=SCALED), "robot 0: `pose`: the matrix scales by 2"),
        (lambda: MESH.clears_motion(ONE, spoilt(0, 3)[0], 0.1, margin=0.1, resolution=0.1), "repair it in `end`"),
        (lambda: BendingMotion([[1, 0, 0]], [[1, 0, 0]], 0.1, pose=SCALED[0]), "`pose`: the matrix scales"),
        (lambda: QUERY.minimum(ONE, -1.0), "`radii` must be finite"),
        (lambda: SCENE.add("x", MESH, margin=1.0, pose=SCALED[0]), "`pose`: the matrix scales"),
    ):
        with pytest.raises(ContinuumError) as raised:
            ask()
        assert text in str(raised.value)


@pytest.mark.parametrize("path", ["wall.stl", b"wall.stl", Path("wall.stl"), "", io.BytesIO()])
def test_a_path_is_for_load(path: Any) -> None:
    with pytest.raises(ContinuumError, match=r"`vertices` is a path or a file; use load\(\)") as raised:
        Mesh(path)
    assert raised.value.kind == "bad_type"


SCALARS = {
    "margin": [
        lambda x: MESH.clears(ONE, 0.1, margin=x),
        lambda x: MESH.clears_inside(ONE, 0.1, margin=x),
        lambda x: MESH.clears_sections([[1, 0, 0]], 0.1, segments=3, margin=x),
        lambda x: MESH.contacts_within(ONE, 0.1, margin=x),
        lambda x: MESH.clears_tube(ONE, 0.1, margin=x, resolution=0.1),
        lambda x: MESH.clears_motion(ONE, ONE, 0.1, margin=x, resolution=0.1),
        lambda x: MESH.time_of_contact(ONE, ONE, 0.1, margin=x, resolution=0.1),
        lambda x: MESH.clears_motion_while(VERTICES, ONE, ONE, 0.1, margin=x, resolution=0.1),
        lambda x: MESH.clears_path([ONE, ONE], 0.1, 0.1, margin=x, resolution=0.1),
        lambda x: MESH.prove(ONE, 0.1, margin=x),
        lambda x: MESH.prove_tube(ONE, 0.1, margin=x, resolution=0.1),
        lambda x: PAIR.clears(ONE, 0.1, ONE, 0.1, margin=x),
        lambda x: PAIR.contacts_within(ONE, 0.1, ONE, 0.1, margin=x),
        lambda x: PAIR.clears_tubes(ONE, 0.1, ONE, 0.1, margin=x, resolution=0.1),
        lambda x: QUERY.clears(ONE, 0.1, margin=x),
        lambda x: PAIR.clears_motions(LinearMotion(ONE, ONE, 0.1), LinearMotion(ONE, ONE, 0.1), margin=x, resolution=0.1),
        lambda x: QUERY.clears_tube(ONE, 0.1, margin=x, resolution=0.1),
        lambda x: Scene().add("wall", MESH, margin=x),
    ],
    "resolution": [lambda x: MESH.clears_tube(ONE, 0.1, margin=0.1, resolution=x)],
    "tolerance": [
        lambda x: MESH.clearance(ONE, 0.1, tolerance=x),
        lambda x: MESH.clearance_of_motion(ONE, ONE, 0.1, tolerance=x),
        lambda x: PAIR.clearance(ONE, 0.1, ONE, 0.1, tolerance=x),
        lambda x: simplify(ONE, 0.1, tolerance=x),
    ],
    "prominence": [lambda x: MESH.contacts_within(ONE, 0.1, margin=1.0, prominence=x)],
    "deviation": [lambda x: MESH.clearance(ONE, 0.1, tolerance=0.1, deviation=x), lambda x: RigidMotion.of_curve(ONE, 0.1, POSES[0], POSES[0], deviation=x)],
    "turn": [lambda x: MESH.clearance(ONE, 0.1, tolerance=0.1, turn=x)],
    "reach": [lambda x: SCENE.contacts_within([(ONE, 0.1)], reach=x)],
    "robot_margin": [lambda x: Scene(robot_margin=x)],
    "self_arc": [lambda x: Scene(self_arc=x)],
    "scale": [lambda x: load("wall.stl", scale=x)],
}


@pytest.mark.parametrize("name", SCALARS)
@pytest.mark.parametrize(
    "wrong", ["far", HUGE, [0.1, 0.2], np.ones(2), np.array("x"), 1j, object(), b"1", True, False, np.True_, np.array(True)]
)
def test_wrong_scalars(name: str, wrong: Any) -> None:
    for ask in SCALARS[name]:
        with pytest.raises(TypeError, match=f"`{name}` is .*; give a number"):
            ask(wrong)


@pytest.mark.parametrize("name", SCALARS)
def test_scalars_of_numpy(name: str) -> None:
    for number in (np.float32(0.5), np.float64(0.5), np.int16(1), 1, np.array(0.5)):
        for ask in SCALARS[name]:
            if name != "scale":
                ask(number)


@pytest.mark.parametrize("nested", [[(0, -1)], [(0, 2**70)], [(0,)], [0], "ab", [("a", "b")]])
def test_wrong_places(nested: Any) -> None:
    with pytest.raises(TypeError, match="`nested`"):
        Scene(nested=nested)


MOTION = LinearMotion(ONE, ONE, 0.1)
ARC = np.stack([3 * np.cos(np.linspace(0, 2, 41)), 3 * np.sin(np.linspace(0, 2, 41)), np.zeros(41)], axis=1)
OBJECTS: list[tuple[Any, str]] = [
    (lambda: MotionPath([MOTION, None]), "`motions[1]` is None; give a Motion, such as a LinearMotion"),
    (lambda: MotionPath(MOTION), "`motions` is of the type LinearMotion; give a list of motions"),
    (lambda: MotionPath(None), "`motions` is None; give a list of motions"),
    (lambda: MovingBase(ONE, POSES[0], POSES[0]), "`motion` is of the type ndarray; give a Motion"),
    (lambda: verify_motion(ONE, 10), "`motion` is of the type ndarray; give a Motion"),
    (lambda: verify_motion(MOTION, True), "`steps` is True; give a whole number from 1"),
    (lambda: PAIR.clears_motions(MOTION, 3, margin=1, resolution=1), "`b` is of the type int; give a Motion"),
    (lambda: PAIR.time_of_contact(ONE, MOTION, margin=1, resolution=1), "`a` is of the type ndarray; give a Motion"),
    (lambda: QUERY.clears_motion(ONE, margin=1, resolution=1), "`motion` is of the type ndarray; give a Motion"),
    (lambda: SCENE.clears_motion([MOTION, None], resolution=1), "`motions[1]` is None; give a Motion"),
    (lambda: SCENE.time_of_contact([ONE], resolution=1), "`motions[0]` is of the type ndarray; give a Motion"),
    (lambda: SCENE.clearance_of_motion(MOTION, tolerance=1), "`motions` is of the type LinearMotion; give a list of motions"),
    (lambda: SCENE.clears_motion_while([], [MOTION], resolution=1), "`ends` is of the type list; give a dict"),
    (lambda: SCENE.clears(None), "`robots` is None; give a list of tuples (points, radii) or (points, radii, pose)"),
    (lambda: SCENE.clears("ab"), "`robots` is of the type str; give a list of tuples"),
    (lambda: SCENE.tightest({0: (ONE, 0.1)}), "`robots` is of the type dict; give a list of tuples"),
    (lambda: Scene().add("x", ONE, margin=1), "`mesh` is of the type ndarray; give a Mesh"),
    (lambda: Scene().add(3, MESH, margin=1), "`name` is of the type int; give a text"),
    (lambda: Mesh(VERTICES, FACES, unit=3), "`unit` is of the type int; give a text"),
    (lambda: load("a.nii", label=True), "`label` is True; give a whole number from 0"),
    (lambda: load_centreline("a.vtk", line=True), "`line` is True; give a whole number from 0"),
    (lambda: Scene(nested=[(True, False)]), "`nested` is no list of pairs of places"),
]


@pytest.mark.parametrize(("ask", "text"), OBJECTS)
def test_objects_of_another_type(ask: Any, text: str) -> None:
    with pytest.raises(TypeError) as raised:
        ask()
    assert str(raised.value).startswith(text)


def test_an_end_of_no_structure() -> None:
    for key in (True, "wall", -1):
        with pytest.raises(ContinuumError, match=f"`ends` has the key {key!r}; give the numbers that `add` returned"):
            SCENE.clears_motion_while({key: POSES[0]}, [MOTION], resolution=1)


def test_a_robot_is_not_nested_in_itself() -> None:
    with pytest.raises(ContinuumError, match=r"`nested\[1\]` names robot 2 twice; give the places of two robots"):
        Scene(nested=[(0, 1), (2, 2)])


@pytest.mark.parametrize(
    ("ask", "text"),
    [
        (lambda: MESH.clearance(FOLDED, 0.1, tolerance=0.1), "as large as their noise; check"),
        (lambda: RigidMotion.of_curve(FOLDED, 0.1, POSES[0], POSES[0]), "for a robot of straight links ask `distance` or `clears`"),
        (lambda: BendingMotion([[1, 0, 0]], [[1, 3, 0]], 0.5), "their product must be below 1"),
        (lambda: QUERY.clears_tube(ARC, 5.0, margin=0.1, resolution=0.1), "as large as their noise"),
        (lambda: Mesh(MESH).set_vertices(VERTICES[:2]), f"`vertices` has 2 vertices, but the mesh has {len(VERTICES)}; give as many, in its order"),
        (
            lambda: MESH.clears_motion_while(VERTICES[:2], ONE, ONE, 0.1, margin=1, resolution=1),
            f"`to` has 2 vertices, but the mesh has {len(VERTICES)}; give as many, in its order, or make a new `Mesh`",
        ),
        (lambda: SCENE.clears_motion_while({0: VERTICES[:2]}, [MOTION], resolution=1), "structure `wall`: "),
    ],
)
def test_texts_are_about_python(ask: Any, text: str) -> None:
    with pytest.raises(ContinuumError) as raised:
        ask()
    assert text in str(raised.value)
    for word in ("::", "engine", "Chain", "`from`", "frames at one place"):
        assert word not in str(raised.value)


def test_numbers_in_texts_are_short() -> None:
    for ask in (
        lambda: MESH.clears(ONE, 0.1, margin=-1e300),
        lambda: MESH.distance(ONE, -1e-300),
        lambda: MESH.distance(ONE * 1e300, 0.1),
        lambda: MESH.distance(ONE, 0.1, pose=np.diag([1e200, 1e200, 1e200, 1])),
        lambda: MESH.distance(ONE, 0.1, pose=np.diag([1, 1, 1, 1e-300])),
        lambda: Mesh(VERTICES * 1e300, FACES),
        lambda: MESH.clears_motion(ONE, ONE + 1, 0.1, margin=1, resolution=1e-300),
        lambda: MESH.clearance(ONE, 0.1, tolerance=0.1, tangents=np.full((2, 3), 1e-320)),
        lambda: BendingMotion([[-1e300, 0, 0]], [[1, 0, 0]], 0.5),
    ):
        with pytest.raises(ContinuumError) as raised:
            ask()
        assert len(str(raised.value)) < 400 and "00000000" not in str(raised.value)


def test_errors_of_scenes_have_all_attributes() -> None:
    moves = LinearMotion(ONE, 1.5 * ONE, 0.1)
    touching = MESH.clearance_of_motion(MOTION, tolerance=0).lower
    for margin, ask, name in (
        (touching, lambda scene: scene.clears_motion([MOTION, moves], resolution=1e-300), "motions[1]"),
        (touching, lambda scene: scene.time_of_contact([MOTION, moves], resolution=1e-300), "motions[1]"),
        (touching, lambda scene: scene.clears_motion_while({0: VERTICES}, [MOTION, moves], resolution=1e-300), "motions[1]"),
        (MESH.clearance(ONE, 0.1, tolerance=0).lower, lambda scene: scene.clears_tube([(ONE, 0.1)], resolution=1e-300), "robots[0]"),
    ):
        scene = Scene()
        scene.add("wall", MESH, margin=margin)
        with pytest.raises(ContinuumError) as raised:
            ask(scene)
        assert str(raised.value).startswith(f"`{name}` beside structure `wall`: the bounds are")
        assert raised.value.kind == "tolerance_too_fine" and raised.value.possible is not None and raised.value.possible > 1e-300
    with pytest.raises(ContinuumError, match=r"^`robots\[1\]`: point 2 has") as raised:
        SCENE.clears([(ONE, 0.1), (spoilt(0, 2)[0], 0.1)])
    assert raised.value.index == 2


def test_the_motion_of_a_scene_is_named() -> None:
    sharp = np.array([[0, 0, 0], [0, 0, 1], [0, 0.01, 0.0]])
    scene = Scene(self_margin=0.01)
    folds = LinearMotion(sharp, sharp, 0.4)
    with pytest.raises(ContinuumError, match=r"^`motions\[1\]`: ") as raised:
        scene.clears_motion([LinearMotion(ONE, ONE, 0.01), folds], resolution=0.1)
    assert "robots" not in str(raised.value)


class Raises:
    def __init__(self, error: BaseException) -> None:
        self.error = error

    def __array__(self, *_: object, **__: object) -> np.ndarray:
        raise self.error

    @property
    def faces(self) -> None:
        raise self.error

    vertices = VERTICES


ERRORS = [RuntimeError("mine"), KeyError("mine"), ValueError("mine"), TypeError("mine"), AttributeError("mine"), KeyboardInterrupt()]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_own_exceptions_are_not_swallowed(error: BaseException) -> None:
    own = Raises(error)
    for ask in (
        lambda: MESH.distance(own, 0.1),
        lambda: MESH.distance(ONE, own),
        lambda: MESH.distance(ONE, 0.1, pose=own),
        lambda: PAIR.minimum(ONE, 0.1, own, 0.1),
        lambda: SCENE.clears([(own, 0.1)]),
        lambda: Mesh(own),
        lambda: Mesh(VERTICES, own),
        lambda: MESH.set_vertices(own),
        lambda: LinearMotion(own, ONE, 0.1),
    ):
        with pytest.raises(type(error)) as raised:
            ask()
        assert raised.value is error
    with pytest.raises((ContinuumError, type(error))) as raised:
        MESH.distance([own, own], 0.1)
    assert raised.value is error or raised.value.__cause__ is not None


def test_lists_name_their_parameter() -> None:
    with pytest.raises(ContinuumError, match="`points` is no array of numbers .*inhomogeneous") as raised:
        MESH.distance([[0, 0, 0], [1, 1]], 0.1)
    assert isinstance(raised.value.__cause__, ValueError)
    with pytest.raises(ContinuumError, match="`faces` is missing"):
        Mesh(SimpleNamespace(vertices=VERTICES))
    with pytest.raises(ContinuumError, match="`faces` is missing"):
        Mesh(VERTICES)


class Changes:
    """A pose that changes another argument while it is read."""

    def __init__(self, change: Any) -> None:
        self.change = change

    def __array__(self, *_: object, **__: object) -> np.ndarray:
        self.change()
        return np.eye(4)


def resize(array: np.ndarray, *shape: int) -> None:
    array.resize(shape, refcheck=False)


def retype(array: np.ndarray) -> None:
    array.dtype = np.dtype("i1")  # type: ignore[misc]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["points", "radii"])
@pytest.mark.parametrize(
    "change", [lambda a: resize(a, 0, 3), lambda a: resize(a, 2, 3), lambda a: resize(a, 10**6, 3), retype], ids=["none", "few", "many", "type"]
)
def test_arguments_that_change_one_another(name: str, change: Any) -> None:
    for points in (ONE, MANY):
        made = {"points": points.copy(), "radii": np.full((*points.shape[:-2], 11), 0.1)}
        pose = Changes(lambda: change(made[name]))
        with pytest.raises(ContinuumError, match=f"`{name}` has changed its size or type while it was read; give a copy") as raised:
            MESH.distance(made["points"], made["radii"], pose=pose)
        assert raised.value.kind == "changed"


@pytest.mark.filterwarnings("ignore")
def test_the_second_robot_changes_the_first() -> None:
    points = ONE.copy()
    with pytest.raises(ContinuumError, match="`points_b` has changed its size"):
        PAIR.minimum(ONE, 0.1, points, 0.1, pose_a=Changes(lambda: resize(points, 0, 3)))
    points, scene = ONE.copy(), Scene(robot_margin=0.1)
    with pytest.raises(ContinuumError, match="`points` has changed its size"):
        scene.clears([(ONE, 0.1, Changes(lambda: resize(points, 0, 3))), (points, 0.1)])
