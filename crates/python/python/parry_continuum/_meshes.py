"""Vertices and faces of meshes of other packages, by what their classes have, so that none of them is imported."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any, Optional

import numpy as np

from ._errors import ContinuumError
from ._native import load

Parts = tuple[Any, Any, Optional[str]]
"""Vertices, triangles, and the frame "RAS" or "LPS" if it is stated."""


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
        return np.asarray(given.vertices), np.asarray(given.triangles), None
    if _has(given, "vertex", "triangle") and _has(given.vertex, "positions") and _has(given.triangle, "indices"):
        return given.vertex.positions.cpu().numpy(), given.triangle.indices.cpu().numpy(), None
    return None


def _trimesh(given: Any) -> Optional[Parts]:
    if _has(given, "vertices", "faces"):
        return given.vertices, given.faces, None
    if _has(given, "geometry", "graph"):  # a scene, whose parts have places of their own
        whole = given.to_mesh() if _has(given, "to_mesh") else given.dump(concatenate=True)
        if not _has(whole, "vertices", "faces"):
            raise _refuse("the scene holds no mesh; give a scene with triangles")
        return whole.vertices, whole.faces, None
    return None


def _meshio(given: Any) -> Optional[Parts]:
    if not _has(given, "points", "cells", "cells_dict"):
        return None
    points = np.asarray(given.points)
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    faces = [np.zeros((0, 3), np.int64)]
    for block in given.cells:
        if block.type == "triangle":
            faces.append(np.asarray(block.data))
        elif block.type == "quad":
            faces.append(_halves(points, np.asarray(block.data)))
        elif block.type.startswith("polygon"):
            faces.append(_ears(points, block.data))
        elif block.type not in ("vertex", "line", "line3"):
            raise _refuse(f"the mesh has cells of the type {block.type}; give its surface, cut into triangles")
    return points, np.concatenate(faces), None


def _halves(points: Any, quads: Any) -> Any:
    """Both halves of each quadrilateral, along the diagonal that is inside: their normals do not oppose one another."""
    a, b, c, d = (points[quads[:, corner]] for corner in range(4))
    along = np.sum(np.cross(b - a, c - a) * np.cross(c - a, d - a), axis=1) >= 0
    first, second = np.where(along[:, None], quads[:, [0, 1, 2]], quads[:, [0, 1, 3]]), quads[:, [1, 2, 3]].copy()
    second[along, 0] = quads[along, 0]
    return np.stack([first, second], axis=1).reshape(-1, 3)


def _ears(points: Any, polygons: Any) -> Any:
    """The triangles of polygons, which need not be convex: those of an OBJ file with the same faces."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(points, float).tolist()]
    lines += ["f " + " ".join(str(corner + 1) for corner in np.asarray(polygon).tolist()) for polygon in polygons]
    file = io.BytesIO("\n".join(lines).encode())
    file.name = "polygons.obj"
    return load(file).faces


def _pyvista(given: Any) -> Optional[Parts]:
    if _has(given, "n_blocks", "combine"):
        raise _refuse("the mesh is a MultiBlock; give one of its blocks, `blocks[0]`, or the surface of all of them, "
                      "`blocks.combine().extract_surface()`")  # fmt: skip
    if not _has(given, "points", "n_cells"):
        return None
    surface = given if hasattr(type(given), "verts") else given.extract_surface()
    stated = np.asarray(given.field_data["SPACE"]).ravel() if "SPACE" in given.field_data else ()
    frame = next((str(name) for name in stated if name in ("RAS", "LPS")), None)
    return surface.points, np.concatenate([_padded(surface.points, surface.faces), _strips(surface.strips)]), frame


def _padded(points: Any, padded: Any) -> Any:
    """The triangles of faces in one line, each after the number of its corners. VTK's own triangulation loses faces."""
    padded = np.asarray(padded)
    for count in (3, 4):
        # If each row begins with its count, all faces have this many corners.
        if len(padded) % (count + 1) == 0 and (padded.reshape(-1, count + 1)[:, 0] == count).all():
            faces = padded.reshape(-1, count + 1)[:, 1:]
            return faces if count == 3 else _halves(points, faces)
    return _ears(points, _cells(padded))


def _cells(padded: Any) -> list[Any]:
    """Cells in one line, each after the number of its corners."""
    padded, cells, start = np.asarray(padded), [], 0
    while start < len(padded):
        end = start + 1 + int(padded[start])
        cells.append(padded[start + 1 : end])
        start = end
    return cells


def _strips(padded: Any) -> Any:
    """The triangles of strips: every second one is turned."""
    faces = [np.zeros((0, 3), np.int64)]
    for strip in _cells(padded):
        triangles = np.column_stack([strip[:-2], strip[1:-1], strip[2:]])
        triangles[1::2] = triangles[1::2, [1, 0, 2]]
        first, second, third = triangles.T
        faces.append(triangles[(first != second) & (second != third) & (third != first)])
    return np.concatenate(faces)


KINDS: tuple[Callable[[Any], Optional[Parts]], ...] = (_pyvista, _meshio, _trimesh, _open3d)


def parts(given: Any) -> Optional[Parts]:
    """Vertices, faces and frame, or None if it is no mesh."""
    return next((found for found in (kind(given) for kind in KINDS) if found is not None), None)
