"""Which steps of a simulation leak through the wall, where, and how deep.

    python audit.py wall.stl shapes.npz --radius 0.5

`shapes.npz` holds ``points``, an array of the shape (steps, N, 3): the centreline at each logged step of MuJoCo, SOFA or
another simulator, in the frame and unit of the mesh. Of MuJoCo log ``data.xpos[bodies]``, of SOFA the node's ``position``.
Between two steps each point is taken to move straight, so a tip that jumps through a thin wall is found as well.
"""

import argparse

import numpy as np

from parry_continuum import Decision, load


def audit(mesh, points, radius, resolution):
    """A row for each leak: the step, its kind, the segment, the place on the wall, and how deep it is."""
    rows = []
    contacts = mesh.contacts_within(points, radius, margin=0.0)
    for step in np.flatnonzero(np.diff(contacts.offsets)):
        of_step = slice(*contacts.offsets[step : step + 2])
        deepest = of_step.start + np.argmin(contacts.depth[of_step])
        rows.append((step, "in the wall", contacts.segment[deepest], contacts.on_mesh[deepest], -contacts.depth[deepest]))
    ways = mesh.clears_motion(points[:-1], points[1:], radius, margin=0.0, resolution=resolution)
    is_free = np.diff(contacts.offsets) == 0
    jumps = (ways.decision == Decision.CONTACT) & is_free[:-1] & is_free[1:]
    for step in np.flatnonzero(jumps):
        rows.append((step, f"through it, {ways.t[step]:.2f} on the way", ways.segment[step], ways.on_mesh[step], np.nan))
    return sorted(rows, key=lambda row: row[0])


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh")
    parser.add_argument("shapes")
    parser.add_argument("--radius", type=float, required=True)
    parser.add_argument("--resolution", type=float, default=1e-3)
    given = parser.parse_args(arguments)
    points = np.load(given.shapes)["points"]
    rows = audit(load(given.mesh), points, given.radius, given.resolution)
    print(f"{len(rows)} leaks in {len(points)} steps")
    for step, kind, segment, place, depth in rows:
        print(f"step {step}: segment {segment} {kind} at {np.round(place, 4)}, {depth:.4g} deep")
    return rows


if __name__ == "__main__":
    main()
