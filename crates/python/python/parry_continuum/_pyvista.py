"""Meshes and robots as surfaces of pyvista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._answers import Floats, Ints
from ._errors import ContinuumError
from ._native import Mesh
from ._optional import optional

if TYPE_CHECKING:
    from pyvista import PolyData

# Radii that differ by less are equal, as in the library.
SAME = 2.0**-32
# The sides of a drawn link and the steps from the rim of a half ball to its pole. More look rounder
# and take longer to draw. The surface lies inside the link, within 2 % of the radius.
SIDES, RINGS = 24, 6


def _starts_round(points: Floats, radii: Floats) -> NDArray[np.bool_]:
    """Which links have a round start by Algorithm 1 of the paper: ``src/robot/algorithm_1.rs``."""
    is_round = np.zeros(len(radii), bool)
    limit, tube = points[0], -1.0
    for k, (point, radius) in enumerate(zip(points, radii)):
        is_up = tube < 0 or radius > tube * (1 + SAME)
        if abs(radius - tube) > SAME * tube:
            tube = radius
        if is_up:
            limit = point
        else:
            is_round[k] = np.linalg.norm(point - limit) >= radius
    return is_round


def _round_ends(points: Floats, radii: Floats, caps: str) -> NDArray[np.bool_]:
    """(N - 1, 2): which ends of the links are round."""
    if caps != "fitted":
        return np.full((len(radii), 2), caps == "capsules")
    ends = _starts_round(points[::-1], radii[::-1])[::-1]
    return np.stack([_starts_round(points, radii), ends], axis=1)


def _profile(is_round: bool) -> Floats:
    """(R, 2): from the pole of an end to its rim, how far beyond the end and from the axis."""
    if not is_round:
        return np.array([[0.0, 0.0], [0.0, 1.0]])
    angle = np.linspace(0, np.pi / 2, RINGS + 1)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _link(start: Floats, end: Floats, radius: float, is_round: Any) -> tuple[Floats, Ints]:
    """The surface of one link: vertices, and triangles that face outwards."""
    axis = (end - start) / np.linalg.norm(end - start)
    side = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    side /= np.linalg.norm(side)
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    across = np.outer(np.cos(angle), side) + np.outer(np.sin(angle), np.cross(axis, side))
    rows = [(start, -beyond, out) for beyond, out in _profile(bool(is_round[0]))]
    rows += [(end, beyond, out) for beyond, out in _profile(bool(is_round[1]))[::-1]]
    rings = [point + radius * (along * axis + out * across) for point, along, out in rows]
    vertices = np.concatenate([rings[0][:1], *rings[1:-1], rings[-1][:1]])

    around = np.arange(SIDES)
    beside = (around + 1) % SIDES
    first, last = 1 + SIDES * np.arange(len(rings) - 2)[[0, -1]]
    pole = np.zeros(SIDES, int)
    faces = [np.stack([pole, first + beside, first + around], axis=1)]
    for ring in range(first, last, SIDES):
        low, high = ring, ring + SIDES
        faces.append(np.stack([low + around, low + beside, high + beside], axis=1))
        faces.append(np.stack([low + around, high + beside, high + around], axis=1))
    faces.append(np.stack([pole + len(vertices) - 1, last + around, last + beside], axis=1))
    return vertices, np.concatenate(faces)


def _robot(
    points: ArrayLike, radii: ArrayLike, pose: Any, caps: Literal["fitted", "capsules", "cylinders"]
) -> tuple[Floats, Ints, Ints]:
    """The surface of a robot: vertices, triangles, and the segment of each triangle."""
    # A query checks the arguments. Segments without length have no distance, and no link.
    triangle = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    distance = triangle.per_link(points, radii, pose=pose, caps=caps).distance
    if distance.ndim != 1:
        text = f"a surface is of one robot, and {len(distance)} are given; give them one by one"
        raise ContinuumError(text, kind="bad_shape")
    places = np.asarray(points, float)
    if pose is not None:
        matrix = np.asarray(pose.as_matrix() if hasattr(pose, "as_matrix") else pose, float)
        turn, shift = matrix[:3, :3], matrix[:3, 3] if matrix.shape == (4, 4) else np.zeros(3)
        places = places @ turn.T + shift
    widths = np.broadcast_to(np.asarray(radii, float), len(distance))
    is_round = _round_ends(places, widths, caps)
    segments = np.flatnonzero(~np.isnan(distance))
    links = [_link(places[k], places[k + 1], widths[k], is_round[k]) for k in segments]
    counts = np.cumsum([0] + [len(vertices) for vertices, _ in links])
    faces = np.concatenate([faces + count for (_, faces), count in zip(links, counts)])
    of_link = [np.full(len(faces), k) for k, (_, faces) in zip(segments, links)]
    return np.concatenate([vertices for vertices, _ in links]), faces, np.concatenate(of_link)


def to_pyvista(
    shape: Union[Mesh, ArrayLike],
    radii: Optional[ArrayLike] = None,
    *,
    pose: Any = None,
    caps: Literal["fitted", "capsules", "cylinders"] = "fitted",
) -> PolyData:
    """Returns a mesh or a robot as a surface of pyvista, to look at or to save.

    ``to_pyvista(mesh)`` is the mesh. ``to_pyvista(points, radii)`` is a robot: its links with their
    flat and round ends, as the queries see them, each with 24 sides. Needs pyvista:
    ``pip install 'parry-continuum[pyvista]'``.

    Parameters
    ----------
    shape : Mesh, or (N, 3) array
        The mesh, or the points of the robot.
    radii, pose, caps
        Of a robot only, as for `Mesh.per_link`.

    Returns
    -------
    pyvista.PolyData
        Triangles, in the frame and unit of the mesh. The cell data ``"triangle"`` of a mesh and
        ``"segment"`` of a robot number the triangles and segments as the answers do.

    Raises
    ------
    ContinuumError
        More than one robot is given, ``radii``, ``pose`` or ``caps`` stands beside a mesh, or as
        for `Mesh.per_link`.
    ImportError
        pyvista is not installed.

    Examples
    --------
    Colours each segment by its distance:

    >>> import pyvista  # doctest: +SKIP
    >>> robot = to_pyvista(points, 0.8)  # doctest: +SKIP
    >>> distance = mesh.per_link(points, 0.8).distance  # doctest: +SKIP
    >>> robot.cell_data["distance"] = distance[robot.cell_data["segment"]]  # doctest: +SKIP
    >>> plotter = pyvista.Plotter()  # doctest: +SKIP
    >>> plotter.add_mesh(to_pyvista(mesh), opacity=0.3)  # doctest: +SKIP
    >>> plotter.add_mesh(robot, scalars="distance")  # doctest: +SKIP
    >>> plotter.show()  # doctest: +SKIP
    """
    pyvista = optional("pyvista", function="to_pyvista", extra="pyvista")
    if isinstance(shape, Mesh):
        if radii is not None or pose is not None or caps != "fitted":
            text = "`radii`, `pose` or `caps` is given beside a mesh, which has none; leave it out"
            raise ContinuumError(text, kind="bad_type")
        vertices, faces, name = shape.vertices, shape.faces, "triangle"
        numbers: Ints = np.arange(len(faces))
    elif radii is None:
        raise ContinuumError("`radii` is missing beside the points of a robot", kind="bad_type")
    else:
        vertices, faces, numbers = _robot(shape, radii, pose, caps)
        name = "segment"
    surface: PolyData = pyvista.PolyData(vertices, np.insert(faces, 0, 3, axis=1).ravel())
    surface.cell_data[name] = numbers
    return surface
