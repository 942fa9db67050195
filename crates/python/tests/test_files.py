"""What files state of frame and unit is kept, and what looks like a mistake is said."""

from __future__ import annotations

import copy
import json
import pickle
import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from parry_continuum import (
    ContinuumError,
    LinearMotion,
    Mesh,
    MotionPath,
    MovingBase,
    RigidMotion,
    RobotPair,
    Scene,
    load,
    load_centreline,
)
from shapes import Array, sphere

VERTICES, FACES = sphere()
SIZES = (7, 6, 5)
ORIGIN = np.array([40.0, 20.0, 30.0])  # LPS
HALF_TURN = np.array([-1, -1, 1.0])


def voxels() -> bytes:
    """Two boxes, of the labels 1 and 7, the first axis fastest."""
    labels = np.zeros(SIZES, np.uint8)
    labels[1:3, 1:5, 1:4] = 1
    labels[4:6, 1:5, 1:4] = 7
    return labels.tobytes(order="F")


def nrrd(folder: Path, units: bool = True, origin: bool = True) -> Path:
    file = folder / f"seg{units:d}{origin:d}.nrrd"
    lines = [
        "NRRD0004",
        "type: uint8",
        "dimension: 3",
        "space: left-posterior-superior",
        "sizes: 7 6 5",
        "space directions: (1,0,0) (0,1,0) (0,0,1)",
        "kinds: domain domain domain",
        "encoding: raw",
    ]
    lines += ['space units: "mm" "mm" "mm"'] * units
    lines += ["space origin: (40,20,30)"] * origin
    file.write_bytes("\n".join(lines).encode() + b"\n\n" + voxels())
    return file


def nifti(folder: Path) -> Path:
    """The same image as ITK would save it: RAS."""
    file, head = folder / "seg.nii", bytearray(352)
    struct.pack_into("<i", head, 0, 348)
    struct.pack_into("<8h", head, 40, 3, *SIZES, 1, 1, 1, 1)
    struct.pack_into("<2h", head, 70, 2, 8)
    struct.pack_into("<4f", head, 76, 1, 1, 1, 1)
    struct.pack_into("<f", head, 108, 352)
    head[123] = 2  # mm
    struct.pack_into("<2h", head, 252, 0, 1)
    x, y, z = ORIGIN * HALF_TURN
    struct.pack_into("<12f", head, 280, -1, 0, 0, x, 0, -1, 0, y, 0, 0, 1, z)
    head[344:348] = b"n+1\0"
    file.write_bytes(bytes(head) + voxels())
    return file


def stl(folder: Path, skipped: int = 0) -> Path:
    file = folder / "wall.stl"
    faces = np.concatenate([VERTICES[FACES], np.repeat(VERTICES[:1, None], 3, axis=1).repeat(skipped, axis=0)])
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *corners.ravel(), 0) for corners in faces)
    file.write_bytes(b"plain".ljust(80) + struct.pack("<I", len(faces)) + rows)
    return file


def markups(folder: Path, system: str = "LPS", **more: Any) -> Path:
    file = folder / f"curve{system}.mrk.json"
    points = [{"position": position} for position in ([1, 2, 3], [4, 5, 6.5], "", [7, 9, 9])]
    file.write_text(json.dumps({"markups": [{"type": "Curve", "coordinateSystem": system, "controlPoints": points, **more}]}))
    return file


def test_one_image_lands_in_one_place(tmp_path: Path) -> None:
    made = [load(path, label=7) for path in (nrrd(tmp_path), nifti(tmp_path))]
    assert [(mesh.frame, mesh.unit) for mesh in made] == [("LPS", "mm"), ("RAS", "mm")]
    assert_allclose(made[0].vertices * HALF_TURN, made[1].vertices, atol=1e-5)
    for frame in ("LPS", "RAS"):
        both = [load(path, label=7, frame=frame) for path in (nrrd(tmp_path), nifti(tmp_path))]
        assert [mesh.frame for mesh in both] == [frame, frame]
        assert_allclose(both[0].vertices, both[1].vertices, atol=1e-5)
        # Triangles face outward in either frame.
        for mesh in both:
            a, b, c = mesh.vertices[mesh.faces].swapaxes(0, 1)
            assert np.sum(np.cross(a, b) * c) > 0
    centre = load(nrrd(tmp_path), label=7).vertices.mean(axis=0)
    assert_allclose(centre, ORIGIN + [4.5, 2.5, 2], atol=0.1)


def test_unit_and_scale(tmp_path: Path) -> None:
    assert load(nrrd(tmp_path, units=False), label=1).unit is None
    for scale, unit in ((1.0, "mm"), (0.001, "m"), (0.1, "cm"), (1000, "um"), (3.0, None)):
        mesh = load(nrrd(tmp_path), label=1, scale=scale)
        assert mesh.unit == unit
        assert_allclose(mesh.vertices, load(nrrd(tmp_path), label=1).vertices * scale, rtol=1e-12)


def test_no_statement_no_frame(tmp_path: Path) -> None:
    mesh = load(stl(tmp_path))
    assert (mesh.frame, mesh.unit, mesh.skipped_faces) == (None, None, 0)
    said = load(stl(tmp_path), frame="RAS")
    assert said.frame == "RAS"
    assert_array_equal(said.vertices, mesh.vertices)
    obj = tmp_path / "slicer.obj"
    obj.write_text("# SPACE=LPS\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in VERTICES) + "f 1 2 3\n")
    assert load(obj).frame == "LPS"
    assert_array_equal(load(obj, frame="RAS").vertices, VERTICES * HALF_TURN)


def test_several_labels_are_listed(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match=r"seg11\.nrrd has the labels 1, 7, read as one surface; choose one with `label`"):
        both = load(nrrd(tmp_path))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        one = load(nrrd(tmp_path), label=1)
    assert len(both.faces) > len(one.faces)
    with pytest.raises(ContinuumError, match="no voxel with label 3, but with 0, 1, 7"):
        load(nrrd(tmp_path), label=3)


def test_skipped_faces_are_counted(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match=r"left out of .*wall\.stl: 4 faces without area"):
        mesh = load(stl(tmp_path, skipped=4))
    assert mesh.skipped_faces == 4 and len(mesh.faces) == len(FACES)


def test_no_position_is_an_option(tmp_path: Path) -> None:
    with pytest.raises(ContinuumError, match="give `allow_no_position=True`, which puts its first voxel at the origin") as raised:
        load(nrrd(tmp_path, origin=False), label=1)
    assert raised.value.kind == "file" and "Options" not in str(raised.value)
    mesh = load(nrrd(tmp_path, origin=False), label=1, allow_no_position=True)
    assert_allclose(mesh.vertices.mean(axis=0), [1.5, 2.5, 2], atol=0.1)


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda mesh: pickle.loads(pickle.dumps(mesh)), Mesh])
def test_copies_keep_what_is_known(again: Any, tmp_path: Path) -> None:
    mesh = load(nifti(tmp_path), label=1, scale=0.001)
    same = again(mesh)
    assert (same.frame, same.unit) == ("RAS", "m")
    assert_array_equal(same.vertices, mesh.vertices)
    plain = again(Mesh(VERTICES, FACES))
    assert (plain.frame, plain.unit) == (None, None)
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(mesh, protocol)).frame == "RAS"


def test_meshes_of_arrays_may_state_them() -> None:
    mesh = Mesh(VERTICES, FACES, frame="LPS", unit="mm")
    assert (mesh.frame, mesh.unit) == ("LPS", "mm")
    assert Mesh(mesh, frame="RAS").frame == "RAS" and Mesh(mesh, frame="RAS").unit == "mm"


def test_centrelines(tmp_path: Path) -> None:
    line = load_centreline(markups(tmp_path))
    assert (line.frame, line.unit, line.skipped, line.radii) == ("LPS", "mm", 1, None)
    assert_array_equal(line.points, [[1, 2, 3], [4, 5, 6.5], [7, 9, 9]])
    turned = load_centreline(markups(tmp_path), frame="RAS", scale=0.001)
    assert (turned.frame, turned.unit) == ("RAS", "m")
    assert_allclose(turned.points, np.asarray(line.points) * HALF_TURN / 1000)
    assert load_centreline(markups(tmp_path, "RAS")).frame == "RAS"
    table = tmp_path / "robot.csv"
    table.write_text("x,y,z,radius\n0,0,0,0.5\n0,0,2,0.25\n0,0,4,0.25\n")
    found = load_centreline(str(table), scale=10)
    assert_array_equal(found.points, [[0, 0, 0], [0, 0, 20], [0, 0, 40]])
    assert found.radii is not None
    assert_array_equal(found.radii, [5, 2.5])
    assert (found.frame, found.unit, found.skipped) == (None, None, 0)
    assert type(found.points) is np.ndarray
    assert load_centreline(table, frame="LPS").frame == "LPS"
    several = tmp_path / "several.vtk"
    several.write_text(
        "# vtk DataFile Version 3.0\nlines\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 5 5 5 6 5 5\n"
        "LINES 2 6\n2 0 1\n2 2 3\n"
    )
    with pytest.raises(ContinuumError, match="holds 2 lines; choose one from 0 to 1") as raised:
        load_centreline(several)
    assert raised.value.kind == "file"
    assert_array_equal(load_centreline(several, line=1).points, [[5, 5, 5], [6, 5, 5]])


def test_points_of_files_are_arrays(tmp_path: Path) -> None:
    points = load_centreline(markups(tmp_path)).points
    assert points[1:].frame == points.copy().frame == "LPS"  # type: ignore[attr-defined]
    for computed in (points * HALF_TURN, points + 1, np.asarray(points), np.linalg.norm(points, axis=1), np.cross(points, [0, 0, 1])):
        assert type(computed) is np.ndarray
    joined = [np.stack([points] * 2), np.concatenate([points, np.zeros((1, 3))]), np.tile(points, (2, 1, 1)), np.append(points, [[0, 0, 0]], axis=0)]
    joined += [np.vstack([points, points]), np.broadcast_to(points, (2, *points.shape)), copy.deepcopy(points)]
    assert [made.frame for made in joined] == ["LPS"] * 7  # type: ignore[attr-defined]
    assert pickle.loads(pickle.dumps(points)).frame == "LPS"
    assert Mesh(VERTICES, FACES, frame="LPS").distance(joined[0], 0.1).shape == (2,)
    turned = load_centreline(markups(tmp_path), frame="RAS").points
    with pytest.warns(UserWarning, match="points of the frames LPS and RAS are joined") as caught:
        mixed = np.stack([points, turned])
    assert mixed.frame is None and caught[0].filename == __file__  # type: ignore[attr-defined]
    assert isinstance(points.sum(), float)
    assert_array_equal(pickle.loads(pickle.dumps(points)), points)


def warned(mesh: Mesh, ask: Any) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ask(Mesh(mesh))
    return [str(warning.message) for warning in caught]


POSE = np.eye(4)
QUESTIONS = {
    "distance": lambda mesh, p: mesh.distance(p, 0.1),
    "minimum": lambda mesh, p: mesh.minimum(p, 0.1),
    "per_link": lambda mesh, p: mesh.per_link(p, 0.1),
    "clears": lambda mesh, p: mesh.clears(p, 0.1, margin=0.1),
    "clears_inside": lambda mesh, p: mesh.clears_inside(p, 0.1, margin=0.1),
    "within": lambda mesh, p: mesh.contacts_within(p, 0.1, margin=0.1),
    "side": lambda mesh, p: mesh.side(p),
    "clearance": lambda mesh, p: mesh.clearance(p, 0.1, tolerance=0.1),
    "clears_tube": lambda mesh, p: mesh.clears_tube(p, 0.1, margin=0.1, resolution=1.0),
    "clears_motion": lambda mesh, p: mesh.clears_motion(np.asarray(p), p, 0.1, margin=0.1, resolution=0.1),
    "time_of_contact": lambda mesh, p: mesh.time_of_contact(p, p, 0.1, margin=0.1, resolution=0.1),
    "clearance_of_motion": lambda mesh, p: mesh.clearance_of_motion(p, p, 0.1, tolerance=0.1),
    "clears_motion_while": lambda mesh, p: mesh.clears_motion_while(mesh.vertices, p, p, 0.1, margin=0.1, resolution=0.1),
    "distance_and_gradient": lambda mesh, p: mesh.distance_and_gradient(p, 0.1),
    "certify": lambda mesh, p: mesh.certify(p, 0.1, mesh.per_link(np.asarray(p), 0.1)),
    "prove": lambda mesh, p: mesh.prove(p, 0.1, margin=0.1),
    "stack": lambda mesh, p: mesh.distance(np.stack([p, p]), 0.1),
    "list": lambda mesh, p: mesh.distance([p, p], 0.1),
}


@pytest.mark.parametrize("name", QUESTIONS)
def test_other_frames_warn_once(name: str, tmp_path: Path) -> None:
    ask = QUESTIONS[name]
    lps, ras = load_centreline(markups(tmp_path)).points, load_centreline(markups(tmp_path), frame="RAS").points
    mesh = Mesh(VERTICES, FACES, frame="RAS")
    found = warned(mesh, lambda mesh: [ask(mesh, lps) for _ in range(3)])
    which = "end" if name == "clears_motion" else "start" if "motion" in name or name == "time_of_contact" else "points"
    assert found == [
        f"`{which}` state the frame LPS, and the mesh RAS: x and y have opposite signs; load both with frame='RAS', or give "
        f"`{which} * [-1, -1, 1]`"
    ]
    assert warned(mesh, lambda mesh: ask(mesh, ras)) == []
    assert warned(mesh, lambda mesh: ask(mesh, lps * HALF_TURN)) == []
    assert warned(Mesh(VERTICES, FACES), lambda mesh: ask(mesh, lps)) == []


def scene_of(mesh: Mesh) -> Scene:
    scene = Scene(robot_margin=0.1)
    scene.add("wall", mesh, margin=0.1)
    return scene


MOTIONS = {
    "linear": lambda p: LinearMotion(p, p, 0.1),
    "end": lambda p: LinearMotion(np.asarray(p), p, 0.1),
    "rigid": lambda p: RigidMotion(p, 0.1, POSE, MOVED),
    "rigid to the frame": lambda p: RigidMotion(p, 0.1, MOVED, POSE),
    "curve": lambda p: RigidMotion.of_curve(p, 0.1, POSE, POSE),
    "base": lambda p: MovingBase(LinearMotion(p, p, 0.1), POSE, MOVED),
    "path": lambda p: MotionPath([LinearMotion(np.asarray(p), np.asarray(p), 0.1), LinearMotion(p, p, 0.1)]),
    "pickle": lambda p: pickle.loads(pickle.dumps(LinearMotion(p, p, 0.1))),
}
MOVED = np.eye(4)
MOVED[0, 3] = 0.5
OF_MOTIONS = {
    "start": lambda mesh, m: mesh.clears_motion(m, margin=0.1, resolution=0.5),
    "motions[0]": lambda mesh, m: scene_of(mesh).clears_motion([m], resolution=0.5),
    "motions[1]": lambda mesh, m: scene_of(mesh).clearance_of_motion([LinearMotion(ROBOT, ROBOT, 0.1), m], tolerance=0.5),
}


@pytest.mark.parametrize("question", OF_MOTIONS)
@pytest.mark.parametrize("name", MOTIONS)
def test_motions_keep_the_frame(name: str, question: str, tmp_path: Path) -> None:
    lps, ras = load_centreline(markups(tmp_path)).points, load_centreline(markups(tmp_path), frame="RAS").points
    make, ask = MOTIONS[name], OF_MOTIONS[question]
    mesh = Mesh(VERTICES, FACES, frame="RAS")
    assert make(lps).frame == "LPS" and make(np.asarray(lps)).frame is None
    assert warned(mesh, lambda mesh: [ask(mesh, make(lps)) for _ in range(2)]) == [
        f"`{question}` states the frame LPS, and the mesh RAS: x and y have opposite signs; load both with frame='RAS'"
    ]
    assert warned(mesh, lambda mesh: ask(mesh, make(ras))) == []


def test_poses_of_motions_lead_to_the_mesh(tmp_path: Path) -> None:
    lps = load_centreline(markups(tmp_path)).points
    turned = np.diag([-1.0, -1, 1, 1])
    assert RigidMotion(lps, 0.1, turned, turned).frame is None
    assert MovingBase(LinearMotion(lps, lps, 0.1), turned, turned).frame is None


def test_two_robots_of_two_frames_warn_once(tmp_path: Path) -> None:
    lps, ras = load_centreline(markups(tmp_path)).points, load_centreline(markups(tmp_path), frame="RAS").points
    end = "the frame LPS, and `{}` RAS: x and y have opposite signs; load both with frame='RAS'"
    for ask, names in (
        (lambda pair, a, b, **more: pair.minimum(a, 0.1, b, 0.1, **more), ("points_a", "points_b")),
        (lambda pair, a, b, **more: pair.clears(a, 0.1, b, 0.1, margin=0.1, **more), ("points_a", "points_b")),
        (lambda pair, a, b, **more: pair.clearance(a, 0.1, b, 0.1, tolerance=1.0, **more), ("points_a", "points_b")),
    ):
        pair = RobotPair()
        found = warned(AORTA, lambda _: [ask(pair, lps, ras) for _ in range(2)])
        assert found == [f"`{names[0]}` is in " + end.format(names[1])]
        pair = RobotPair()
        assert warned(AORTA, lambda _: (ask(pair, lps, lps), ask(pair, lps, np.asarray(ras)), ask(pair, lps, ras, pose_a=POSE))) == []
    pair, (a, b) = RobotPair(), (LinearMotion(points, points, 0.1) for points in (lps, ras))
    found = warned(AORTA, lambda _: [pair.clears_motions(a, b, margin=0.1, resolution=0.5) for _ in range(2)])
    assert found == ["`a` is in " + end.format("b")]
    assert warned(AORTA, lambda _: LinearMotion(lps, ras, 0.1)) == ["`start` is in " + end.format("end")]


def test_robots_of_a_scene_in_two_frames_warn_once(tmp_path: Path) -> None:
    lps, ras = load_centreline(markups(tmp_path)).points, load_centreline(markups(tmp_path), frame="RAS").points
    plain, end = np.asarray(lps), "RAS: x and y have opposite signs; load both with frame='RAS'"
    scene = Scene(robot_margin=0.1)
    found = warned(AORTA, lambda _: [scene.clears([(plain, 0.1), (lps, 0.1), (ras, 0.1)]) for _ in range(2)])
    assert found == ["`robots[1]` is in the frame LPS, and `robots[2]` " + end]
    assert warned(AORTA, lambda _: Scene(robot_margin=0.1).clears([(lps, 0.1), (plain, 0.1), (ras, 0.1, POSE)])) == []
    a, b = (LinearMotion(points, points, 0.1) for points in (lps, ras))
    found = warned(AORTA, lambda _: [Scene(robot_margin=0.1).clears_motion([a, b], resolution=0.5)])
    assert found == ["`motions[0]` is in the frame LPS, and `motions[1]` " + end]


def test_a_pose_leads_to_the_mesh(tmp_path: Path) -> None:
    lps = load_centreline(markups(tmp_path)).points
    mesh = Mesh(VERTICES, FACES, frame="RAS")
    assert warned(mesh, lambda mesh: mesh.distance(lps, 0.1, pose=POSE)) == []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UserWarning, match="frame"):
            mesh.distance(lps, 0.1)
        assert RobotPair().minimum(lps, 0.1, np.asarray(lps), 0.1).distance == 0


def test_scenes_warn_too(tmp_path: Path) -> None:
    lps = load_centreline(markups(tmp_path)).points
    for pose, entry, count in ((None, (lps, 0.1), 1), (None, (lps, 0.1, None), 1), (POSE, (lps, 0.1), 0), (None, (lps, 0.1, POSE), 0)):

        def ask(mesh: Mesh) -> None:
            scene = Scene(robot_margin=0.1)
            scene.add("wall", mesh, margin=0.1, pose=pose)
            for _ in range(2):
                scene.clears([entry])
                scene.tightest([(np.asarray(lps), 0.1), entry])

        assert len(warned(Mesh(VERTICES, FACES, frame="RAS"), ask)) == count
        assert warned(Mesh(VERTICES, FACES), ask) == []


ROBOT = np.array([[30.0, 20, 1], [34, 20, 1], [38, 20, 1.0]])
AORTA = Mesh(VERTICES * 3 + [40, 20, 0], FACES)


@pytest.mark.parametrize(
    ("points", "radii", "expected"),
    [
        (ROBOT, 0.5, []),
        (np.stack([ROBOT, ROBOT + 1]), np.ones((2, 2)), []),
        (ROBOT[:0].reshape(0, 2, 3), 0.5, []),
        (ROBOT * HALF_TURN, 0.5, ["do not overlap; they are 40.000", "`points * [-1, -1, 1]`, the other of the frames RAS and LPS they fit"]),
        (ROBOT / 1000, 0.0005, ["the robot's box measures 0.008", "with `points * 1000` and `radii * 1000` they fit"]),
        (ROBOT * 1000, 500.0, ["they are 29930.000 apart", "`points * 0.001` and `radii * 0.001` they fit"]),
        (ROBOT * HALF_TURN / 1000, 0.0005, ["`points * [-1000, -1000, 1000]` and `radii * 1000`"]),
        (ROBOT + 1e4, 0.5, ["do not overlap"]),
        (ROBOT, 50.0, ["the radius 50 is large", "`radii * 0.01` would be usual"]),
        (ROBOT, [0.0005, 0.0001], ["the radius 0.0005 is small", "`radii * 1000` would be usual"]),
        # Points in metres, with a radius in millimetres; and with one that is wrong in both.
        (ROBOT / 1000, 0.5, ["the robot's box measures 0.008", "with `points * 1000` they fit"]),
        (ROBOT / 1000, 50.0, ["with `points * 1000` they fit", "the radius 50 is large", "`radii * 0.01` would be usual"]),
        (ROBOT / 1000, 5e-6, ["and `radii * 1000` they fit", "the radius 0.005 is small", "`radii * 100000` would be usual"]),
        # A robot beside the mesh: a change of its unit would hide that.
        (ROBOT + [60, 0, 0], 0.5, ["do not overlap; they are 20.000 apart; check the robot's pose"]),
        (ROBOT, 0.0, []),
    ],
)
def test_doubts(points: Array, radii: Any, expected: list[str]) -> None:
    found = AORTA.doubts(points, radii)
    assert all(type(doubt) is str for doubt in found)
    assert bool(found) == bool(expected)
    for text in expected:
        assert text in "; ".join(found)
    if len(points) and "do not overlap" in expected[:1]:
        assert "they fit" not in found[-1]


@pytest.mark.parametrize("name", ["RAS", "LPS"])
def test_surfaces_of_pyvista_state_their_frame(name: str) -> None:
    pyvista = pytest.importorskip("pyvista")
    surface = pyvista.PolyData(VERTICES, np.insert(FACES, 0, 3, axis=1).ravel())
    assert Mesh(surface).frame is None
    surface.field_data["SPACE"] = [name]
    other = {"RAS": "LPS", "LPS": "RAS"}[name]
    assert (Mesh(surface).frame, load(surface).frame, Mesh(surface, frame=other).frame) == (name, name, other)
    assert Mesh(surface.cast_to_unstructured_grid()).frame == name
    turned = load(surface, frame=other)
    assert turned.frame == other
    assert_array_equal(turned.vertices, VERTICES * HALF_TURN)
    assert_array_equal(load(surface, frame=name).vertices, VERTICES)
    surface.field_data["SPACE"] = ["scanner"]
    assert Mesh(surface).frame is None


def test_doubts_about_frames(tmp_path: Path) -> None:
    lps = load_centreline(markups(tmp_path)).points
    mesh = Mesh(VERTICES, FACES, frame="RAS")
    found = mesh.doubts(lps, 0.1)
    assert len(found) == 1 and found[0].startswith("`points` state the frame LPS, and the mesh RAS")
    assert mesh.doubts(lps, 0.1, pose=POSE) == []
    assert mesh.doubts(np.asarray(lps), 0.1) == []
    far = POSE.copy()
    far[0, 3] = 1000
    assert "do not overlap" in mesh.doubts(lps, 0.1, pose=far)[0]
    assert mesh.doubts(np.full((3, 3), np.nan), 0.1) == []


@pytest.mark.parametrize(
    ("ask", "error", "text"),
    [
        (lambda f: load(f, frame="rsa"), ContinuumError, "`frame` is 'rsa'; it must be 'RAS' or 'LPS'"),
        (lambda f: load(f, frame=3), ContinuumError, "`frame` is 3"),
        (lambda f: load_centreline(f, frame=""), ContinuumError, "`frame` is ''"),
        (lambda f: Mesh(VERTICES, FACES, frame="XYZ"), ContinuumError, "`frame` is 'XYZ'"),
        (lambda f: Mesh(VERTICES, FACES, unit=3), TypeError, "`unit` is of the type int; give a text"),
        (lambda f: load(f, label=-1), TypeError, "`label` is -1; give a whole number from 0 to 4294967295"),
        (lambda f: load(f, label=1.5), TypeError, "`label` is 1.5; give a whole number"),
        (lambda f: load(f, scale="mm"), TypeError, "`scale` is 'mm'; give a number"),
        (lambda f: load(f, scale=-1.0), ContinuumError, "the scale is -1; give a positive number"),
        (lambda f: load(load(f), scale=-1.0), ContinuumError, "the scale is -1; give a positive number"),
        (lambda f: load(load(f), scale=0), ContinuumError, "the scale is 0; give a positive number"),
        (lambda f: load(f, label=2), ContinuumError, "holds triangles without labels"),
        (lambda f: load_centreline(f, line=-1), TypeError, "`line` is -1; give a whole number"),
        (lambda f: load_centreline(f), ContinuumError, "give a centreline that ends in"),
        (lambda f: load_centreline(f.with_name("none.csv")), ContinuumError, "cannot read .*none.csv"),
        (lambda f: AORTA.doubts(np.ones((3, 2)), 0.1), ContinuumError, "`points` has the shape"),
        (lambda f: AORTA.doubts(ROBOT, [0.1]), ContinuumError, "2 radii"),
        (lambda f: AORTA.doubts("robot", 0.1), ContinuumError, "`points`"),
        (lambda f: AORTA.doubts(ROBOT, 0.1, pose=np.eye(3)), ContinuumError, "`pose`"),
    ],
)
def test_wrong_types(ask: Any, error: type[Exception], text: str, tmp_path: Path) -> None:
    with pytest.raises(error, match=text):
        ask(stl(tmp_path))


def test_mistakes_in_a_table_are_said(tmp_path: Path) -> None:
    file = tmp_path / "robot.csv"
    for text, expected in [
        ("0,0,0\n0,0,2\n0,0,1\n0,0,3\n", "turns by more than 90 degrees at point 1, and at one other"),
        ("foo_x,foo_y,foo_z\n0,0,0\n0,0,1\n", "'foo_x', 'foo_y' and 'foo_z' are read as the position"),
        ("0,5,5,2\n1,5,6,3\n2,5,7,4\n", "the first column counts the lines"),
    ]:
        file.write_text(text)
        with pytest.warns(UserWarning, match=expected) as found:
            load_centreline(file)
        assert len(found) == 1
    file.write_text("x,y,z,radius,diameter\n0,0,0,1,2\n0,0,1,1,2\n")
    with pytest.raises(ContinuumError, match="'radius' and 'diameter', and both may be the radius"):
        load_centreline(file)


def test_a_margin_and_the_order_of_points_are_doubted() -> None:
    wall = Mesh(VERTICES, FACES)
    line = np.array([[0, 0, -4], [0, 0, -2], [0, 0, 1], [0, 0, 4.0]])
    assert wall.doubts(line, 0.5, margin=2) == wall.doubts(line, 0.5, margin=0) == []
    (doubt,) = wall.doubts(line, 0.5, margin=0.002)
    assert doubt.startswith("the margin 0.002 is small beside the mesh's box, which measures 34.")
    (doubt,) = wall.doubts(line[[0, 2, 1, 3]], 0.5)
    assert doubt.startswith("the robot turns by more than 90 degrees at point 1, and at one other point")
    (doubt,) = wall.doubts(np.stack([line, line[[0, 2, 3, 1]]]), 0.5)
    assert doubt.startswith("robot 1: the robot turns by more than 90 degrees at point 2;")
