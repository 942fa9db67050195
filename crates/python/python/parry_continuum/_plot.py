"""The clearance along a robot as a plot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Optional

import numpy as np
from numpy.typing import ArrayLike

from ._errors import ContinuumError
from ._native import Mesh
from ._optional import optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_clearance(
    mesh: Mesh,
    points: ArrayLike,
    radii: ArrayLike,
    *,
    margin: Optional[float] = None,
    pose: Any = None,
    caps: Literal["fitted", "capsules", "cylinders"] = "fitted",
    axes: Optional[Axes] = None,
) -> Axes:
    """Plots the distance of each segment to the mesh against the arc length from the base.

    The title names the closest segment, and a dot marks it. Needs matplotlib:
    ``pip install 'parry-continuum[plot]'``.

    Parameters
    ----------
    mesh : Mesh
        Its ``unit``, if known, labels the axes.
    points, radii, pose, caps
        As for `Mesh.per_link`, of one robot.
    margin : float, optional
        A length, at least 0. A line shows it, and the segments that do not keep it are red.
    axes : matplotlib.axes.Axes, optional
        Where to plot. Without it, the function makes a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        ``axes.figure`` is the figure.

    Raises
    ------
    ContinuumError
        More than one robot is given, the margin is negative or NaN, or as for `Mesh.per_link`.
    ImportError
        matplotlib is not installed.

    Examples
    --------
    >>> from parry_continuum import Mesh, plot_clearance
    >>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]], unit="mm")
    >>> axes = plot_clearance(floor, [[0, 0, 2], [1, 0, 2], [2, 0, 4]], 0.5, margin=1.0)
    >>> axes.get_title()
    'minimum 1.500 mm: segment 0, 0.0 mm from the base'
    """
    pyplot = optional("matplotlib.pyplot", function="plot_clearance", extra="plot")
    links = mesh.per_link(points, radii, pose=pose, caps=caps)
    if links.distance.ndim != 1:
        count = len(links.distance)
        text = f"a plot is about one robot, and {count} are given; plot them one by one"
        raise ContinuumError(text, kind="bad_shape")
    if margin is not None:
        mesh.clears(points, radii, margin=margin, pose=pose, caps=caps)  # checks the margin
    if axes is None:
        axes = pyplot.subplots(figsize=(7, 3), layout="constrained")[1]

    lengths = np.linalg.norm(np.diff(np.asarray(points, float), axis=0), axis=1)
    edges = np.concatenate([[0.0], np.cumsum(lengths)])
    has_length = ~np.isnan(links.distance)
    starts, ends = edges[:-1][has_length], edges[1:][has_length]
    distance = links.distance[has_length]
    closest = int(np.nanargmin(links.distance))

    unit = f" {mesh.unit}" if mesh.unit else ""
    in_unit = f" ({mesh.unit})" if mesh.unit else ""
    axes.stairs(distance, np.append(starts, ends[-1]), baseline=None, color="0.2")
    if margin is not None:
        axes.axhline(margin, color="tab:red", linestyle="--", label=f"margin {margin:g}{unit}")
        near = distance <= margin
        if near.any():
            lines = distance[near], starts[near], ends[near]
            axes.hlines(*lines, color="tab:red", linewidth=3, label="not kept")
        axes.legend()
    least, at = links.distance[closest], links.arc_length[closest]
    axes.plot([at], [least], "o", color="0.2")
    axes.set_title(
        f"minimum {least:.3f}{unit}: segment {closest}, {at:.1f}{unit} from the base",
        fontsize="medium",
    )
    axes.set_xlabel(f"arc length from the base{in_unit}")
    axes.set_ylabel(f"distance to the mesh{in_unit}")
    axes.set_ylim(bottom=0)
    return axes
