"""The robot, the wall and the closest line of each link as a scene of trimesh: `pip install trimesh`."""

import sys

import numpy as np
import trimesh

from parry_continuum import Mesh


def scene(wall, points, radius):
    """A scene to show or to export, and the answer that it shows."""
    links = Mesh(wall).per_link(points, radius)
    lines = np.stack([links.on_robot, links.on_mesh], axis=1)
    lines = lines[np.linalg.norm(lines[:, 0] - lines[:, 1], axis=1) > 0]  # none where they touch
    tubes = [trimesh.creation.cylinder(radius, segment=ends) for ends in zip(points[:-1], points[1:])]
    shown = trimesh.Scene([wall, *tubes])
    shown.add_geometry(trimesh.load_path(lines), geom_name="closest")
    return shown, links


def main(file=None):
    wall = trimesh.creation.icosphere(subdivisions=4, radius=30.0)
    wall.invert()
    angle = np.linspace(0, 1.2, 25)
    points = np.stack([25 - 25 * np.cos(angle), 0 * angle, 25 * np.sin(angle) - 10], axis=1)
    shown, links = scene(wall, points, 1.0)
    print("the closest link is", int(links.distance.argmin()), "at", round(float(links.distance.min()), 3))
    if file:
        shown.export(file)  # .glb, or `shown.show()` for a window
    return shown, links


if __name__ == "__main__":
    main(*sys.argv[1:])
