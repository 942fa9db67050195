"""The examples run. Those whose packages are not installed are skipped, unless REQUIRE_EXAMPLES is set."""

from __future__ import annotations

import importlib
import itertools
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from parry_continuum import Decision, Mesh, RobotPair
from shapes import Array, poses, sphere

EXAMPLES = Path(__file__).parent.parent / "examples"


@pytest.fixture(autouse=True)
def beside_the_examples(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.syspath_prepend(EXAMPLES)
    monkeypatch.chdir(tmp_path)


def example(name: str, *packages: str) -> ModuleType:
    if not os.environ.get("REQUIRE_EXAMPLES"):
        for package in packages:
            pytest.importorskip(package)
    return importlib.import_module(name)


def test_jax() -> None:
    example("jax_gradient", "jax").main()  # compares with differences


def test_torch() -> None:
    example("torch_gradient", "torch").main()  # compares with differences


def test_elastica() -> None:
    mesh, free, held = example("elastica_contact", "elastica").main(30_000)
    in_wall = [mesh.per_link(rod.position_collection.T, rod.radius).distance == 0 for rod in (free, held)]
    # Without contact the rod ends in the wall or beyond it.
    tip = free.position_collection[:, -1]
    assert in_wall[0].any() or np.hypot(*tip[:2]) > 11e-3
    assert not in_wall[1].any()
    assert np.isfinite(held.position_collection).all()


def test_audit(tmp_path: Path) -> None:
    """A robot that stands in the wall for some steps, and one whose tip jumps through it."""
    audit = example("audit")
    vertices, faces = sphere(10.0, 60, 30)
    wall = tmp_path / "wall.obj"
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    wall.write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]))
    robot = np.stack([np.linspace(-3, 3, 13), np.zeros(13), np.zeros(13)], axis=1)
    shapes = np.stack([robot + [shift, 0, 0] for shift in (0, 3, 7, 7.5, 3, 0, 18, 18)])
    np.savez(tmp_path / "shapes.npz", points=shapes)
    rows = audit.main([str(wall), str(tmp_path / "shapes.npz"), "--radius", "0.5"])
    assert [row[0] for row in rows] == [2, 3, 5]
    assert [row[1][:4] for row in rows] == ["in t", "in t", "thro"]
    mesh = Mesh(vertices, faces)
    for step, _, segment, place, depth in rows[:2]:
        assert mesh.per_link(shapes[step], 0.5).distance[segment] == 0
        assert abs(np.linalg.norm(place) - 10) < 0.1 and depth > 0
    assert "on the way" in rows[2][1]


def test_trimesh() -> None:
    shown, links = example("trimesh_scene", "trimesh").main("scene.glb")
    assert Path("scene.glb").stat().st_size > 1000
    assert len(shown.geometry["closest"].entities) == len(links.distance)


def test_picture() -> None:
    distance = example("picture", "matplotlib").main("clearance.png")
    assert Path("clearance.png").stat().st_size > 1000 and distance.shape == (200, 39)


def test_slices() -> None:
    distance = example("slices", "matplotlib", "nibabel").main("slices.png")
    # The narrow lumen, less the catheter that is 1 mm beside its axis, within a voxel's diagonal.
    assert Path("slices.png").stat().st_size > 1000 and abs(distance - (6.3 - 1 - 1)) < 3**0.5


def test_slices_cut_triangles_and_robots() -> None:
    slices = example("slices", "matplotlib", "nibabel")
    # A plane cuts one of two triangles, at the middles of two edges.
    vertices = np.array([[0.0, 0, 0], [2, 0, 2], [0, 2, 2], [9, 9, 9]])
    segments = slices.cut(vertices, np.array([[0, 1, 2], [1, 2, 3]]), 2, 1.0)
    assert np.allclose(np.sort(segments, axis=1), [[[0, 0, 1], [1, 1, 1]]])
    bent = np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0]])
    places = np.array([[1, 0.5, 0], [4.5, 3, 0], [1, 2, 0]])
    assert np.array_equal(slices.in_robot(places, bent, 1.0), [0, 1, np.nan], equal_nan=True)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of the cluster differ")
def test_dask() -> None:
    example("dask_blocks", "distributed").main(20_000)  # compares with this process


@pytest.mark.skipif(sys.platform == "win32", reason="signals of the cluster differ")
def test_ray(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(EXAMPLES))
    example("ray_blocks", "ray").main(20_000)  # compares with this process


def along(world: Any, rows: Array, steps: int = 80) -> Array:
    """Centrelines (T, 2 * steps + 1, 3) of rows (T, 2, 3), laid out step by step as the definition of `BendingMotion` says."""
    at, frame = np.zeros((len(rows), 3)), np.tile(np.eye(3), (len(rows), 1, 1))
    points = [at]
    for length, x, y in np.moveaxis(rows, 0, -1):
        turn = np.zeros((len(rows), 3, 3))
        turn[:, 0, 2], turn[:, 1, 2] = x * length / steps, y * length / steps
        turn -= np.swapaxes(turn, 1, 2)
        half = np.eye(3) + turn / 2 + turn @ turn / 8 + turn @ turn @ turn / 48
        for _ in range(steps):
            at = at + (frame @ half)[:, :, 2] * length[:, None] / steps
            frame = frame @ half @ half
            points.append(at)
    shapes: Array = np.stack(points, axis=1) @ world.base[:3, :3].T + world.base[:3, 3]
    return shapes


def sampled_slack(ompl_plan: ModuleType, world: Any, edge: Array, times: Array) -> float:
    """The least slack in the shapes of an edge at these times, by single questions. Flat ends are off by less than 0.01 mm."""
    start, end = ompl_plan.sections(edge)
    shapes, radii = along(world, start + times[:, None, None] * (end - start)), np.repeat([1.0, 0.7], 80)
    found = [mesh.distance(shapes, radii).min() - margin for mesh, margin in world.structures.values()]
    return float(min(*found, RobotPair().minimum(shapes, radii, *world.second).distance.min() - 0.5))


def test_ompl() -> None:
    ompl_plan = example("ompl_plan", "ompl", "matplotlib")
    few = ["--plans", "2", "--rings", "40", "--seconds", "1"]
    # So long a segment is a whole edge: OMPL's validator looks at the ends only.
    world, outcomes, path, files = ompl_plan.main([*few, "--steps", "50"])
    assert {name for name, _ in outcomes} == {"RRTConnect", "PRM"} and {step for _, step in outcomes} == {None, 50.0}

    fine = np.linspace(0, 1, 160)
    assert len(path) > 2
    for edge in itertools.pairwise(path):
        assert sampled_slack(ompl_plan, world, np.stack(edge), fine) > -0.01
        assert ompl_plan.are_within_limits(np.linspace(*edge, 50)).all()
    random, touching = np.random.default_rng(1), 0
    for (_, step), run in ((name, run) for name, runs in outcomes.items() for run in runs):
        assert 0 < len(run.accepted) <= run.checked
        assert step is not None or not run.touching.any()
        assert ompl_plan.are_within_limits(run.accepted).all()
        for k in random.permutation(len(run.accepted))[:6]:
            if run.touching[k]:
                motions = [world.motion(*run.accepted[k]), world.rest]
                at = world.scene.clears_motion(motions, resolution=1e-3).t
                assert sampled_slack(ompl_plan, world, run.accepted[k], np.array([at])) < 0.01
                touching += 1
            else:
                assert sampled_slack(ompl_plan, world, run.accepted[k], fine[::2]) > -0.01
    assert touching >= 2  # at least the edge from the start to the goal of each plan

    assert len(files) == 3 * (len(path) - 1) and Path("plan/plan.png").stat().st_size > 1000
    checker = Path(__file__).parents[3] / "docs" / "book" / "check_proof.py"
    for proof in files:
        wall = proof.with_name(proof.name.split("-")[0] + ".obj")
        done = subprocess.run([sys.executable, str(checker), str(wall), str(proof)], capture_output=True, text=True, check=False)
        assert done.stdout.splitlines()[-1] == "yes", done.stdout

    # The same cavity from files.
    np.savetxt("base.txt", world.base)
    organs = ["--organ", "plan/organ0.obj", "--organ", "plan/organ1.obj"]
    files_of_it = ["--mesh", "plan/wall.obj", "--base", "base.txt", *organs]
    read, outcomes, path, _ = ompl_plan.main([*few, "--steps", "--plans", "1", "--output", "read", *files_of_it])
    assert len(read.structures) == 3 and {step for _, step in outcomes} == {None}
    assert all(sampled_slack(ompl_plan, world, np.stack(edge), fine) > -0.01 for edge in itertools.pairwise(path))


def test_ompl_shapes_and_the_second_robot() -> None:
    ompl_plan = example("ompl_plan", "ompl", "matplotlib")
    random = np.random.default_rng(2)
    world = ompl_plan.World({}, poses(random, 1)[0], 0.5)
    low, high = ompl_plan.BOUNDS
    states = random.uniform(low, high, (20, 6))
    states[0, [1, 2, 4, 5]] = 0
    shapes = ompl_plan.centrelines(states) @ world.base[:3, :3].T + world.base[:3, 3]
    expected = along(world, ompl_plan.sections(states))
    assert np.abs(shapes[:, -1] - expected[:, -1]).max() < 1e-3
    for shape, state in zip(shapes, states):
        assert np.allclose(ompl_plan.centrelines(state) @ world.base[:3, :3].T + world.base[:3, 3], shape, rtol=0, atol=1e-12)
        floor = Mesh([[-99, -99, -60], [99, -99, -60], [0, 99, -50]], [[0, 1, 2]])
        still = floor.clearance_of_motion(world.motion(state, state), tolerance=1e-3)
        # The links contain the tube.
        assert still.lower - 0.05 < floor.distance(shape, ompl_plan.LINK_RADII) < still.upper

    # Towards the second robot, and away from it.
    straight = np.array([[7.0, 0, 0], [5.0, 0, 0]])
    for side, decision in ((-1, Decision.CONTACT), (1, Decision.CLEAR)):
        bent = straight + side * np.array([[0, 0.05, 0], [0, 0.06, 0]])
        start, end = (straight * ompl_plan.SCALE).ravel(), (bent * ompl_plan.SCALE).ravel()
        assert world.clears(start) and world.clears(end) is (decision is Decision.CLEAR)
        assert world.decide(start, end) is decision
