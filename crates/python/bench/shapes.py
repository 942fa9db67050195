"""What is asked about: a cavity with a bumpy wall, and robots of 30 links in it, in millimetres."""

import numpy as np

RADIUS = 0.8


def cavity(subdivisions=6):
    """82,000 triangles by default, about 50 mm from the centre."""
    t = (1 + np.sqrt(5)) / 2
    vertices = np.array([[-1, t, 0], [1, t, 0], [-1, -t, 0], [1, -t, 0], [0, -1, t], [0, 1, t], [0, -1, -t], [0, 1, -t],
                         [t, 0, -1], [t, 0, 1], [-t, 0, -1], [-t, 0, 1]])
    faces = np.array([[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6],
                      [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10],
                      [8, 6, 7], [9, 8, 1]])
    for _ in range(subdivisions):
        edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        edges, places = np.unique(edges, axis=0, return_inverse=True)
        a, b, c = faces.T
        ab, bc, ca = len(vertices) + places.reshape(-1, 3).T
        vertices = np.concatenate([vertices, vertices[edges].mean(axis=1)])
        faces = np.concatenate([np.stack(corners, 1) for corners in [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]])
    vertices = vertices / np.linalg.norm(vertices, axis=1)[:, None]
    random = np.random.default_rng(1)
    radius = np.full(len(vertices), 50.0)
    for frequency in (1, 2, 4, 8, 16):
        for wave in random.normal(size=(6, 3)):
            phase = 3 * frequency * (vertices @ wave) / np.linalg.norm(wave) + random.uniform(0, 2 * np.pi)
            radius += 0.7 / frequency * np.sin(phase)
    return np.ascontiguousarray(vertices * radius[:, None] * [1.0, 0.8, 1.2]), np.ascontiguousarray(faces)


def robots(count, points=31, length=75.0):
    """Three pieces of constant curvature each, from near the lower end of the cavity."""
    random = np.random.default_rng(2)
    step = length / (points - 1)
    place = random.normal(size=(count, 3)) * [3, 3, 0] - [0, 0, 40]
    axes = np.tile(np.eye(3), (count, 1, 1))
    bends = random.normal(size=(count, 3, 2)) * 0.025
    out = np.empty((count, points, 3))
    for k in range(points):
        out[:, k] = place
        x, y = (bends[:, min(3 * k // (points - 1), 2)] * step).T
        angle = np.hypot(x, y)
        zero = 0 * x
        cross = np.stack([zero, zero, y, zero, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
        turn = np.eye(3) + (np.sin(angle) / angle)[:, None, None] * cross
        axes = axes @ (turn + ((1 - np.cos(angle)) / angle**2)[:, None, None] * (cross @ cross))
        place = place + step * axes[:, :, 2]
    return out
