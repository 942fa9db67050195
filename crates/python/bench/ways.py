"""How users of each library ask how far a robot is from a mesh. Each way makes a function of one robot's points."""

import numpy as np
from shapes import RADIUS


def samples(points, each=10):
    """So many points on each segment."""
    share = np.arange(each)[:, None] / each
    between = points[:-1, None] + share * (points[1:] - points[:-1])[:, None]
    return np.concatenate([between.reshape(-1, 3), points[-1:]])


def turned(along):
    """A rotation that takes z to a direction."""
    z = along / np.linalg.norm(along)
    x = np.cross([1.0, 0, 0] if abs(z[0]) < 0.9 else [0, 1.0, 0], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def trimesh_way(vertices, faces, of):
    import trimesh

    query = trimesh.proximity.ProximityQuery(trimesh.Trimesh(vertices, faces, process=False))
    return lambda points: max(0.0, query.on_surface(of(points))[1].min() - RADIUS)


def open3d_way(vertices, faces, of):
    import open3d

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(open3d.core.Tensor(vertices.astype("f4")), open3d.core.Tensor(faces.astype("u4")))
    return lambda points: max(0.0, scene.compute_distance(open3d.core.Tensor(of(points).astype("f4"))).numpy().min() - RADIUS)


def scipy_way(vertices, faces, of):
    from scipy.spatial import cKDTree

    tree = cKDTree(vertices)
    return lambda points: max(0.0, tree.query(of(points))[0].min() - RADIUS)


def fcl_way(vertices, faces, shape):
    import fcl

    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(vertices, faces)
    model.endModel()
    wall, shape = fcl.CollisionObject(model), getattr(fcl, shape)

    def ask(points):
        least = np.inf
        for start, end in zip(points[:-1], points[1:]):
            place = fcl.Transform(turned(end - start), (start + end) / 2)
            link = fcl.CollisionObject(shape(RADIUS, np.linalg.norm(end - start)), place)
            least = min(least, fcl.distance(link, wall, fcl.DistanceRequest(), fcl.DistanceResult()))
        return max(0.0, least)

    return ask


def coal_way(vertices, faces, shape):
    import coal

    model = coal.BVHModelOBBRSS()
    model.beginModel(len(faces), len(vertices))
    model.addVertices(vertices)
    model.addTriangles(faces.astype("u4"))
    model.endModel()
    nowhere, shape = coal.Transform3s(), getattr(coal, shape)

    def ask(points):
        least = np.inf
        for start, end in zip(points[:-1], points[1:]):
            place = coal.Transform3s(turned(end - start), (start + end) / 2)
            link = shape(RADIUS, np.linalg.norm(end - start))
            found = coal.distance(link, place, model, nowhere, coal.DistanceRequest(), coal.DistanceResult())
            least = min(least, found)
        return max(0.0, least)

    return ask


# The name, what it needs, how it is made, whether flat ends are asked for, and how many robots are enough.
WAYS = [
    ("trimesh, closest points of 31 nodes", "trimesh", lambda v, f: trimesh_way(v, f, lambda p: p), "fitted", 20),
    ("trimesh, closest points of 301 samples", "trimesh", lambda v, f: trimesh_way(v, f, samples), "fitted", 10),
    ("scipy's tree of vertices, 301 samples", "scipy", lambda v, f: scipy_way(v, f, samples), "fitted", 200),
    ("Open3D, distances of 31 nodes", "open3d", lambda v, f: open3d_way(v, f, lambda p: p), "fitted", 200),
    ("Open3D, distances of 301 samples", "open3d", lambda v, f: open3d_way(v, f, samples), "fitted", 200),
    ("python-fcl, 30 cylinders", "fcl", lambda v, f: fcl_way(v, f, "Cylinder"), "cylinders", 40),
    ("python-fcl, 30 capsules", "fcl", lambda v, f: fcl_way(v, f, "Capsule"), "capsules", 40),
    ("coal, 30 cylinders", "coal", lambda v, f: coal_way(v, f, "Cylinder"), "cylinders", 40),
    ("coal, 30 capsules", "coal", lambda v, f: coal_way(v, f, "Capsule"), "capsules", 40),
]
