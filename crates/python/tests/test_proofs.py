"""Proofs are believed by the program that checks them, and by nobody once they are changed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from parry_continuum import BendingMotion, ContinuumError, LinearMotion, Mesh, write_proof
from shapes import sphere

CHECKER = Path(__file__).parents[3] / "docs" / "book" / "check_proof.py"
VERTICES, FACES = sphere()
WALL = Mesh(VERTICES, FACES)
BEND = np.array([[0.0, 0.0, 0.0], [0.0, 0.5, 2.0], [1.0, 1.0, 4.0]])


def obj(mesh: Mesh) -> str:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in mesh.faces.tolist()]
    return "\n".join(lines) + "\n"


def said(mesh: str, proof: str, folder: Path) -> tuple[int, list[str]]:
    """The exit status of the program, and the lines that it prints."""
    (folder / "wall.obj").write_bytes(mesh.encode())
    (folder / "proof.txt").write_bytes(proof.encode())
    command = [sys.executable, str(CHECKER), str(folder / "wall.obj"), str(folder / "proof.txt")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.stdout.replace("\n", "").isprintable()
    assert done.stdout.isascii()
    return done.returncode, done.stdout.splitlines()


def is_believed(mesh: Mesh, proof: str, folder: Path) -> bool:
    status, lines = said(obj(mesh), proof, folder)
    assert (lines[-1] == "yes") == (status == 0)
    return status == 0


def test_proofs_are_believed(tmp_path: Path) -> None:
    sections = np.array([[6.0, 0.01, 0.0]])
    motion = BendingMotion(sections, sections + [0.0, 0.02, 0.01], 0.5)
    proofs = {
        "chain": WALL.prove(BEND, 0.5, margin=1.0),
        "tube": WALL.prove_tube(BEND, 0.5, margin=1.0, resolution=0.01),
        "motion": WALL.prove_motion(motion, margin=1.0, resolution=0.01),
    }
    straight = WALL.prove_motion(BEND, BEND + [0, 0, 1], 0.5, margin=1.0, resolution=0.01)
    proofs["motion of points"] = straight
    for kind, proof in proofs.items():
        assert proof is not None, kind
        assert kind.split()[0] in proof.splitlines()[3]
        assert is_believed(WALL, proof, tmp_path), kind
        # Of another wall, or of a margin that nothing keeps.
        assert not is_believed(Mesh(VERTICES * 1.05, FACES), proof, tmp_path), kind
        assert not is_believed(WALL, proof.replace("margin 1.0", "margin 8.0"), tmp_path), kind


def test_what_is_not_clear_has_no_proof() -> None:
    assert WALL.prove(BEND, 0.5, margin=8.0) is None
    assert WALL.prove_tube(BEND, 0.5, margin=8.0, resolution=0.01) is None
    assert WALL.prove_motion(BEND, BEND + [0, 0, 9.0], 0.5, margin=0.0, resolution=0.01) is None
    assert WALL.prove_motion(LinearMotion(BEND, BEND, 0.5), margin=8.0, resolution=0.01) is None


def test_one_at_a_time() -> None:
    many = np.stack([BEND, BEND])
    for ask in (
        lambda: WALL.prove(many, 0.5, margin=1.0),
        lambda: WALL.prove_tube(many, 0.5, margin=1.0, resolution=0.01),
        lambda: WALL.prove_motion(many, many, 0.5, margin=1.0, resolution=0.01),
    ):
        with pytest.raises(ContinuumError, match="one robot or motion, and 2 are given") as raised:
            ask()
        assert raised.value.kind == "bad_shape"


def test_what_is_not_covered_is_said(tmp_path: Path) -> None:
    proof = WALL.prove(BEND, 0.5, margin=1.0)
    assert proof is not None
    _, lines = said(obj(WALL), proof, tmp_path)
    text = " ".join(lines)
    assert "Not covered" in text
    assert "the side of the wall" in text
    assert "premises" in text


def test_malformed_files_are_refused_in_one_line(tmp_path: Path) -> None:
    proof, mesh = WALL.prove(BEND, 0.5, margin=1.0), obj(WALL)
    assert proof is not None
    for changed in (
        "",
        "\0",
        "yes",
        proof.replace("chain 1", "\x1b[2K\x1b[1Ayes 1"),
        proof.replace("margin 1.0", "margin 1_0"),
        proof.replace("margin 1.0", "margin nan"),
        proof.replace("margin 1.0", "margin \u0661"),
        proof.replace("margin 1.0", "margin " + "9" * 100_000),
        proof.replace("end", "end\x1b[2K\ryes"),
    ):
        assert changed != proof
        status, lines = said(mesh, changed, tmp_path)
        assert status == 1
        assert len(lines) == 1
        assert lines[0].startswith("no: ")
    for changed in (
        mesh.replace("f 1 ", "f 0_1 ", 1),
        mesh.replace("f 1 ", "f \u0661 ", 1),
        mesh + "fo 1 2 3\n",
        mesh + "\x1b[2Kyes\n",
        mesh + "# \\\n",
    ):
        assert changed != mesh
        status, lines = said(changed, proof, tmp_path)
        assert status == 1
        assert len(lines) == 1
        assert lines[0].startswith("no: ")
    assert said(mesh.replace("\n", "\r\n"), proof.replace("\n", "\r\n"), tmp_path)[0] == 0


@pytest.mark.parametrize("given", [str, os.fsencode, Path])
def test_files_of_a_proof_are_believed(given: Any, tmp_path: Path) -> None:
    # Numbers of every length, and a negative zero.
    wall = Mesh(np.where(VERTICES == 0, -0.0, VERTICES / 3 * 1.1e-3), FACES)
    proof = wall.prove(BEND * 1e-4, 0.5e-4, margin=1e-4)
    path = tmp_path / "of the robot.v1.txt"
    mesh_path = write_proof(given(path), wall, proof)
    assert mesh_path == tmp_path / "of the robot.v1.obj"
    assert sorted(tmp_path.iterdir()) == [mesh_path, path]
    command = [sys.executable, str(CHECKER), str(mesh_path), str(path)]
    assert subprocess.run(command, capture_output=True, text=True, check=False).stdout.endswith("yes\n")
    assert b"\r" not in mesh_path.read_bytes() + path.read_bytes()


def moved() -> Mesh:
    wall = Mesh(VERTICES, FACES)
    wall.set_vertices(VERTICES * 1.01)
    return wall


@pytest.mark.parametrize(
    ("mesh", "proof", "path", "text", "kind"),
    [
        (WALL, None, "proof.txt", "`proof` is None: the margin is not kept", "bad_type"),
        (WALL, 3, "proof.txt", "`proof` is no proof", "bad_type"),
        (WALL, "proof of clearance 2 mesh", "proof.txt", "`proof` is no proof", "bad_type"),
        (Mesh(VERTICES, FACES[::-1]), ..., "proof.txt", "about another mesh", "answer_does_not_fit"),
        (moved(), ..., "proof.txt", "the mesh has moved", "answer_does_not_fit"),
        (WALL, ..., "proof.obj", "proof.obj is where the mesh goes", "file"),
    ],
)
def test_what_belongs_not_together_is_not_written(
    mesh: Mesh, proof: Any, path: str, text: str, kind: str, tmp_path: Path
) -> None:
    if proof is ...:
        proof = WALL.prove(BEND, 0.5, margin=1.0)
    with pytest.raises(ContinuumError, match=text) as raised:
        write_proof(tmp_path / path, mesh, proof)
    assert raised.value.kind == kind
    assert list(tmp_path.iterdir()) == []
