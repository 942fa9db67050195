"""Vertices and faces of meshes of other packages, by what their classes have, so that none of them is imported."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Optional

import numpy as np

from ._errors import ContinuumError

Parts = tuple[Any, Any]


def _attribute(given: Any, name: str) -> Any:
    """The attribute, or None if there is none. What its own code raises is raised."""
    try:
        return getattr(given, name)
    except AttributeError:
        if hasattr(type(given), name):
            raise
        return None


def _has(given: Any, *names: str) -> bool:
    return all(_attribute(given, name) is not None for name in names)


def _refuse(text: str) -> ContinuumError:
    return ContinuumError(text, kind="bad_type")


def _open3d(given: Any) -> Optional[Parts]:
    if _has(given, "vertices", "triangles"):
        return np.asarray(given.vertices), np.asarray(given.triangles)
    if _has(given, "vertex", "triangle") and _has(given.vertex, "positions") and _has(given.triangle, "indices"):
        return given.vertex.positions.cpu().numpy(), given.triangle.indices.cpu().numpy()
    return None


def _trimesh(given: Any) -> Optional[Parts]:
    if _has(given, "vertices", "faces"):
        return given.vertices, given.faces
    if _has(given, "geometry", "graph"):  # a scene, whose parts have places of their own
        whole = given.to_mesh() if _has(given, "to_mesh") else given.dump(concatenate=True)
        if not _has(whole, "vertices", "faces"):
            raise _refuse("the scene holds no mesh; give a scene with triangles")
        return whole.vertices, whole.faces
    return None


def _meshio(given: Any) -> Optional[Parts]:
    if not _has(given, "points", "cells", "cells_dict"):
        return None
    others = sorted(set(given.cells_dict) - {"triangle", "vertex", "line"})
    if others:
        raise _refuse(f"the mesh has cells of the type {others[0]}; give its surface, cut into triangles")
    points = np.asarray(given.points)
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    return points, given.cells_dict.get("triangle", np.zeros((0, 3), int))


def _pyvista(given: Any) -> Optional[Parts]:
    if not _has(given, "points", "n_cells"):
        return None
    surface = given if hasattr(type(given), "verts") else given.extract_surface()
    return surface.points, np.asarray(surface.triangulate().faces).reshape(-1, 4)[:, 1:]


KINDS: tuple[Callable[[Any], Optional[Parts]], ...] = (_pyvista, _meshio, _trimesh, _open3d)


def parts(given: Any) -> Optional[Parts]:
    """Vertices and faces, or None if it is no mesh."""
    return next((found for found in (kind(given) for kind in KINDS) if found is not None), None)
