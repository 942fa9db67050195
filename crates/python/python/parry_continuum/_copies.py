"""How what is pickled is made again."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from ._errors import ContinuumError
from ._native import Mesh, Motion, Scene


def mesh(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int64],
    frame: Any,
    unit: Optional[str],
    device: Any = "cpu",
) -> Mesh:
    """A mesh with what is known of it; on the CPU where its GPU is not."""
    try:
        return Mesh(vertices, faces, frame=frame, unit=unit, device=device)
    except ContinuumError as error:
        if device == "cpu":
            raise
        made = Mesh(vertices, faces, frame=frame, unit=unit)
        warnings.warn(f"a mesh that was on the GPU is unpickled on the CPU, with the same answers: {error}", stacklevel=2)
        return made


def motion(cls: Any, maker: Optional[str], args: tuple[Any, ...], more: dict[str, Any]) -> Motion:
    """A motion, by its class or by a function of that."""
    make = cls if maker is None else getattr(cls, maker)
    made: Motion = make(*args, **more)
    return made


def scene(
    robot_margin: Optional[float],
    nested: Sequence[tuple[int, int]],
    structures: Sequence[tuple[Any, ...]],
    self_margin: Optional[float] = None,
    self_arc: Optional[float] = None,
) -> Scene:
    """A scene with its structures."""
    made = Scene(robot_margin=robot_margin, self_margin=self_margin, self_arc=self_arc, nested=nested)
    for name, mesh, margin, pose, solid, margins_between in structures:
        number = made.add(name, mesh, margin=margin, pose=pose, solid=solid)
        for robot, between in margins_between:
            made.set_margin_between(number, robot, margin=between)
    return made
