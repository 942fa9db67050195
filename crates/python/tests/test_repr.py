"""What a notebook shows of an answer fits on a screen."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from parry_continuum import LinearMotion, Mesh, RobotPair, Scene, load_centreline
from shapes import robots, sphere

MESH = Mesh(*sphere())
MANY = robots(np.random.default_rng(4), 500)
PAIR, SCENE = RobotPair(), Scene()
SCENE.add("wall", MESH, margin=0.1)
MOTION = LinearMotion(MANY[:3], MANY[:3] + 0.1, 0.1)


def test_arrays_are_short() -> None:
    for answer in (
        MESH.minimum(MANY, 0.1),
        MESH.per_link(MANY, 0.1),
        MESH.contacts_within(MANY, 0.1, margin=3.0),
        MESH.clearance(MANY[:20], 0.1, tolerance=1.0),
        MESH.clears_inside(MANY, 0.1, margin=0.1),
        MESH.clears_motion(MOTION, margin=0.1, resolution=0.1),
        MESH.clearance_of_motion(MOTION, tolerance=1.0),
        MESH.certify(MANY, 0.1, MESH.per_link(MANY, 0.1)),
        MESH.distance_and_gradient(MANY, 0.1),
        PAIR.minimum(MANY, 0.1, MANY[0], 0.1),
        PAIR.contacts_within(MANY, 0.1, MANY[0], 0.1, margin=3.0),
        PAIR.clearance(MANY[:20], 0.1, MANY[0], 0.1, tolerance=1.0),
        PAIR.clears_motions(MOTION, MOTION, margin=0.1, resolution=0.1),
        SCENE.per_structure([(MANY, 0.1)]),
        SCENE.contacts_within([(MANY, 0.1)], reach=3.0),
        SCENE.tightest([(MANY, 0.1)]),
    ):
        text = repr(answer)
        assert text.startswith(type(answer).__name__ + "(") and "\n" not in text
        assert len(text) < 700, text
        assert all(f"{name}=" in text for name in answer._fields)
    assert "on_mesh=<float64 array (500, 11, 3)>" in repr(MESH.per_link(MANY, 0.1))


def test_decisions_and_sides_are_short() -> None:
    decided = MESH.clears_tube(MANY, 0.1, margin=0.1, resolution=1.0)
    assert len(repr(decided)) < 120 and repr(decided).startswith("Decisions([") and repr(decided).endswith("shape=(500,))")
    assert "decision=<Decisions (40,)>" in repr(MESH.clears_motion(LinearMotion(MANY[:40], MANY[:40], 0.1), margin=0.1, resolution=1.0))
    sides = MESH.side([[0, 0, 0], [0, 0, 90]])
    assert repr(sides) == str(sides) == "Sides([INSIDE, OUTSIDE])"
    assert repr(sides[:0]) == "Sides([], shape=(0,))"


def test_one_answer_is_whole() -> None:
    floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    assert repr(floor.minimum([[0, 0, 2], [0, 0, 4]], 0.5)) == (
        "Minimum(distance=2.0, on_robot=array([0., 0., 2.]), on_mesh=array([0., 0., 0.]), segment=0, arc_length=0.0, triangle=0)"
    )
    answer = floor.clears_inside([[0, 0, 2], [0, 0, 4]], 0.5, margin=1)
    assert repr(answer) == "InsideAnswer(clears=True, base=<Side.UNDECIDED: 0>, tip=<Side.OUTSIDE: 1>, crosses_opening=False)"
    none = floor.minimum(MANY[:0], 0.1)
    assert "on_robot=array([], shape=(0, 3), dtype=float64)" in repr(none)


def test_centrelines_are_short(tmp_path: Path) -> None:
    file = tmp_path / "robot.csv"
    file.write_text("\n".join(f"0,0,{k}" for k in range(100)))
    assert repr(load_centreline(file)) == "Centreline(points=<float64 array (100, 3)>, radii=None, frame=None, unit=None, skipped=0)"
