"""Meshes and robots as surfaces of pyvista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ._answers import Ints
from ._errors import ContinuumError
from ._native import Mesh, link_surfaces
from ._optional import optional

if TYPE_CHECKING:
    from pyvista import PolyData

def to_pyvista(
    shape: Union[Mesh, ArrayLike],
    radii: Optional[ArrayLike] = None,
    *,
    pose: Any = None,
    caps: Literal["fitted", "capsules", "cylinders"] = "fitted",
) -> PolyData:
    """Returns a mesh or a robot as a surface of pyvista, to look at or to save.

    ``to_pyvista(mesh)`` is the mesh. ``to_pyvista(points, radii)`` is a robot: its links with their
    flat and round ends, as the queries see them, each with 24 sides. Links of radius 0 are left out.
    Needs pyvista: ``pip install 'parry-continuum[pyvista]'``.

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
        vertices, faces, numbers = link_surfaces(shape, radii, pose=pose, caps=caps)
        name = "segment"
    surface: PolyData = pyvista.PolyData(vertices, np.insert(faces, 0, 3, axis=1).ravel())
    surface.cell_data[name] = numbers
    return surface
