"""Very many shapes over Dask: `pip install 'dask[array,distributed]'`.

The mesh is sent to every worker once, blocks of shapes are mapped, and the distances come as one array. Nobody holds all
shapes: each block is made where it is asked about. Give `Client` the address of your cluster.
"""

import sys
import time

import dask.array as da
import numpy as np
from dask.distributed import Client

from parry_continuum import Mesh


def sphere(radius, subdivisions):
    """A closed wall: an octahedron whose faces are cut in four again and again."""
    vertices = np.concatenate([np.eye(3), -np.eye(3)])
    faces = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])
    for _ in range(subdivisions):
        corners = vertices[faces]
        middles = (corners + np.roll(corners, -1, axis=1)) / 2
        a, b, c = np.moveaxis(corners, 1, 0)
        ab, bc, ca = np.moveaxis(middles, 1, 0)
        triangles = np.concatenate([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]).reshape(4, 3, -1, 3)
        triangles = triangles.transpose(0, 2, 1, 3).reshape(-1, 3)
        vertices, faces = np.unique(triangles.round(12), axis=0, return_inverse=True)
        faces = faces.reshape(-1, 3)
    return radius * vertices / np.linalg.norm(vertices, axis=1)[:, None], faces


def shapes(start, count):
    """Shapes number `start` and so on, (count, 31, 3): what a planner's sampler does."""
    random = np.random.default_rng(start)
    turn = random.normal(scale=0.05, size=(count, 1, 2)) * np.arange(31)[:, None]
    direction = np.concatenate([np.sin(turn), np.cos(np.linalg.norm(turn, axis=-1, keepdims=True))], axis=-1)
    return np.cumsum(direction, axis=1) - [0, 0, 15]


def block_of_distances(mesh, block_info=None):
    (start, end), = block_info[None]["array-location"]
    return mesh.distance(shapes(start, end - start), 0.4)


def distances(client, mesh, count, block):
    """All distances, as an array whose blocks lie with the workers that made them."""
    sent = client.scatter(mesh, broadcast=True, hash=False)  # under a name of its own each time
    blocks = tuple(min(block, count - start) for start in range(0, count, block))
    return da.map_blocks(block_of_distances, mesh=sent, chunks=(blocks,), dtype=float, meta=np.zeros(0))


def main(count=100_000, workers=2):
    mesh = Mesh(*sphere(40.0, 5))
    with Client(n_workers=workers, threads_per_worker=1, dashboard_address=None) as client:
        begin = time.perf_counter()
        found = distances(client, mesh, count, block=10_000)
        least, share = da.compute(found.min(), (found > 1.0).mean())
        took = time.perf_counter() - begin
        print(f"{count} shapes in {took:.1f} s, {1e6 * took / count:.1f} us each on {workers} workers; the least distance is "
              f"{least:.3f}, and {share:.1%} keep 1")
        first = found[:1000].compute()
    assert np.array_equal(first, mesh.distance(shapes(0, min(count, 10_000))[:1000], 0.4))
    return took


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
