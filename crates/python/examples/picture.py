"""The clearance along the robot over time, as a picture: `pip install matplotlib`."""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from parry_continuum import Mesh


def picture(mesh, shapes, radius, times):
    """`shapes` are (T, N, 3). Returns the figure and the distances, (T, N - 1)."""
    distance = mesh.per_link(shapes, radius).distance
    length = np.linalg.norm(np.diff(shapes[0], axis=0), axis=1)
    edges = np.concatenate([[0], np.cumsum(length)])
    figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
    image = axes.pcolormesh(np.append(times, 2 * times[-1] - times[-2]), edges, distance.T, cmap="viridis")
    closest = (0.5 * (edges[:-1] + edges[1:]))[distance.argmin(axis=1)]
    # White with a black edge: visible on every colour.
    style = {"markersize": 5, "markerfacecolor": "white", "markeredgecolor": "black", "markevery": 5, "clip_on": False}
    axes.plot(times, closest, "o", label="closest link", **style)
    axes.set(title="Clearance along the robot over time", xlabel="time", ylabel="arc length from the base")
    axes.legend(loc="lower right")
    figure.colorbar(image, label="distance from the wall (dark: near)")
    return figure, distance


def main(file="clearance.png"):
    floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
    times, share = np.linspace(0, 1, 200), np.linspace(0, 1, 40)
    bend = (1.5 * np.sin(2 * np.pi * times))[:, None] * share
    direction = np.stack([np.cos(bend), 0 * bend, np.sin(bend)], axis=-1)
    shapes = np.cumsum(direction, axis=1) + [0, 0, 25]
    figure, distance = picture(floor, shapes, 0.5, times)
    figure.savefig(file)
    print("the least distance is", round(float(distance.min()), 3))
    return distance


if __name__ == "__main__":
    main(*sys.argv[1:])
