"""Meshes on the GPU: answers are those of the CPU, to the last bit, and what does not work says what to do.

Where no GPU is found, only the refusals are tested. PARRY_CONTINUUM_REQUIRE_GPU=1 makes its absence a failure.
"""

from __future__ import annotations

import copy
import io
import math
import multiprocessing
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import parry_continuum
from parry_continuum import ContinuumError, Mesh, Scene, gpu_available, load
from shapes import Array, poses, robots, soup, sphere
from test_processes import METHODS, in_child, needs_fork, quiet

TESTS = Path(__file__).parent
IS_REQUIRED = os.environ.get("PARRY_CONTINUUM_REQUIRE_GPU") == "1"
IS_AVAILABLE = gpu_available()
needs_gpu = pytest.mark.skipif(not IS_AVAILABLE and not IS_REQUIRED, reason="no GPU, or a build without the feature gpu")
VERTICES, FACES = sphere()
FLOOR = np.array([[-9.0, -9, 0], [9, -9, 0], [0, 9, 0]])
THREADS = int(os.environ.get("RAYON_NUM_THREADS", 0)) or os.cpu_count() or 1
# From so many links on the GPU answers a batch of any question.
LINKS = 15_000 * THREADS
CAPS = ["fitted", "capsules", "cylinders"]


def counted(points: int) -> int:
    """How many robots of so many points go to the GPU."""
    return math.ceil(LINKS / (points - 1))


def bits(found: Any) -> list[bytes]:
    """All numbers of an answer, so that NaN equals NaN and 0 differs from -0."""
    fields = found if isinstance(found, tuple) else (found,)
    return [np.asarray(field).tobytes() for field in fields]


def on_gpu(mesh: Mesh, ask: Callable[[Mesh], Any]) -> Any:
    """What the mesh answers, on the GPU."""
    assert mesh.device == "gpu"
    before = mesh.gpu_seconds
    found = ask(mesh)
    # A GPU may keep no time; Mesa's does.
    assert mesh.gpu_seconds != before if IS_REQUIRED else mesh.gpu_seconds != before or before is None
    return found


def not_on_gpu(mesh: Mesh, ask: Callable[[Mesh], Any]) -> Any:
    before = mesh.gpu_seconds
    found = ask(mesh)
    assert mesh.gpu_seconds == before
    return found


def agree(mesh: Mesh, points: Array, radii: Any, **more: Any) -> None:
    """Compares all questions that go to the GPU with a mesh on the CPU."""
    cpu = Mesh(mesh.vertices, mesh.faces)
    distances = cpu.distance(points, radii, **more)
    margins = [0.0, float(np.median(distances)), float(np.nextafter(np.median(distances), 0)), 1e9]
    asks: list[Callable[[Mesh], Any]] = [
        lambda it: it.distance(points, radii, **more),
        lambda it: it.minimum(points, radii, **more),
        lambda it: it.per_link(points, radii, **more),
        *[lambda it, margin=margin: it.clears(points, radii, margin=margin, **more) for margin in margins],
    ]
    for ask in asks:
        assert bits(on_gpu(mesh, ask)) == bits(ask(cpu))


# What is refused, with any build and on any machine.


@pytest.mark.parametrize("device", ["cuda", "GPU", "", b"gpu", None, 0])
def test_other_devices(device: Any) -> None:
    file = io.BytesIO(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    file.name = "floor.obj"
    mesh = Mesh(VERTICES, FACES)
    for make in (lambda: Mesh(FLOOR, [[0, 1, 2]], device=device), lambda: Mesh(mesh, device=device), lambda: load(file, device=device)):
        with pytest.raises(ContinuumError) as caught:
            make()
        assert caught.value.kind == "bad_device"
        assert str(caught.value) == f"`device` is {device!r}; it must be 'cpu' or 'gpu'"


def test_the_default_is_the_cpu() -> None:
    mesh = Mesh(VERTICES, FACES)
    assert (mesh.device, mesh.gpu_seconds, repr(mesh)) == ("cpu", None, "Mesh(266 vertices, 528 faces)")
    assert Mesh(mesh, device="cpu").device == copy.copy(mesh).device == "cpu"


def test_where_there_is_no_gpu() -> None:
    program = """
import pickle, warnings
from parry_continuum import ContinuumError, Mesh, gpu_available
from parry_continuum._copies import mesh as unpickled
from shapes import sphere
vertices, faces = sphere()
assert not gpu_available()
try:
    Mesh(vertices, faces, device="gpu")
except ContinuumError as error:
    print(error.kind, error)
for make in (lambda: Mesh(Mesh(vertices, faces), device="gpu"),):
    try:
        make()
        raise SystemExit("is on a GPU")
    except ContinuumError:
        pass
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    mesh = unpickled(vertices, faces, None, "mm", "gpu")
assert mesh.device == "cpu" and mesh.unit == "mm" and len(mesh.faces) == len(faces)
print(caught[0].message)
"""
    hidden = {**os.environ, "WGPU_BACKEND": "vulkan", "VK_DRIVER_FILES": os.devnull, "VK_ICD_FILENAMES": os.devnull}
    done = subprocess.run([sys.executable, "-c", program], cwd=TESTS, env=hidden, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    refusal, warning = done.stdout.splitlines()
    kind, _, text = refusal.partition(" ")
    remedy = {"no_gpu_support": "--config-settings=build-args='--features gpu'", "no_adapter": "install a driver for Vulkan"}[kind]
    assert remedy in text and text.startswith("`device`") and "cpu" in text.lower()
    assert warning.startswith("a mesh that was on the GPU is unpickled on the CPU") and text in warning
    assert kind == "no_adapter" or not IS_AVAILABLE


def test_a_gpu_where_one_is_required() -> None:
    assert IS_AVAILABLE or not IS_REQUIRED


# Answers.


def plate(cells: int = 30) -> tuple[Array, Any]:
    """A square in the plane z = 0, whose points and edges belong to many triangles at equal distances."""
    x, y = np.meshgrid(np.arange(cells + 1.0), np.arange(cells + 1.0), indexing="ij")
    vertices = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1) - [cells / 2, cells / 2, 0]
    a = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    return vertices, np.concatenate([np.stack([a, a + cells + 1, a + 1], 1), np.stack([a + 1, a + cells + 1, a + cells + 2], 1)])


def fan(count: int = 400) -> tuple[Array, Any]:
    """Triangles whose tips meet at the origin: more at one distance than the GPU keeps."""
    turn = np.arange(count) / 16
    height = 1 + 0.001 * np.arange(count)
    ends = [np.stack([np.cos(turn + more), np.sin(turn + more), height], 1) for more in (0, 0.1)]
    vertices = np.concatenate([np.zeros((1, 3)), np.stack(ends, 1).reshape(-1, 3)])
    return vertices, np.stack([np.zeros(count, int), 1 + 2 * np.arange(count), 2 + 2 * np.arange(count)], 1)


MESHES: dict[str, Callable[[], tuple[Array, Any]]] = {
    "sphere": lambda: sphere(10.0, 60, 30),
    "soup": lambda: soup(np.random.default_rng(3), 200),
    "plate": plate,
    "fan": fan,
}


def nasty(random: np.random.Generator, count: int) -> Array:
    """Robots of 9 points on a grid, so that they touch, tie and lie in planes of triangles; some with links without length, some far
    away."""
    points = np.round(2 * robots(random, count, points=9, step=1.0)) / 2
    points[::5, 4] = points[::5, 3]
    points[1::5, :, 2] = 0.5
    points[2::50] *= 1e6
    points[3::100] += 1e12
    # A robot needs a length.
    points[:, -1] = points[:, 0] + [0.5, 0, 0]
    return points


@needs_gpu
@pytest.mark.parametrize("caps", CAPS)
@pytest.mark.parametrize("name", MESHES)
def test_random_robots(name: str, caps: str) -> None:
    random = np.random.default_rng(41)
    mesh = Mesh(*MESHES[name](), device="gpu")
    count = counted(12)
    radii = random.uniform(0.05, 0.6, (count, 11))
    radii[::2] = np.repeat(radii[::2, :1], 11, axis=1)
    agree(mesh, robots(random, count), radii, pose=poses(random, count), caps=caps)


@needs_gpu
@pytest.mark.parametrize("caps", CAPS)
@pytest.mark.parametrize("name", MESHES)
def test_nasty_robots(name: str, caps: str) -> None:
    mesh = Mesh(*MESHES[name](), device="gpu")
    agree(mesh, nasty(np.random.default_rng(5), counted(8)), 0.5, caps=caps)


@needs_gpu
@pytest.mark.parametrize("power", [-200, 40, 200])
def test_units(power: int) -> None:
    """Answers scale with the unit, bit for bit."""
    vertices, faces = sphere(10.0, 60, 30)
    many, scale = robots(np.random.default_rng(2), counted(12)), 2.0**power
    mesh, scaled = Mesh(vertices, faces, device="gpu"), Mesh(vertices * scale, faces, device="gpu")
    assert bits(on_gpu(scaled, lambda it: it.distance(many * scale, 0.25 * scale))) == bits(mesh.distance(many, 0.25) * scale)


@needs_gpu
def test_a_height_that_is_known() -> None:
    """Capsules beside the plane z = 0, whose distance is height - radius, and lowest of the triangles below a corner."""
    mesh = Mesh(*plate(), device="gpu")
    count = counted(2)
    height = 1 + np.arange(count) % 64 / 64
    points = np.zeros((count, 2, 3))
    points[:, :, 2] = height[:, None]
    points[:, 1, 2] += 1
    found = on_gpu(mesh, lambda it: it.minimum(points, 0.5))
    assert_array_equal(found.distance, height)
    capsules = on_gpu(mesh, lambda it: it.minimum(points, 0.5, caps="capsules"))
    assert_array_equal(capsules.distance, height - 0.5)
    at_origin = np.flatnonzero((mesh.vertices[mesh.faces] == 0).all(axis=2).any(axis=1))
    assert_array_equal(capsules.triangle, at_origin[0])
    assert_array_equal(on_gpu(mesh, lambda it: it.clears(points, 0.5, margin=1.25)), height > 1.25)


@needs_gpu
def test_sections() -> None:
    random = np.random.default_rng(47)
    mesh = Mesh(*sphere(10.0, 60, 30), device="gpu")
    cpu, count = Mesh(mesh.vertices, mesh.faces), counted(31)
    length, angle = random.uniform(1, 6, (count, 3)), random.uniform(-math.pi, math.pi, (count, 3))
    bend = random.uniform(0, 2, (count, 3)) / length
    sections = np.stack([length, bend * np.cos(angle), bend * np.sin(angle)], axis=2)
    sections[5, 1, 1] = 7 / length[5, 1]  # more than a turn: left to the CPU
    asks = [lambda it, margin=margin: it.clears_sections(sections, [0.5, 0.4, 0.3], segments=10, margin=margin) for margin in (0.0, 1.0, 1e9)]
    for ask in asks:
        assert bits(on_gpu(mesh, ask)) == bits(ask(cpu))
    assert 0 < asks[1](mesh).sum() < count
    sections[7, 0, 0] = -1
    for it in (mesh, cpu):
        with pytest.raises(ContinuumError) as caught:
            it.clears_sections(sections, 0.1, segments=10, margin=0.0)
        assert (caught.value.kind, caught.value.robot) == ("bad_length", 7)


@needs_gpu
def test_more_links_than_a_chunk() -> None:
    mesh, cpu = Mesh(VERTICES, FACES, device="gpu"), Mesh(VERTICES, FACES)
    many = robots(np.random.default_rng(8), 50_000)
    assert many.shape[0] * (many.shape[1] - 1) > 2**19
    assert bits(on_gpu(mesh, lambda it: it.minimum(many, 0.2))) == bits(cpu.minimum(many, 0.2))


@needs_gpu
def test_as_many_threads_as_a_large_machine_has() -> None:
    """Of more threads a batch must be larger, and no chunk of it may be too small for the GPU."""
    program = """
import numpy as np
from parry_continuum import Mesh
from shapes import robots, sphere
mesh = Mesh(*sphere(), device="gpu")
many = robots(np.random.default_rng(0), 40 * 15_000 // 2 + 1, points=3)
found = mesh.clears(many, 0.1, margin=4.0)
assert mesh.gpu_seconds is not None or not IS_REQUIRED
assert 0 < found.sum() < len(found)
"""
    program = program.replace("IS_REQUIRED", str(IS_REQUIRED))
    many = {**os.environ, "RAYON_NUM_THREADS": "40"}
    done = subprocess.run([sys.executable, "-c", program], cwd=TESTS, env=many, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@needs_gpu
def test_small_batches_and_other_questions_are_on_the_cpu() -> None:
    mesh, cpu = Mesh(VERTICES, FACES, device="gpu"), Mesh(VERTICES, FACES)
    many = robots(np.random.default_rng(9), 20)
    asks: list[Callable[[Mesh], Any]] = [
        lambda it: it.minimum(many[0], 0.2),
        lambda it: it.minimum(many[:20], 0.2),
        lambda it: it.per_link(many[:0], 0.2),
        lambda it: it.contacts_within(many, 0.2, margin=2.0),
        lambda it: it.clearance(many, 0.2, tolerance=0.1).lower,
        lambda it: it.distance_and_gradient(many, 0.2),
        lambda it: it.side(many[:, 0]),
        lambda it: it.clears_inside(many, 0.2, margin=0.1),
    ]
    for ask in asks:
        assert bits(not_on_gpu(mesh, ask)) == bits(ask(cpu))
    scene = Scene()
    scene.add("wall", mesh, margin=0.1)
    assert_array_equal(scene.per_structure([(many, 0.2)]).distance[:, 0], cpu.distance(many, 0.2))


# Moves and copies.


@pytest.fixture
def large() -> Mesh:
    """So large that single robots are answered on the GPU after a move. From within it few places are equally near."""
    vertices, faces = sphere(10.0, 260, 130)
    assert len(faces) >= 65_536
    lumps = 1 + 0.1 * np.sin(1.3 * vertices[:, :1]) * np.cos(0.9 * vertices[:, 1:2]) + 0.05 * np.sin(2.1 * vertices[:, 2:])
    return Mesh(lumps * vertices, faces, device="gpu")


@needs_gpu
def test_moves(large: Mesh) -> None:
    vertices, faces = large.vertices, large.faces
    many = robots(np.random.default_rng(1), counted(12)) + [5, 0, 0]
    asks: list[Callable[[Mesh], Any]] = [
        lambda it: it.distance(many[0], 0.1),
        lambda it: it.minimum(many[1], 0.1),
        lambda it: it.per_link(many[2], 0.1),
        lambda it: it.clears(many[3], 0.1, margin=1.0),
        lambda it: it.minimum(many[:30], 0.1),
        lambda it: it.per_link(many, 0.1),
    ]
    for turn in (1.1, 0.9):
        moved = vertices * [turn, 1, 1] + [0, 0, turn]
        large.set_vertices(moved)
        cpu = Mesh(moved, faces)
        assert_array_equal(large.vertices, moved)
        for ask in asks:
            # A robot that the GPU leaves to the CPU refits the search there, which then has all single robots.
            large.set_vertices(moved)
            assert bits(on_gpu(large, ask)) == bits(ask(cpu))
    for wrong in (moved[1:], np.where(moved == moved[5], np.nan, moved)):
        with pytest.raises(ContinuumError):
            large.set_vertices(wrong)
        assert bits(asks[1](large)) == bits(asks[1](cpu))
    # The search on the CPU follows where it is needed, and then answers single robots.
    assert bits(large.contacts_within(many[0], 0.1, margin=3.0)) == bits(cpu.contacts_within(many[0], 0.1, margin=3.0))
    assert bits(not_on_gpu(large, asks[0])) == bits(asks[0](cpu))
    large.set_vertices(vertices)
    large.prepare()
    assert bits(not_on_gpu(large, asks[0])) == bits(asks[0](Mesh(vertices, faces)))


@needs_gpu
def test_copies_move_by_themselves() -> None:
    mesh = Mesh(VERTICES, FACES, frame="RAS", unit="mm", device="gpu")
    many = robots(np.random.default_rng(1), counted(12))
    copies = [copy.copy(mesh), copy.deepcopy(mesh), pickle.loads(pickle.dumps(mesh)), Mesh(mesh, device="gpu")]
    for number, it in enumerate(copies):
        assert (it.device, it.frame, it.unit, repr(it)) == ("gpu", "RAS", "mm", "Mesh(266 vertices, 528 faces, device='gpu')")
        it.set_vertices(VERTICES * (1 + number))
    on_cpu = Mesh(mesh)
    assert on_cpu.device == "cpu" and Mesh(on_cpu, device="gpu").device == "gpu"
    expected = [Mesh(VERTICES * scale, FACES).minimum(many, 0.1) for scale in (1, 1, 2, 3, 4)]
    for _ in range(2):
        for it, found in zip([mesh, *copies], expected):
            assert bits(on_gpu(it, lambda it: it.minimum(many, 0.1))) == bits(found)
    # A copy of a mesh that has moved on the GPU only.
    copies[3].set_vertices(VERTICES * 5)
    found = Mesh(VERTICES * 5, FACES).minimum(many, 0.1)
    for it in (Mesh(copies[3]), Mesh(copies[3], device="gpu"), pickle.loads(pickle.dumps(copies[3]))):
        assert bits(it.minimum(many, 0.1)) == bits(found)


@needs_gpu
def test_a_file_on_the_gpu() -> None:
    file = io.BytesIO(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    file.name = "floor.obj"
    mesh = load(file, device="gpu")
    assert mesh.device == "gpu" and mesh.distance([[0, 0, 2.0], [0, 0, 3]], 0.5) == 2


# What goes wrong.


@needs_gpu
def test_errors_are_those_of_the_cpu() -> None:
    random = np.random.default_rng(4)
    mesh, cpu = Mesh(VERTICES, FACES, device="gpu"), Mesh(VERTICES, FACES)
    count = counted(12)
    many, radii, pose = robots(random, count), random.uniform(0.1, 0.2, (count, 11)), poses(random, count)

    def refused(it: Mesh, ask: Callable[..., Any], **more: Any) -> tuple[object, ...]:
        with pytest.raises(ContinuumError) as caught:
            ask(it, many, radii, pose=pose, **more)
        error = caught.value
        return str(error), error.kind, error.robot, error.index

    for first, spoil in [
        (900, lambda: many.__setitem__((900, 3), np.nan)),
        (800, lambda: many.__setitem__(800, 1e200)),
        (700, lambda: radii.__setitem__((700, 5), -1)),
        (600, lambda: pose.__setitem__(600, 2 * pose[600])),
        (500, lambda: many.__setitem__((500, 3), 1e160)),
        (0, lambda: radii.__setitem__((0, 0), np.inf)),
    ]:
        spoil()
        for ask, more in [(Mesh.minimum, {}), (Mesh.per_link, {}), (Mesh.clears, {"margin": 0.1})]:
            found = refused(mesh, ask, **more)
            assert found == refused(cpu, ask, **more)
            assert found[2] == first
    for margin in (-1.0, np.nan):
        assert refused(mesh, Mesh.clears, margin=margin)[:2] == refused(cpu, Mesh.clears, margin=margin)[:2]


@needs_gpu
def test_meshes_that_are_none() -> None:
    for vertices, faces in [(FLOOR, [[0, 1, 3]]), (FLOOR * [1, np.nan, 1], [[0, 1, 2]]), (FLOOR, np.zeros((0, 3), int))]:
        texts = []
        for device in ("cpu", "gpu"):
            with pytest.raises(ContinuumError) as caught:
                Mesh(vertices, faces, device=device)  # type: ignore[arg-type]
            texts.append((str(caught.value), caught.value.kind, caught.value.index))
        assert texts[0] == texts[1]


@needs_gpu
@pytest.mark.skipif(not IS_REQUIRED, reason="may fit into a GPU that is none in software")
def test_a_mesh_that_does_not_fit() -> None:
    """It is an error, before and after which the GPU answers."""
    mesh = Mesh(VERTICES, FACES, device="gpu")
    many = robots(np.random.default_rng(6), counted(12))
    expected = bits(Mesh(VERTICES, FACES).minimum(many, 0.1))
    large = np.tile(FACES, (5500, 1))
    for make in (lambda: Mesh(VERTICES, large, device="gpu"), lambda: Mesh(Mesh(VERTICES, large), device="gpu")):
        with pytest.raises(ContinuumError, match=r'triangles do not fit into the memory of .*device="cpu"') as caught:
            make()
        assert caught.value.kind == "mesh_too_large"
        assert bits(on_gpu(mesh, lambda it: it.minimum(many, 0.1))) == expected
    assert bits(on_gpu(Mesh(VERTICES, FACES, device="gpu"), lambda it: it.minimum(many, 0.1))) == expected


@needs_gpu
@pytest.mark.skipif(not IS_REQUIRED or sys.platform != "linux", reason="limits the memory of Mesa's GPU, which is the process's own")
def test_the_gpu_runs_out_of_memory() -> None:
    """It is an error of that batch; the next batch is answered on the GPU."""
    program = """
import resource
from pathlib import Path
import numpy as np
from parry_continuum import ContinuumError, Mesh
from test_gpu import fan
# All triangles are equally near, and the room for candidates grows to more than 100 MB.
mesh = Mesh(*fan(900), device="gpu")
many = np.array([[0, 0, -1], [0, 0, -1.5]]) + np.random.default_rng(0).uniform(-0.1, 0.1, (40_000, 1, 3))
few = many[:20_000]
expected = Mesh(mesh).minimum(few, 0.1)
# Too few links of 40 threads for the GPU: makes the robots, so that the next batch needs memory for its buffers alone.
mesh.clears(many, 0.1, margin=0.1)
assert mesh.gpu_seconds is None
used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
_, most = resource.getrlimit(resource.RLIMIT_AS)
resource.setrlimit(resource.RLIMIT_AS, (used + (100 << 20), most))
try:
    mesh.minimum(many, 0.1)
except ContinuumError as error:
    print(error.kind, error)
resource.setrlimit(resource.RLIMIT_AS, (most, most))
found = mesh.minimum(few, 0.1)
assert mesh.gpu_seconds is not None
assert all(np.array_equal(one, other) for one, other in zip(found, expected))
"""
    forty = {**os.environ, "RAYON_NUM_THREADS": "40"}
    done = subprocess.run([sys.executable, "-c", program], cwd=TESTS, env=forty, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("out_of_memory the GPU is out of memory; ask for less at once"), done.stdout


# Threads and processes.


@needs_gpu
def test_threads_share_the_gpu() -> None:
    """Some ask while others move the mesh and its copy: every batch sees one place of the vertices."""
    mesh = Mesh(VERTICES, FACES, device="gpu")
    other = copy.copy(mesh)
    many = robots(np.random.default_rng(1), 3000)
    expected = {bits(Mesh(VERTICES * scale, FACES).distance(many, 0.1))[0] for scale in (1, 2)}
    assert len(expected) == 2
    wrong: list[BaseException | str] = []

    def ask(it: Mesh) -> None:
        try:
            for turn in range(6):
                if bits(it.distance(many, 0.1))[0] not in expected:
                    wrong.append("mixed")
                it.per_link(many[turn], 0.1)
        except BaseException as error:
            wrong.append(error)

    def move(it: Mesh) -> None:
        try:
            for turn in range(20):
                it.set_vertices(VERTICES * (1 + turn % 2))
        except BaseException as error:
            wrong.append(error)

    threads = [threading.Thread(target=work, args=(it,)) for it in (mesh, other) for work in (ask, ask, move)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong
    # The GPU is free again.
    many = np.tile(many, (LINKS // 33_000 + 1, 1, 1))
    on_gpu(mesh, lambda it: it.clears(many, 0.1, margin=0.1))


def answers(mesh: Mesh) -> tuple[str, list[bytes]]:
    many = robots(np.random.default_rng(1), 600)
    return mesh.device, bits(mesh.minimum(many, 0.1))


@needs_gpu
@quiet
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.filterwarnings("ignore:a mesh that was on the GPU")
def test_pools_of_processes(method: str) -> None:
    mesh = Mesh(VERTICES, FACES, device="gpu")
    expected = answers(Mesh(VERTICES, FACES))[1]
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(method)) as processes:
        for found in processes.map(answers, [mesh] * 4):
            assert found == ("cpu" if method == "fork" else "gpu", expected)


@needs_gpu
@needs_fork
@quiet
def test_forks() -> None:
    """A child answers on the CPU, also after a move that only the GPU has followed, and in the middle of other threads' batches."""
    mesh = Mesh(VERTICES, FACES, device="gpu")
    mesh.set_vertices(VERTICES * 2)
    expected = answers(Mesh(VERTICES * 2, FACES))[1]
    many = robots(np.random.default_rng(1), counted(12))

    def child() -> bool:
        assert not gpu_available()
        with pytest.raises(ContinuumError, match="before this process was forked.*'spawn'") as caught:
            Mesh(VERTICES, FACES, device="gpu")
        assert caught.value.kind == "gpu_in_child"
        own = copy.copy(mesh)
        own.set_vertices(VERTICES * 3)
        moved = bits(own.minimum(many[:50], 0.1)) == bits(Mesh(VERTICES * 3, FACES).minimum(many[:50], 0.1))
        del own
        return moved and answers(mesh) == ("cpu", expected)

    assert in_child(child) == 0
    assert in_child(lambda: in_child(child) == 0) == 0
    is_over = threading.Event()

    def ask() -> None:
        while not is_over.is_set():
            mesh.per_link(many, 0.1)

    threads = [threading.Thread(target=ask) for _ in range(2)]
    for thread in threads:
        thread.start()
    try:
        for _ in range(10):
            assert in_child(child) == 0
    finally:
        is_over.set()
        for thread in threads:
            thread.join()
    assert answers(mesh) == ("gpu", expected)


@needs_gpu
def test_an_end_of_the_process() -> None:
    """While a mesh on the GPU is alive, and while a thread asks it."""
    program = """
import threading, numpy as np
from parry_continuum import Mesh
from shapes import robots, sphere
mesh = Mesh(*sphere(), device="gpu")
many = robots(np.random.default_rng(0), 5000)
mesh.distance(many, 0.1)
threading.Thread(target=lambda: [mesh.distance(many, 0.1) for _ in range(9)], daemon=True).start()
"""
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", program], cwd=TESTS, capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == 0, done.stderr


@needs_gpu
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="asks Linux how much memory is used")
@pytest.mark.parametrize(
    ("ask", "count"),
    [
        (lambda mesh, many: mesh.distance(many, 0.1), 300),
        (lambda mesh, many: mesh.set_vertices(mesh.vertices), 2000),
        (lambda mesh, many: (mesh.set_vertices(mesh.vertices), mesh.per_link(many, 0.1)), 200),
        (lambda mesh, many: Mesh(VERTICES, FACES, device="gpu"), 200),
    ],
)
def test_nothing_is_kept(ask: Any, count: int) -> None:
    mesh, many = Mesh(VERTICES, FACES, device="gpu"), robots(np.random.default_rng(0), 100 * THREADS)

    def pages() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1])

    for _ in range(count // 2):
        ask(mesh, many)
    before = pages()
    for _ in range(count):
        ask(mesh, many)
    # 8 MiB, of which the buffers of one mesh or one batch that each call kept would take several times as much.
    assert pages() - before < 2048
    assert parry_continuum.gpu_available()
