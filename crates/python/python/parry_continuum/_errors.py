"""What goes wrong."""

from __future__ import annotations

from typing import Optional


class ContinuumError(ValueError):
    """Something that was handed over cannot be answered. The text names what is at fault and what to change.

    Attributes
    ----------
    kind : str
        What is wrong in one word, for programs. The words are those of the Rust library's ``kind()``, and
        ``"bad_shape"``, ``"bad_type"``, ``"bad_caps"``, ``"bad_device"``, ``"bad_frame"``, ``"changed"``, ``"file"``,
        ``"gpu_in_child"``, ``"nested_too_deep"``, ``"no_gpu_support"`` and ``"no_threads"``. ``"defect"`` is an error of the library itself.
    robot : int or None
        Which robot of a batch it is about.
    index : int or None
        Which point, radius, vertex or face it is about.
    possible : float or None
        The finest tolerance or resolution that can be had, where a finer one was asked for.
    """

    kind: str
    robot: Optional[int]
    index: Optional[int]
    possible: Optional[float]

    def __init__(
        self,
        message: str,
        kind: str = "",
        robot: Optional[int] = None,
        index: Optional[int] = None,
        possible: Optional[float] = None,
    ) -> None:
        super().__init__(message)
        self.kind = kind
        self.robot = robot
        self.index = index
        self.possible = possible

    def __reduce__(self) -> tuple[type[ContinuumError], tuple[object, ...]]:
        return type(self), (*self.args, self.kind, self.robot, self.index, self.possible)
