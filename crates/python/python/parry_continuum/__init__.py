"""Exact proximity queries between continuum robots and triangle meshes.

A robot is a centreline, an (N, 3) array of points, with a radius for each segment between two of them. A `Mesh` is
asked how near robots are to it. Every function takes one robot or a batch of them, (B, N, 3), and then returns arrays.

>>> import numpy as np
>>> from parry_continuum import Mesh
>>> floor = Mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
>>> angle = np.linspace(0, 1, 31)
>>> robot = np.stack([3 * np.cos(angle) - 3, 0 * angle, 1 + 3 * np.sin(angle)], axis=1)
>>> round(floor.distance(robot, 0.2), 4)
0.9967
>>> floor.clears(robot, 0.2, margin=0.5)
True
>>> poses = np.tile(np.eye(4), (3, 1, 1))
>>> poses[:, 2, 3] = [0, 1, 2]
>>> floor.distance(np.stack([robot] * 3), 0.2, pose=poses).round(4)
array([0.9967, 1.9967, 2.9967])
"""

from ._answers import (
    Centreline,
    Certificate,
    Clearance,
    Contacts,
    Decision,
    Decisions,
    Gradient,
    InsideAnswer,
    Minimum,
    MotionAnswer,
    MotionClearance,
    PerLink,
    PerStructure,
    RobotClearance,
    RobotContacts,
    RobotMotionAnswer,
    RobotMotionClearance,
    RobotProximity,
    SceneClearance,
    SceneContacts,
    SceneMotionAnswer,
    SceneMotionClearance,
    Side,
    Sides,
    Surface,
    Tightest,
    UndecidedReason,
)
from ._errors import ContinuumError
from ._native import (
    BendingMotion,
    LinearMotion,
    Mesh,
    Motion,
    MotionPath,
    MovingBase,
    RigidMotion,
    RobotPair,
    Scene,
    SelfQuery,
    __version__,
    gpu_available,
    load,
    load_centreline,
    simplify,
    verify_motion,
)
from ._plot import plot_clearance
from ._proof_files import write_proof
from ._pyvista import to_pyvista

__all__ = [
    "BendingMotion",
    "Centreline",
    "Certificate",
    "Clearance",
    "Contacts",
    "ContinuumError",
    "Decision",
    "Decisions",
    "Gradient",
    "InsideAnswer",
    "LinearMotion",
    "Mesh",
    "Minimum",
    "Motion",
    "MotionAnswer",
    "MotionClearance",
    "MotionPath",
    "MovingBase",
    "PerLink",
    "PerStructure",
    "RigidMotion",
    "RobotClearance",
    "RobotContacts",
    "RobotMotionAnswer",
    "RobotMotionClearance",
    "RobotPair",
    "RobotProximity",
    "Scene",
    "SceneClearance",
    "SceneContacts",
    "SceneMotionAnswer",
    "SceneMotionClearance",
    "SelfQuery",
    "Side",
    "Sides",
    "Surface",
    "Tightest",
    "UndecidedReason",
    "__version__",
    "gpu_available",
    "load",
    "load_centreline",
    "plot_clearance",
    "simplify",
    "to_pyvista",
    "verify_motion",
    "write_proof",
]
