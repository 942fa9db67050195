"""Very many shapes over Ray: `pip install ray`. As `dask_blocks.py`, where the shapes come from."""

import sys
import time

import numpy as np
import ray
from dask_blocks import shapes, sphere

from parry_continuum import Mesh


@ray.remote(num_cpus=1)
def block_of_distances(mesh, start, end):
    return mesh.distance(shapes(start, end - start), 0.4)


def main(count=100_000, workers=2, block=10_000):
    mesh = Mesh(*sphere(40.0, 5))
    ray.init(num_cpus=workers, include_dashboard=False)
    begin = time.perf_counter()
    sent = ray.put(mesh)  # once
    asked = [block_of_distances.remote(sent, start, min(start + block, count)) for start in range(0, count, block)]
    found = np.concatenate(ray.get(asked))
    took = time.perf_counter() - begin
    print(f"{count} shapes in {took:.1f} s, {1e6 * took / count:.1f} us each on {workers} workers")
    ray.shutdown()
    assert np.array_equal(found[:1000], mesh.distance(shapes(0, min(count, block))[:1000], 0.4))
    return took


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
