"""The examples run. Those whose packages are not installed are skipped, unless REQUIRE_EXAMPLES is set."""

from __future__ import annotations

import importlib
import os
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from parry_continuum import Mesh
from shapes import sphere

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


@pytest.mark.skipif(sys.platform == "win32", reason="signals of the cluster differ")
def test_dask() -> None:
    example("dask_blocks", "distributed").main(20_000)  # compares with this process


@pytest.mark.skipif(sys.platform == "win32", reason="signals of the cluster differ")
def test_ray(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(EXAMPLES))
    example("ray_blocks", "ray").main(20_000)  # compares with this process
