"""Meshes and robots for the tests, drawn by number."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def sphere(radius: float = 10.0, around: int = 24, up: int = 12) -> tuple[Array, NDArray[np.int64]]:
    """A closed ball of triangles that face outward."""
    polar = np.pi * np.arange(1, up) / up
    azimuth = 2 * np.pi * np.arange(around) / around
    rings = np.stack(
        [
            np.outer(np.sin(polar), np.cos(azimuth)),
            np.outer(np.sin(polar), np.sin(azimuth)),
            np.outer(np.cos(polar), np.ones(around)),
        ],
        axis=-1,
    )
    vertices = radius * np.concatenate([[[0, 0, 1.0]], rings.reshape(-1, 3), [[0, 0, -1.0]]])
    faces = []
    last = len(vertices) - 1
    for k in range(around):
        n = (k + 1) % around
        faces.append([0, 1 + k, 1 + n])
        faces.append([last, last - around + n, last - around + k])
        for ring in range(up - 2):
            a, b = 1 + ring * around, 1 + (ring + 1) * around
            faces += [[a + k, b + k, b + n], [a + k, b + n, a + n]]
    return vertices, np.array(faces)


def soup(random: np.random.Generator, faces: int = 40, extent: float = 5.0) -> tuple[Array, NDArray[np.int64]]:
    """Triangles anywhere, slivers and such without area among them."""
    corners = random.uniform(-extent, extent, (faces, 1, 3)) + random.normal(size=(faces, 3, 3))
    corners[::7, 2] = corners[::7, 1]
    corners[3::7, 2] = corners[3::7, 1] + 1e-9
    return corners.reshape(-1, 3), np.arange(3 * faces).reshape(-1, 3)


def robots(random: np.random.Generator, count: int, points: int = 12, step: float = 0.5) -> Array:
    """Centrelines that bend gently, of the shape (count, points, 3)."""
    direction = random.normal(size=(count, 3))
    place = random.uniform(-4, 4, (count, 3))
    rows = [place]
    for _ in range(points - 1):
        direction = direction / np.linalg.norm(direction, axis=1)[:, None] + 0.1 * random.normal(size=(count, 3))
        place = place + step * direction / np.linalg.norm(direction, axis=1)[:, None]
        rows.append(place)
    return np.stack(rows, axis=1)


def poses(random: np.random.Generator, count: int) -> Array:
    """Rigid 4x4 matrices."""
    matrices = np.tile(np.eye(4), (count, 1, 1))
    rotations, upper = np.linalg.qr(random.normal(size=(count, 3, 3)))
    rotations *= np.sign(np.linalg.det(rotations))[:, None, None]
    matrices[:, :3, :3] = rotations
    matrices[:, :3, 3] = random.normal(size=(count, 3))
    return matrices
