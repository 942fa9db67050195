"""The mask of a masked array is never dropped in silence."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from parry_continuum import (
    BendingMotion,
    ContinuumError,
    LinearMotion,
    Mesh,
    RigidMotion,
    RobotPair,
    Scene,
    SelfQuery,
    simplify,
)
from shapes import poses, robots, sphere

RANDOM = np.random.default_rng(9)
VERTICES, FACES = sphere()
MESH = Mesh(VERTICES, FACES)
MANY = robots(RANDOM, 3)
POSES = poses(RANDOM, 3)
RADII = np.full(11, 0.1)
SCENE = Scene()
SCENE.add("wall", MESH, margin=0.1)


def masked(array: Any) -> Any:
    made = np.ma.masked_array(array, mask=False)
    made[(0,) * made.ndim] = np.ma.masked
    return made


POINTS = masked(MANY)
ASK = {
    "points": [
        lambda: MESH.distance(POINTS, 0.1),
        lambda: MESH.distance(POINTS[0], 0.1),
        lambda: MESH.distance(POINTS[:0], 0.1),
        lambda: MESH.distance(list(POINTS), 0.1),
        lambda: MESH.distance(tuple(POINTS[0]), 0.1),
        lambda: MESH.distance([[list(row) for row in robot] for robot in POINTS], 0.1),
        lambda: MESH.distance([[MANY[0], POINTS[0]]][0], 0.1),
        lambda: MESH.distance([[[0, 0, 0], [0, 0, np.ma.masked]]], 0.1),
        lambda: MESH.distance(POINTS.astype("f4"), 0.1),
        lambda: MESH.side(POINTS),
        lambda: MESH.contacts_within(np.ma.masked_array(MANY), 0.1, margin=0.1),
        lambda: RigidMotion(POINTS, 0.1, POSES, POSES),
        lambda: simplify(POINTS[0], 0.1, tolerance=0.1),
        lambda: SelfQuery().minimum(POINTS, 0.1),
    ],
    "radii": [
        lambda: MESH.minimum(MANY, masked(RADII)),
        lambda: MESH.minimum(MANY, list(masked(RADII))),
        lambda: BendingMotion([[1.0, 0, 0]], [[1.0, 0, 0]], masked([0.1])),
    ],
    "pose": [lambda: MESH.per_link(MANY, 0.1, pose=masked(POSES)), lambda: SCENE.clears([(MANY, 0.1, masked(POSES))])],
    "points_a": [lambda: RobotPair().minimum(POINTS, 0.1, MANY, 0.1)],
    "points_b": [lambda: RobotPair().minimum(MANY, 0.1, POINTS, 0.1), lambda: RobotPair().clears(MANY[0], 0.1, POINTS[0], 0.1, margin=0.1)],
    "start": [lambda: LinearMotion(POINTS, MANY, 0.1)],
    "end": [lambda: MESH.clears_motion(MANY, POINTS, 0.1, margin=0.1, resolution=0.1)],
    "shapes": [lambda: MESH.clears_path(POINTS, 0.1, 0.1, margin=0.1, resolution=0.1)],
    "tangents": [lambda: MESH.clearance(MANY, 0.1, tolerance=0.1, tangents=POINTS)],
    "vertices": [lambda: Mesh(masked(VERTICES), FACES), lambda: MESH.set_vertices(masked(VERTICES))],
    "faces": [lambda: Mesh(VERTICES, masked(FACES)), lambda: Mesh(VERTICES, np.ma.masked_array(FACES))],
    "to": [lambda: MESH.clears_motion_while(masked(VERTICES), MANY, MANY, 0.1, margin=0.1, resolution=0.1)],
    "start_pose": [lambda: RigidMotion(MANY, 0.1, masked(POSES), POSES)],
}


@pytest.mark.parametrize("name", ASK)
def test_refused(name: str) -> None:
    for ask in ASK[name]:
        with pytest.raises(ContinuumError) as raised:
            ask()
        assert raised.value.kind == "bad_type"
        assert str(raised.value).endswith(
            f"`{name}` is a masked array, and its mask would be lost; leave the masked rows out, or give `{name}.data` if they count"
        )


def test_the_remedy() -> None:
    plain = POINTS.data
    assert type(plain) is np.ndarray
    assert (MESH.distance(plain, 0.1) == MESH.distance(MANY, 0.1)).all()
