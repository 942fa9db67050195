"""The robot and its clearance over three slices of a CT or label map: `pip install matplotlib nibabel`.

`python slices.py slices.png` draws a catheter in an aorta; with `organs.nii.gz 1 catheter.csv` behind it, your own files.
The planes go through the closest point of the robot. The image is RAS, so wall and robot are too.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import nibabel
import numpy as np
from matplotlib.collections import LineCollection

from parry_continuum import load, load_centreline

PLANES = {"sagittal": (0, 1, 2), "coronal": (1, 0, 2), "axial": (2, 0, 1)}
NAMES = ["right (mm)", "anterior (mm)", "superior (mm)"]


def cut(vertices, faces, axis, height):
    """The segments, (K, 2, 3), in which a plane cuts triangles."""
    above = vertices[faces][:, :, axis] > height
    crossed = np.flatnonzero(above.any(axis=1) & ~above.all(axis=1))
    above = above[crossed]
    # The corner that is alone on its side, and the other two.
    alone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    lone, *others = (vertices[faces[crossed, (alone + k) % 3]] for k in range(3))
    shares = [(height - lone[:, axis]) / (other - lone)[:, axis] for other in others]
    ends = [lone + share[:, None] * (other - lone) for share, other in zip(shares, others)]
    return np.stack(ends, axis=1)


def sample(image, places):
    """The values of the nearest voxels, 0 outside of the image."""
    values, to_voxel = np.asarray(image.dataobj), np.linalg.inv(image.affine)
    voxels = np.rint(places @ to_voxel[:3, :3].T + to_voxel[:3, 3]).astype(int)
    inside = ((voxels >= 0) & (voxels < values.shape[:3])).all(axis=-1)
    return values[tuple(np.moveaxis(voxels * inside[..., None], -1, 0))] * inside


def in_robot(places, points, radii):
    """The nearest segment of the robot, NaN outside of the robot."""
    starts, ways = points[:-1], np.diff(points, axis=0)
    offsets = places[..., None, :] - starts
    shares = ((offsets * ways).sum(axis=-1) / (ways**2).sum(axis=-1)).clip(0, 1)
    beyond = np.linalg.norm(offsets - shares[..., None] * ways, axis=-1) - radii
    return np.where(beyond.min(axis=-1) <= 0, beyond.argmin(axis=-1), np.nan)


def slices(image, wall, points, radii, margin, around=25.0):
    """Returns a figure of three planes, each `around` millimetres to either side of the closest point."""
    closest = wall.minimum(points, radii)
    distance = wall.per_link(points, radii).distance
    figure, all_axes = plt.subplots(1, 3, figsize=(12, 4.6), layout="constrained")
    steps = np.linspace(-around, around, 200)
    for axes, (name, (normal, across, up)) in zip(all_axes, PLANES.items()):
        centre = closest.on_robot
        places = np.tile(centre, (200, 200, 1))
        places[..., across] += steps
        places[..., up] += steps[:, None]
        extent = [centre[k] + s for k in (across, up) for s in (-around, around)]
        shade = sample(image, places)
        axes.imshow(shade, origin="lower", extent=extent, cmap="gray", vmax=1.3 * shade.max())
        outline = cut(wall.vertices, wall.faces, normal, centre[normal])
        axes.add_collection(LineCollection(outline[..., [across, up]], color="tab:orange", label="wall"))
        segments = in_robot(places, points, radii)
        near = np.append(distance, np.nan)[np.nan_to_num(segments, nan=-1).astype(int)]
        colours = {"cmap": "viridis", "vmin": 0, "vmax": np.nanmax(distance)}
        shown = axes.imshow(near, origin="lower", extent=extent, **colours)
        pair = np.stack([closest.on_robot, closest.on_mesh])
        axes.plot(*pair[:, [across, up]].T, ".-", color="tab:red", label="closest points, projected")
        axes.set(title=name, xlabel=NAMES[across], ylabel=NAMES[up], xlim=extent[:2], ylim=extent[2:])
    verdict = "kept" if closest.distance > margin else "not kept"
    figure.suptitle(f"clearance {closest.distance:.2f} mm at segment {closest.segment}: margin {margin:g} mm {verdict}")
    figure.colorbar(shown, label="clearance of the robot's segment (mm; dark: near)")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def aorta():
    """The lumen of an arch, narrow in its descending part, as a label map, and a catheter."""
    corner, sizes = np.array([-50.0, -20.0, -90.0]), (100, 40, 140)
    x, y, z = np.indices(sizes) + corner[:, None, None, None]
    from_axis = np.where(z > 0, np.hypot(x, z), np.abs(x)) - 30
    bump = np.clip(1 - ((z + 40) / 20) ** 2, 0, 1) ** 2 * (x < 0)
    labels = (np.hypot(from_axis, y) < 11.3 - 5 * bump).astype(np.uint8)
    affine = np.eye(4)
    affine[:3, 3] = corner
    angle = np.linspace(0, np.pi, 40)
    arch = np.stack([-31 * np.cos(angle), 0 * angle, 31 * np.sin(angle)], axis=1)
    up = [[-31, 0, height] for height in range(-80, 0, 4)]
    return nibabel.Nifti1Image(labels, affine), np.array([*up, *arch]), 1.0


def main(picture="slices.png", scan=None, label=1, robot=None, margin=2.0):
    if scan is None:
        scan = "aorta.nii.gz"
        image, points, radii = aorta()
        image.header.set_xyzt_units("mm")
        nibabel.save(image, scan)
    else:
        centreline = load_centreline(robot, frame="RAS")
        image, points, radii = nibabel.load(scan), centreline.points, centreline.radii
    wall = load(scan, label=int(label), frame="RAS")
    slices(image, wall, points, radii, float(margin)).savefig(picture, dpi=100)
    return wall.minimum(points, radii).distance


if __name__ == "__main__":
    print("the least clearance is", round(float(main(*sys.argv[1:])), 2), "mm")
