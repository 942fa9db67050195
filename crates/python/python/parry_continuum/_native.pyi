from collections.abc import Sequence
from os import PathLike
from typing import IO, Any, Literal, Protocol, final, overload

from numpy.typing import ArrayLike
from typing_extensions import Self, disjoint_base

from ._answers import (
    BoolOrBools,
    Centreline,
    Certificate,
    Clearance,
    Contacts,
    DecisionOrDecisions,
    FloatOrFloats,
    Floats,
    Gradient,
    InsideAnswer,
    Ints,
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
    SideOrSides,
    Sides,
    Surface,
    Tightest,
)

__all__ = [
    "BendingMotion",
    "LinearMotion",
    "Mesh",
    "Motion",
    "MotionPath",
    "MovingBase",
    "RigidMotion",
    "RobotPair",
    "Scene",
    "SelfQuery",
    "__version__",
    "gpu_available",
    "link_surfaces",
    "load",
    "load_centreline",
    "simplify",
    "verify_motion",
]

__version__: str

_Caps = Literal["fitted", "capsules", "cylinders"]
_MotionCaps = Literal["fitted", "capsules"]
_Frame = Literal["RAS", "LPS"]
_Device = Literal["cpu", "gpu"]

class _AsMatrix(Protocol):
    def as_matrix(self) -> Any: ...

# An array, or scipy's `RigidTransform` or `Rotation`, or a list of them.
_Poses = ArrayLike | _AsMatrix | Sequence[_AsMatrix]

@disjoint_base
class Motion:
    @property
    def count(self) -> int | None: ...
    @property
    def frame(self) -> _Frame | None: ...
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, _memo: Any, /) -> Self: ...
    def __reduce__(self) -> tuple[Any, Any]: ...

@final
class LinearMotion(Motion):
    def __new__(
        cls, start: ArrayLike, end: ArrayLike, radii: ArrayLike, *, caps: _MotionCaps = "fitted"
    ) -> LinearMotion: ...

@final
class RigidMotion(Motion):
    def __new__(
        cls,
        points: ArrayLike,
        radii: ArrayLike,
        start_pose: _Poses,
        end_pose: _Poses,
        *,
        caps: _Caps = "fitted",
    ) -> RigidMotion: ...
    @staticmethod
    def of_curve(
        points: ArrayLike,
        radii: ArrayLike,
        start_pose: _Poses,
        end_pose: _Poses,
        *,
        tangents: ArrayLike | None = None,
        deviation: float = 0.0,
        turn: float | None = None,
    ) -> RigidMotion: ...

@final
class BendingMotion(Motion):
    def __new__(
        cls, start: ArrayLike, end: ArrayLike, radii: ArrayLike, *, pose: _Poses | None = None
    ) -> BendingMotion: ...

@final
class MovingBase(Motion):
    def __new__(cls, motion: Motion, start_pose: _Poses, end_pose: _Poses) -> MovingBase: ...

@final
class MotionPath(Motion):
    def __new__(cls, motions: Sequence[Motion]) -> MotionPath: ...

@final
class Mesh:
    # Beside an array, a mesh of another package.
    def __new__(
        cls,
        vertices: Any,
        faces: ArrayLike | None = None,
        *,
        frame: _Frame | None = None,
        unit: str | None = None,
        device: _Device = "cpu",
    ) -> Mesh: ...
    @property
    def frame(self) -> _Frame | None: ...
    @property
    def unit(self) -> str | None: ...
    @property
    def device(self) -> _Device: ...
    @property
    def gpu_seconds(self) -> float | None: ...
    @property
    def skipped_faces(self) -> int: ...
    @property
    def vertices(self) -> Floats: ...
    @property
    def faces(self) -> Ints: ...
    def set_vertices(self, vertices: ArrayLike) -> None: ...
    def prepare(self) -> None: ...
    def distance(
        self, points: ArrayLike, radii: ArrayLike, *, pose: _Poses | None = None, caps: _Caps = "fitted"
    ) -> FloatOrFloats: ...
    def minimum(
        self, points: ArrayLike, radii: ArrayLike, *, pose: _Poses | None = None, caps: _Caps = "fitted"
    ) -> Minimum: ...
    def per_link(
        self, points: ArrayLike, radii: ArrayLike, *, pose: _Poses | None = None, caps: _Caps = "fitted"
    ) -> PerLink: ...
    def clears(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        pose: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> BoolOrBools: ...
    def clears_sections(
        self,
        sections: ArrayLike,
        radii: ArrayLike,
        *,
        segments: int,
        margin: float,
        pose: _Poses | None = None,
    ) -> BoolOrBools: ...
    def clears_inside(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        pose: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> InsideAnswer: ...
    def contacts_within(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        prominence: float = 0.0,
        pose: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> Contacts: ...
    def side(self, points: ArrayLike) -> SideOrSides: ...
    def link_sides(
        self, points: ArrayLike, radii: ArrayLike, *, pose: _Poses | None = None, caps: _Caps = "fitted"
    ) -> Sides: ...
    def surface(self) -> Surface: ...
    def doubts(
        self, points: ArrayLike, radii: ArrayLike, *, pose: _Poses | None = None, margin: float | None = None
    ) -> list[str]: ...
    def clearance(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        tolerance: float,
        tangents: ArrayLike | None = None,
        deviation: float = 0.0,
        turn: float | None = None,
        pose: _Poses | None = None,
    ) -> Clearance: ...
    def clears_tube(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        resolution: float,
        tangents: ArrayLike | None = None,
        deviation: float = 0.0,
        turn: float | None = None,
        pose: _Poses | None = None,
    ) -> DecisionOrDecisions: ...
    @overload
    def clears_motion(
        self,
        start: ArrayLike,
        end: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        resolution: float,
        caps: _MotionCaps = "fitted",
    ) -> MotionAnswer: ...
    @overload
    def clears_motion(self, start: Motion, *, margin: float, resolution: float) -> MotionAnswer: ...
    @overload
    def time_of_contact(
        self,
        start: ArrayLike,
        end: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        resolution: float,
        caps: _MotionCaps = "fitted",
    ) -> MotionAnswer: ...
    @overload
    def time_of_contact(self, start: Motion, *, margin: float, resolution: float) -> MotionAnswer: ...
    @overload
    def clearance_of_motion(
        self,
        start: ArrayLike,
        end: ArrayLike,
        radii: ArrayLike,
        *,
        tolerance: float,
        caps: _MotionCaps = "fitted",
    ) -> MotionClearance: ...
    @overload
    def clearance_of_motion(self, start: Motion, *, tolerance: float) -> MotionClearance: ...
    @overload
    def clears_motion_while(
        self,
        to: ArrayLike,
        start: ArrayLike,
        end: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        resolution: float,
        caps: _MotionCaps = "fitted",
    ) -> MotionAnswer: ...
    @overload
    def clears_motion_while(self, to: ArrayLike, start: Motion, *, margin: float, resolution: float) -> MotionAnswer: ...
    def clears_path(
        self, shapes: ArrayLike, radii: ArrayLike, deviation: float, *, margin: float, resolution: float
    ) -> MotionAnswer: ...
    def prove(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        pose: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> str | None: ...
    def prove_tube(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        resolution: float,
        tangents: ArrayLike | None = None,
        deviation: float = 0.0,
        turn: float | None = None,
        pose: _Poses | None = None,
    ) -> str | None: ...
    @overload
    def prove_motion(
        self,
        start: ArrayLike,
        end: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        resolution: float,
        caps: _MotionCaps = "fitted",
    ) -> str | None: ...
    @overload
    def prove_motion(self, start: Motion, *, margin: float, resolution: float) -> str | None: ...
    def certify(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        answer: PerLink,
        *,
        pose: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> Certificate: ...
    def distance_and_gradient(
        self, points: ArrayLike, radii: ArrayLike, *, pose: _Poses | None = None, caps: _Caps = "fitted"
    ) -> Gradient: ...
    def __copy__(self) -> Mesh: ...
    def __deepcopy__(self, _memo: Any, /) -> Mesh: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

# (points, radii) or (points, radii, pose)
_Robot = tuple[ArrayLike, ArrayLike] | tuple[ArrayLike, ArrayLike, _Poses | None]

@final
class Scene:
    def __new__(
        cls,
        *,
        robot_margin: float | None = None,
        self_margin: float | None = None,
        self_arc: float | None = None,
        nested: Sequence[tuple[int, int]] = (),
    ) -> Scene: ...
    def add(
        self, name: str, mesh: Mesh, *, margin: float | None, pose: _Poses | None = None, solid: bool = False
    ) -> int: ...
    def set_margin_between(self, structure: int, robot: int, *, margin: float | None) -> None: ...
    def __len__(self) -> int: ...
    def __copy__(self) -> Scene: ...
    def __deepcopy__(self, memo: Any, /) -> Scene: ...
    def __reduce__(self) -> tuple[Any, Any]: ...
    def clears(self, robots: Sequence[_Robot], *, caps: _Caps = "fitted") -> BoolOrBools: ...
    def tightest(self, robots: Sequence[_Robot], *, caps: _Caps = "fitted") -> Tightest: ...
    def per_structure(self, robots: Sequence[_Robot], *, caps: _Caps = "fitted") -> PerStructure: ...
    def contacts_within(
        self, robots: Sequence[_Robot], *, reach: float, prominence: float = 0.0, caps: _Caps = "fitted"
    ) -> SceneContacts: ...
    def clears_tube(self, robots: Sequence[_Robot], *, resolution: float) -> DecisionOrDecisions: ...
    def clearance(self, robots: Sequence[_Robot], *, tolerance: float) -> SceneClearance: ...
    def clears_motion(self, motions: Sequence[Motion], *, resolution: float) -> SceneMotionAnswer: ...
    def time_of_contact(self, motions: Sequence[Motion], *, resolution: float) -> SceneMotionAnswer: ...
    def clears_motion_while(
        self, ends: dict[int, ArrayLike], motions: Sequence[Motion], *, resolution: float
    ) -> SceneMotionAnswer: ...
    def clearance_of_motion(self, motions: Sequence[Motion], *, tolerance: float) -> SceneMotionClearance: ...

@final
class RobotPair:
    def __new__(cls) -> RobotPair: ...
    def forget(self) -> None: ...
    def __copy__(self) -> RobotPair: ...
    def __deepcopy__(self, _memo: Any, /) -> RobotPair: ...
    def __reduce__(self) -> tuple[Any, Any]: ...
    def minimum(
        self,
        points_a: ArrayLike,
        radii_a: ArrayLike,
        points_b: ArrayLike,
        radii_b: ArrayLike,
        *,
        pose_a: _Poses | None = None,
        pose_b: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> RobotProximity: ...
    def per_link(
        self,
        points_a: ArrayLike,
        radii_a: ArrayLike,
        points_b: ArrayLike,
        radii_b: ArrayLike,
        *,
        pose_a: _Poses | None = None,
        pose_b: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> RobotProximity: ...
    def contacts_within(
        self,
        points_a: ArrayLike,
        radii_a: ArrayLike,
        points_b: ArrayLike,
        radii_b: ArrayLike,
        *,
        margin: float,
        pose_a: _Poses | None = None,
        pose_b: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> RobotContacts: ...
    def clears(
        self,
        points_a: ArrayLike,
        radii_a: ArrayLike,
        points_b: ArrayLike,
        radii_b: ArrayLike,
        *,
        margin: float,
        pose_a: _Poses | None = None,
        pose_b: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> BoolOrBools: ...
    def clearance(
        self,
        points_a: ArrayLike,
        radii_a: ArrayLike,
        points_b: ArrayLike,
        radii_b: ArrayLike,
        *,
        tolerance: float,
        tangents_a: ArrayLike | None = None,
        tangents_b: ArrayLike | None = None,
        deviation_a: float = 0.0,
        deviation_b: float = 0.0,
        turn_a: float | None = None,
        turn_b: float | None = None,
        pose_a: _Poses | None = None,
        pose_b: _Poses | None = None,
    ) -> RobotClearance: ...
    def clears_tubes(
        self,
        points_a: ArrayLike,
        radii_a: ArrayLike,
        points_b: ArrayLike,
        radii_b: ArrayLike,
        *,
        margin: float,
        resolution: float,
        tangents_a: ArrayLike | None = None,
        tangents_b: ArrayLike | None = None,
        deviation_a: float = 0.0,
        deviation_b: float = 0.0,
        turn_a: float | None = None,
        turn_b: float | None = None,
        pose_a: _Poses | None = None,
        pose_b: _Poses | None = None,
    ) -> DecisionOrDecisions: ...
    def certify(
        self,
        points_a: ArrayLike,
        radii_a: ArrayLike,
        points_b: ArrayLike,
        radii_b: ArrayLike,
        answer: RobotProximity,
        *,
        pose_a: _Poses | None = None,
        pose_b: _Poses | None = None,
        caps: _Caps = "fitted",
    ) -> Certificate: ...
    def clears_motions(self, a: Motion, b: Motion, *, margin: float, resolution: float) -> RobotMotionAnswer: ...
    def time_of_contact(self, a: Motion, b: Motion, *, margin: float, resolution: float) -> RobotMotionAnswer: ...
    def clearance_of_motion(self, a: Motion, b: Motion, *, tolerance: float) -> RobotMotionClearance: ...

@final
class SelfQuery:
    def __new__(cls) -> SelfQuery: ...
    def forget(self) -> None: ...
    def __copy__(self) -> SelfQuery: ...
    def __deepcopy__(self, _memo: Any, /) -> SelfQuery: ...
    def __reduce__(self) -> tuple[Any, Any]: ...
    def minimum(self, points: ArrayLike, radii: ArrayLike, *, caps: _Caps = "fitted") -> RobotProximity: ...
    def clears(
        self, points: ArrayLike, radii: ArrayLike, *, margin: float, caps: _Caps = "fitted"
    ) -> BoolOrBools: ...
    def clears_tube(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        margin: float,
        resolution: float,
        tangents: ArrayLike | None = None,
        deviation: float = 0.0,
        turn: float | None = None,
    ) -> DecisionOrDecisions: ...
    def minimum_beyond(
        self, points: ArrayLike, radii: ArrayLike, *, arc: float, caps: _Caps = "fitted"
    ) -> RobotClearance: ...
    def clears_beyond(
        self, points: ArrayLike, radii: ArrayLike, *, arc: float, margin: float, caps: _Caps = "fitted"
    ) -> BoolOrBools: ...
    def clearance_beyond(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        arc: float,
        tolerance: float,
        tangents: ArrayLike | None = None,
        deviation: float = 0.0,
        turn: float | None = None,
    ) -> RobotClearance: ...
    def clears_tube_beyond(
        self,
        points: ArrayLike,
        radii: ArrayLike,
        *,
        arc: float,
        margin: float,
        resolution: float,
        tangents: ArrayLike | None = None,
        deviation: float = 0.0,
        turn: float | None = None,
    ) -> DecisionOrDecisions: ...
    def clears_motion(self, motion: Motion, *, margin: float, resolution: float) -> RobotMotionAnswer: ...

def gpu_available() -> bool: ...
def load(
    path: Any,
    *,
    label: int | None = None,
    frame: _Frame | None = None,
    scale: float = 1.0,
    allow_no_position: bool = False,
    device: _Device = "cpu",
) -> Mesh: ...
def load_centreline(
    path: str | bytes | PathLike[str] | PathLike[bytes] | IO[bytes] | IO[str], *, line: int | None = None, frame: _Frame | None = None, scale: float = 1.0
) -> Centreline: ...
def link_surfaces(
    points: ArrayLike, radii: ArrayLike, *, pose: _Poses | None = None, caps: _Caps = "fitted"
) -> tuple[Floats, Ints, Ints]: ...
def simplify(points: ArrayLike, radii: ArrayLike, *, tolerance: float) -> tuple[Floats, Floats]: ...
def verify_motion(motion: Motion, steps: int) -> None: ...
