"""Whatever is handed over, there is an answer or a `ContinuumError`: no crash, no hang, no other exception."""

from __future__ import annotations

import numpy as np
import pytest

from parry_continuum import (
    BendingMotion,
    ContinuumError,
    LinearMotion,
    Mesh,
    Motion,
    MotionPath,
    MovingBase,
    RigidMotion,
    RobotPair,
    Scene,
    SelfQuery,
    simplify,
)
from shapes import poses, robots, soup, sphere

MESHES = [Mesh(*sphere(10.0, 12, 6)), Mesh(*soup(np.random.default_rng(0)))]
NUMBERS = [0.0, -0.0, 1.0, -1.0, 1e-320, 1e-160, 1e160, 1e300, -1e308, np.nan, np.inf, -np.inf]
OTHERS: list[object] = [None, "", "tube", b"\0", {}, [], [[]], [[[]]], object(), 1 + 2j, True, [None, 1], [[1, 2], [3]], print]


def scene(mesh: Mesh) -> Scene:
    made = Scene()
    made.add("wall", mesh, margin=0.1)
    return made


def spoilt(random: np.random.Generator, array: np.ndarray) -> object:
    """What is handed over in the place of an array: itself, or something that is wrong with it."""
    array = np.array(array, float)
    match random.integers(24):
        case 0:
            return OTHERS[random.integers(len(OTHERS))]
        case 1:
            return array.T
        case 2:
            return array[..., :-1]
        case 3:
            return array[None]
        case 4:
            return array.astype(random.choice(["c16", "S5", "O", "M8[s]", "?", "f2", "i1"]), casting="unsafe")
        case 5:
            return array[:0]
        case 6:
            return array * random.choice(NUMBERS)
        case 7 if array.size:
            array.flat[random.integers(array.size)] = random.choice(NUMBERS)
            return array
        case 8:
            return np.broadcast_to(array.ravel()[:1], array.shape)
        case 9:
            return np.ma.masked_array(array)
        case _:
            return array


@pytest.mark.filterwarnings("ignore")
def test_five_thousand_inputs() -> None:
    random = np.random.default_rng(31)
    refused: dict[str, int] = {}
    answered, pair, query = 0, RobotPair(), SelfQuery()
    for _ in range(5000):
        count, points = random.integers(1, 20), random.integers(1, 8)
        robot = robots(random, count, points)
        pose = poses(random, count)
        if random.random() < 0.3:
            robot, pose = robot[0], pose[0]
        radii = random.choice([0.0, 0.1, 1.0, -1.0, np.nan]) * np.ones(points - 1)
        number = random.choice([0.0, 0.1, 3.0, *NUMBERS])
        ends = robot[..., [0, -1], :]
        given = {
            "points": spoilt(random, robot),
            "radii": spoilt(random, radii),
            "pose": random.choice([None, "given"]) and spoilt(random, pose),
            "caps": random.choice(["fitted", "capsules", "cylinders", "none"], p=[0.4, 0.3, 0.2, 0.1]),
        }
        plain = {"points": given["points"], "radii": given["radii"]}
        motion = {"start": given["points"], "end": spoilt(random, robot), "radii": given["radii"]}
        tube = {**plain, "pose": given["pose"], "tangents": random.choice([None, "given"]) and spoilt(random, ends)}
        mesh = MESHES[random.integers(2)]
        shapes = np.stack([robot] * 3, axis=-3)

        def moving() -> Motion:
            sections = np.abs(robot)
            match random.integers(6):
                case 0:
                    return LinearMotion(**motion)
                case 1:
                    return RigidMotion(given["points"], given["radii"], spoilt(random, pose), pose)
                case 2:
                    return BendingMotion(spoilt(random, sections), spoilt(random, sections), 0.01, pose=given["pose"])
                case 3:
                    return MovingBase(BendingMotion(sections, sections, 0.01), spoilt(random, pose), pose)
                case 4:
                    return RigidMotion.of_curve(given["points"], given["radii"], pose, spoilt(random, pose), deviation=number)
                case _:
                    return MotionPath([LinearMotion(**motion), LinearMotion(robot, spoilt(random, robot), radii)])

        faces = mesh.faces.astype(float)
        ask = [
            lambda: mesh.distance(**given),
            lambda: mesh.minimum(**given),
            lambda: mesh.per_link(**given),
            lambda: mesh.clears(margin=number, **given),
            lambda: mesh.clears_inside(margin=number, **given),
            lambda: mesh.clears_sections(spoilt(random, np.abs(robot)), 0.01, segments=3, margin=number, pose=given["pose"]),
            lambda: mesh.contacts_within(margin=number, prominence=0.0, **given),
            lambda: mesh.distance_and_gradient(**given),
            lambda: mesh.certify(answer=mesh.per_link(robot, 0.1), **given),
            lambda: mesh.clearance(tolerance=max(number, 1e-3), **tube),
            lambda: mesh.clears_tube(margin=number, resolution=0.1, **tube),
            lambda: query.clears_tube(given["points"], given["radii"], margin=number, resolution=0.1, turn=number),
            lambda: mesh.clears_motion(margin=number, resolution=0.1, **motion),
            lambda: mesh.time_of_contact(margin=number, resolution=0.1, **motion),
            lambda: mesh.clears_motion_while(spoilt(random, mesh.vertices), margin=number, resolution=0.1, **motion),
            lambda: mesh.clears_path(spoilt(random, shapes), given["radii"], max(number, 0), margin=number, resolution=0.1),
            lambda: mesh.clears_motion(moving(), margin=number, resolution=0.1),
            lambda: query.clears_motion(moving(), margin=number, resolution=0.1),
            lambda: pair.clears_motions(moving(), moving(), margin=number, resolution=0.1),
            lambda: pair.certify(given["points"], given["radii"], robot, 0.1, pair.minimum(robot, 0.1, robot, 0.1)),
            lambda: mesh.clearance_of_motion(moving(), tolerance=max(number, 1e-2)),
            lambda: pair.per_link(given["points"], given["radii"], robot, 0.1, pose_a=given["pose"]),
            lambda: pair.contacts_within(given["points"], given["radii"], robot, 0.1, margin=number),
            lambda: pair.clearance(given["points"], given["radii"], robot, 0.1, tolerance=max(number, 1e-2), tangents_a=tube["tangents"]),
            lambda: pair.clears_tubes(given["points"], given["radii"], robot, 0.1, margin=number, resolution=0.1, turn_a=number),
            lambda: scene(mesh).contacts_within([(given["points"], given["radii"], given["pose"]), (robot, 0.1)], reach=number),
            lambda: scene(mesh).per_structure([(given["points"], given["radii"]), (robot, 0.1)]),
            lambda: mesh.side(given["points"]),
            lambda: Mesh(mesh.vertices, mesh.faces).set_vertices(spoilt(random, mesh.vertices)),
            lambda: Mesh(mesh.vertices, spoilt(random, faces)),
            lambda: Mesh(spoilt(random, mesh.vertices), random.integers(-3, 400, (5, 3))),
            lambda: simplify(tolerance=number, **plain),
        ]
        try:
            ask[random.integers(len(ask))]()
            answered += 1
        except ContinuumError as error:
            refused[error.kind] = refused.get(error.kind, 0) + 1
            assert error.kind != "defect", error
    assert answered > 500
    assert len(refused) > 12, refused


def test_arguments_that_are_missing() -> None:
    with pytest.raises(TypeError):
        MESHES[0].distance()  # type: ignore[call-arg]
    with pytest.raises(TypeError):
        MESHES[0].clears([[0, 0, 0], [1, 0, 0]], 0.1, margin="far")  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        MESHES[0].distance([[0, 0, 0], [1, 0, 0]], 0.1, None, "fitted")  # type: ignore[misc]
