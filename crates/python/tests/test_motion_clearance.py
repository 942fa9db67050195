"""How near a motion comes, beside its shapes at many times."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_array_equal

from parry_continuum import Mesh
from shapes import robots, sphere


def test_bounds_hold_at_all_times() -> None:
    mesh, random = Mesh(*sphere()), np.random.default_rng(71)
    start = robots(random, 25, points=6)
    end = start + random.normal(scale=2, size=(25, 1, 3))
    found = mesh.clearance_of_motion(start, end, 0.1, tolerance=0.01, caps="capsules")
    times = np.linspace(0, 1, 200)[:, None, None]
    touching = 0
    for k in range(25):
        sampled = mesh.distance((1 - times) * start[k] + times * end[k], 0.1, caps="capsules").min()
        # Between two times no point moves farther than this.
        step = np.linalg.norm(end[k] - start[k], axis=1).max() / 199
        touching += sampled == 0
        assert found.lower[k] <= sampled + 1e-12 and sampled - step <= found.upper[k] + 1e-12
        shape = (1 - found.t[k]) * start[k] + found.t[k] * end[k]
        assert mesh.distance(shape, 0.1, caps="capsules") <= found.upper[k] + 1e-9
        one = mesh.clearance_of_motion(start[k], end[k], 0.1, tolerance=0.01, caps="capsules")
        for field, fields in zip(one, found):
            assert_array_equal(field, fields[k])
    assert found.resolved.all() and touching < 20
