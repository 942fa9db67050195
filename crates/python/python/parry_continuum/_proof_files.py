"""A proof and its mesh as files for the checker."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import Optional, Union

import numpy as np

from ._answers import Floats, Ints
from ._errors import ContinuumError
from ._native import Mesh

AnyPath = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]


def _digest(vertices: Floats, faces: Ints) -> str:
    """The SHA-256 of a mesh as a proof states it: docs/book/proofs.md, Format."""
    sha = hashlib.sha256()
    sha.update((vertices + 0.0).astype("<f8").tobytes())  # -0 counts as 0
    sha.update(faces.astype("<u4").tobytes())
    return sha.hexdigest()


def _obj(vertices: Floats, faces: Ints) -> str:
    """A Wavefront OBJ file. ``repr`` writes a number so that it is read as the same double."""
    lines = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}\n" for a, b, c in (faces + 1).tolist()]
    return "".join(lines)


def write_proof(path: AnyPath, mesh: Mesh, proof: Optional[str]) -> Path:
    """Writes a proof, and beside it the mesh that the proof is about, for the checker.

    The mesh is a Wavefront OBJ file with the name of the proof and the extension ``.obj``. Then
    ``python docs/book/check_proof.py proof.obj proof.txt`` checks the proof without this library.

    Parameters
    ----------
    path : str, bytes or os.PathLike
        The file of the proof, such as ``"proof.txt"``. Existing files are replaced.
    mesh : Mesh
        The mesh whose ``prove``, ``prove_tube`` or ``prove_motion`` returned the proof.
    proof : str
        The proof.

    Returns
    -------
    pathlib.Path
        The file of the mesh.

    Raises
    ------
    ContinuumError
        ``proof`` is None, because the margin is not kept, or no proof; the proof is about another
        mesh, or the mesh has moved since (``kind`` is ``"answer_does_not_fit"``); or ``path`` has
        the extension of the mesh. No file is written then.
    OSError
        A file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from parry_continuum import Mesh, write_proof
    >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    >>> proof = floor.prove([[0, 0, 2], [1, 0, 2]], 0.5, margin=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     wall = write_proof(Path(folder, "proof.txt"), floor, proof)
    ...     print(wall.name, wall.read_text().splitlines()[0])
    proof.obj v -9.0 -9.0 0.0
    """
    if proof is None:
        text = "`proof` is None: the margin is not kept; ask for a smaller margin"
        raise ContinuumError(text, kind="bad_type")
    words = proof.split(maxsplit=8) if isinstance(proof, str) else []
    if words[:5] != ["proof", "of", "clearance", "2", "mesh"] or len(words) < 9:
        text = "`proof` is no proof; give what `prove`, `prove_tube` or `prove_motion` returned"
        raise ContinuumError(text, kind="bad_type")
    vertices, faces = mesh.vertices, mesh.faces
    stated = [str(len(vertices)), str(len(faces)), _digest(vertices, faces)]
    if words[5:8] != stated:
        text = "`proof` is about another mesh, or the mesh has moved; prove the margin again"
        raise ContinuumError(text, kind="answer_does_not_fit")
    proof_path = Path(os.fsdecode(path))
    mesh_path = proof_path.with_suffix(".obj")
    if mesh_path == proof_path:
        text = f"`path` {proof_path} is where the mesh goes; choose another extension, as .txt"
        raise ContinuumError(text, kind="file")
    mesh_path.write_bytes(_obj(vertices, faces).encode("ascii"))
    proof_path.write_bytes(proof.encode("ascii"))
    return mesh_path
