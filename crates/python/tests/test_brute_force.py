"""Against numpy alone: every segment with every triangle."""

from __future__ import annotations

import numpy as np

from parry_continuum import Mesh, Side
from shapes import Array, robots, soup, sphere


def to_triangle(p: Array, triangles: Array) -> Array:
    """Distances of points from triangles: from the plane where the foot is inside, else from the nearest edge."""
    a, b, c = np.moveaxis(triangles, -2, 0)
    n = np.cross(b - a, c - a)
    length = np.linalg.norm(n, axis=-1)
    is_inside = length > 0
    for s, e in ((a, b), (b, c), (c, a)):
        is_inside = is_inside & (np.sum((p - s) * np.cross(n, e - s), axis=-1) >= 0)
    plane = np.abs(np.sum((p - a) * n, axis=-1)) / np.where(length > 0, length, 1)
    edges = np.min([to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)], axis=0)
    return np.where(is_inside, plane, edges)


def to_segment(p: Array, a: Array, b: Array) -> Array:
    d = b - a
    square = np.sum(d * d, axis=-1)
    t = np.clip(np.sum((p - a) * d, axis=-1) / np.where(square > 0, square, 1), 0, 1)
    return np.linalg.norm(p - a - t[..., None] * d, axis=-1)


def capsule_distance(p: Array, q: Array, radius: float, triangles: Array) -> float:
    """The distance from a triangle is convex along the segment, so that ternary search finds the least."""
    low, high = np.zeros(len(triangles)), np.ones(len(triangles))

    def at(t: Array) -> Array:
        return to_triangle(p + t[:, None] * (q - p), triangles)

    for _ in range(60):
        third = (high - low) / 3
        is_left = at(low + third) <= at(high - third)
        low, high = np.where(is_left, low, low + third), np.where(is_left, high - third, high)
    return max(0.0, float(min(at(t).min() for t in (low, 0 * low, 0 * low + 1))) - radius)


def test_capsules() -> None:
    random = np.random.default_rng(11)
    vertices, faces = soup(random, faces=30, extent=3.0)
    mesh = Mesh(vertices, faces)
    points = robots(random, 20, points=4, step=1.0)
    links = mesh.per_link(points, 0.4, caps="capsules")
    touching = 0
    for k, robot in enumerate(points):
        for s in range(3):
            expected = capsule_distance(robot[s], robot[s + 1], 0.4, vertices[faces])
            touching += expected == 0
            # Ternary search ends where rounding hides the slope, about the root of the rounding away.
            assert abs(links.distance[k, s] - expected) < 1e-7
    assert 5 < touching < 55


def test_flat_ends_by_sampling() -> None:
    """No sampled point of a flat-ended cylinder is nearer than its distance, and one is nearly as near."""
    random = np.random.default_rng(12)
    vertices, faces = soup(random, faces=12)
    mesh = Mesh(vertices, faces)
    angle, out = np.meshgrid(np.linspace(0, 2 * np.pi, 60, endpoint=False), np.linspace(0, 1, 8))
    disc = np.stack([np.cos(angle) * out, np.sin(angle) * out], axis=-1).reshape(-1, 2)
    for points in robots(random, 8, points=2, step=1.5):
        axis = (points[1] - points[0]) / np.linalg.norm(points[1] - points[0])
        across = np.linalg.svd(axis[None])[2][1:]
        along = points[0] + np.linspace(0, 1, 60)[:, None] * (points[1] - points[0])
        samples = (along[:, None] + 0.3 * disc @ across).reshape(-1, 3)
        sampled = to_triangle(samples[:, None], vertices[faces]).min()
        found = mesh.distance(points, 0.3)
        assert found <= sampled + 1e-12
        assert sampled - found < 0.05


def test_sides() -> None:
    mesh = Mesh(*sphere(10.0, 24, 12))
    random = np.random.default_rng(13)
    points = random.uniform(-12, 12, (5, 200, 3))
    sides = mesh.side(points)
    assert sides.shape == (5, 200)
    length = np.linalg.norm(points, axis=-1)
    assert (sides[length < 9.5] == Side.INSIDE).all() and (sides[length > 10] == Side.OUTSIDE).all()
    assert {*sides.ravel()} == {-1, 1}
    assert mesh.side(mesh.vertices[5]) is Side.UNDECIDED and mesh.side([np.nan, 0, 0]) is Side.UNDECIDED
