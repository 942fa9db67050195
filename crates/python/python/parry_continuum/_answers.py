"""What comes back: tuples with names.

Of one robot a field is a number or a point; of a batch of B robots it is an array with B in front. All lengths and
points are in the unit and the frame of the mesh. Segments, triangles and robots are counted from 0, and -1 stands for
none.

No answer has a truth value: a tuple with fields would be true whatever they say. An answer about a margin has ``is_clear``.

A type checker cannot tell one robot from many by their shape, so what is a number of one robot and an array of many is
`Any` to it, as in numpy.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from enum import Enum, IntEnum
from typing import Any, NamedTuple, NoReturn, Optional

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Strs = NDArray[np.str_]

FloatOrFloats = Any
IntOrInts = Any
BoolOrBools = Any
StrOrStrs = Any
SideOrSides = Any
DecisionOrDecisions = Any
ReasonOrReasons = Any


class _Member(Enum):
    """A member of an enumeration of int8. It equals its value and is ordered by it, and ``int()`` is its value.

    It is no int itself: numpy then makes no numbers of a list of members, which would all be true but 0.
    """

    def __eq__(self, other: object) -> bool:
        if isinstance(other, type(self)):
            return self is other
        if isinstance(other, (int, np.number)):
            return bool(self.value == other)
        return NotImplemented

    def __lt__(self, other: Any) -> bool:
        if isinstance(other, (int, np.number, type(self))):
            return bool(self.value < int(other))
        return NotImplemented

    def __le__(self, other: Any) -> bool:
        if isinstance(other, (int, np.number, type(self))):
            return bool(self.value <= int(other))
        return NotImplemented

    def __gt__(self, other: Any) -> bool:
        return NotImplemented if (less := self.__le__(other)) is NotImplemented else not less

    def __ge__(self, other: Any) -> bool:
        return NotImplemented if (less := self.__lt__(other)) is NotImplemented else not less

    def __hash__(self) -> int:
        return hash(self.value)

    def __int__(self) -> int:
        return int(self.value)

    def __float__(self) -> float:
        return float(self.value)


class Side(_Member):
    """On which side of a mesh a point is. It has no truth value: use ``is_inside`` or ``is_outside``, or compare it, as
    in ``side is Side.INSIDE``."""

    INSIDE = -1
    UNDECIDED = 0
    OUTSIDE = 1

    @property
    def is_inside(self) -> bool:
        """Whether the point is proven to be inside."""
        return self is Side.INSIDE

    @property
    def is_outside(self) -> bool:
        """Whether the point is proven to be outside."""
        return self is Side.OUTSIDE

    def __bool__(self) -> NoReturn:
        raise _no_truth("a Side", _INSTEAD_OF_SIDES.format("side is Side.INSIDE"))


class Decision(_Member):
    """Whether a margin is kept. ``CLEAR`` and ``CONTACT`` are proven.

    It has no truth value: use ``is_clear``, or compare it, as in ``decision is Decision.CLEAR``.
    """

    CONTACT = -1
    UNDECIDED = 0
    CLEAR = 1

    @property
    def is_clear(self) -> bool:
        """Whether the margin is proven to be kept."""
        return self is Decision.CLEAR

    def __bool__(self) -> NoReturn:
        raise _no_truth("a Decision", "use `.is_clear`, or compare it, as in `decision is Decision.CLEAR`")


_INSTEAD_OF_SIDES = "use `.is_inside` or `.is_outside`, compare it, as in `{}`, or take `.is_clear` of an answer about a margin"


class UndecidedReason(IntEnum):
    """Why it stays open whether a motion keeps a margin."""

    NONE = 0
    """It is decided."""
    NEAR = 1
    """A shape comes within the resolution of the margin, or the end of a link becomes flat or round where that decides."""
    WORK = 2
    """The question has reached its limit of work: a coarser resolution helps, or a motion in several parts."""


def _no_truth(what: str, instead: str) -> TypeError:
    return TypeError(f"the truth value of {what} is ambiguous; {instead}")


def _name(member: object) -> str:
    return str(member.name) if isinstance(member, _Member) else repr(member)


class _Members(np.ndarray[Any, np.dtype[np.object_]]):
    """An array of the members of an enumeration. It has no truth value, and neither have its items.

    Its items are objects and no numbers: whatever takes them for true or false asks each of them, which raises. Nor can
    they be an index. What is computed from it is a plain array or number.
    """

    _of: type[_Member]
    _instead: str

    @classmethod
    def _from_values(cls, values: NDArray[np.int8]) -> _Members:
        """The members of these values."""
        members = np.empty(len(cls._of), object)
        for member in cls._of:
            members[member.value] = member  # -1 is the last place
        found: _Members = members[values].view(cls)
        return found

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        plain = np.asarray(array)
        return plain[()] if plain.ndim == 0 else plain

    def astype(self, dtype: Any, *more: Any, **named: Any) -> Any:
        """Their values as a plain array of numbers. ``bool`` is refused."""
        return np.asarray(self).astype(dtype, *more, **named)

    def __bool__(self) -> NoReturn:
        raise _no_truth(f"{type(self).__name__}", self._instead)

    def all(self, *_: Any, **__: Any) -> NoReturn:
        raise _no_truth(f"an item of {type(self).__name__}", self._instead)

    def any(self, *_: Any, **__: Any) -> NoReturn:
        raise _no_truth(f"an item of {type(self).__name__}", self._instead)

    def __repr__(self) -> str:
        names = np.array2string(np.asarray(self), threshold=20, separator=", ", formatter={"object": _name})
        shape = f", shape={self.shape}" if self.size == 0 or self.size > 20 else ""
        return f"{type(self).__name__}({names}{shape})"

    def __str__(self) -> str:
        return repr(self)


class Decisions(_Members):
    """An array whose items are ``Decision``. It has no truth value: use ``is_clear``, or compare it, as in
    ``decisions == Decision.CLEAR``. ``decisions.astype(int)`` is 1 for clear, -1 for contact and 0 for undecided."""

    _of = Decision
    _instead = "use `.is_clear`, or compare it, as in `decisions == Decision.CLEAR`"

    @property
    def is_clear(self) -> NDArray[np.bool_]:
        """Of each, whether the margin is proven to be kept."""
        return np.asarray(self == Decision.CLEAR, bool)


class Sides(_Members):
    """An array whose items are ``Side``. It has no truth value: use ``is_inside`` or ``is_outside``, or compare it, as in
    ``sides == Side.INSIDE``. ``sides.astype(int)`` is -1 for inside, 1 for outside and 0 for undecided."""

    _of = Side
    _instead = _INSTEAD_OF_SIDES.format("sides == Side.INSIDE")

    @property
    def is_inside(self) -> NDArray[np.bool_]:
        """Of each, whether the point is proven to be inside."""
        return np.asarray(self == Side.INSIDE, bool)

    @property
    def is_outside(self) -> NDArray[np.bool_]:
        """Of each, whether the point is proven to be outside."""
        return np.asarray(self == Side.OUTSIDE, bool)


def _short(answer: Any) -> str:
    """The fields of a tuple with names, of arrays with many numbers the shape alone."""
    most = 9

    def text(value: Any) -> str:
        if isinstance(value, _Members) and value.size > most:
            return f"<{type(value).__name__} {value.shape}>"
        if isinstance(value, np.ndarray) and value.size > most:
            return f"<{value.dtype} array {value.shape}>"
        return repr(value).replace("\n", "").replace("       ", " ")

    fields = ", ".join(f"{name}={text(value)}" for name, value in zip(answer._fields, answer))
    return f"{type(answer).__name__}({fields})"


def _columns(answer: Any, axes: tuple[str, str]) -> dict[str, NDArray[Any]]:
    """The first field of an answer has a number for each row."""
    rows = np.shape(answer[0])
    columns: dict[str, NDArray[Any]] = {}
    if len(rows) == len(axes):
        places = np.indices(rows).reshape(len(axes), -1)
        columns.update(zip(axes, places))
    for name, value in zip(answer._fields, answer):
        if name == "offsets":
            continue
        is_of_members = isinstance(value, (_Member, _Members))
        values = np.asarray(value, np.int8 if is_of_members else None)
        further = values.shape[len(rows) :]
        values = values.reshape(-1 if 0 not in rows else 0, *further)
        for place in np.ndindex(*further):
            ends = [str(number) for number in place]
            if further and further[-1] == 3:
                ends[-1] = "xyz"[place[-1]]
            columns["_".join([name, *ends])] = values[(slice(None),) + place]
    return columns


class _Answer:
    """What all answers are beside tuples with names."""

    __slots__ = ()
    _instead = "use `.is_clear`"
    _axes = ("robot", "segment")

    def __bool__(self) -> NoReturn:
        raise _no_truth(f"{type(self).__name__}", self._instead)

    def __repr__(self) -> str:
        return _short(self)

    def to_dict(self) -> dict[str, NDArray[Any]]:
        """Columns of equal length, as ``pandas.DataFrame`` takes them: a row for each robot, contact or segment.

        A point has a column for each coordinate, ``on_mesh_x``, and other numbers a column for each place, ``segments_0``.
        A `Decision` or a `Side` is its value, -1, 0 or 1.
        Segments of a batch are rows too, with columns that say of which robot and which segment. ``offsets`` is left out,
        since each contact names its robot. ``_asdict()`` has the fields as they are.
        """
        return _columns(self, self._axes)


class _MotionDecision(_Answer):
    """An answer with a ``decision`` about the margins that a motion keeps."""

    __slots__ = ()

    @property
    def is_clear(self: Any) -> BoolOrBools:
        """Whether the margins are proven to be kept: ``decision`` is ``CLEAR``."""
        return self.decision == Decision.CLEAR


class _MinimumFields(NamedTuple):
    distance: FloatOrFloats
    """The distance, 0 where they touch or overlap."""
    on_robot: Floats
    """The robot's closest point, (3,)."""
    on_mesh: Floats
    """The mesh's closest point, (3,)."""
    segment: IntOrInts
    """The segment of the input, from point ``segment`` to the next."""
    arc_length: FloatOrFloats
    """How far along the centreline from the base."""
    triangle: IntOrInts
    """The closest triangle."""


class Minimum(_Answer, _MinimumFields):
    """Where a robot is closest to a mesh."""

    __slots__ = ()
    _instead = "compare its `distance`"


class _PerLinkFields(NamedTuple):
    distance: Floats
    """(N - 1,): the distances, 0 where they touch or overlap."""
    on_robot: Floats
    """(N - 1, 3): the segments' closest points."""
    on_mesh: Floats
    """(N - 1, 3): the mesh's closest points."""
    arc_length: Floats
    """(N - 1,): how far along the centreline from the base."""
    triangle: Ints
    """(N - 1,): the closest triangles."""


class PerLink(_Answer, _PerLinkFields):
    """Where each segment of a robot is closest to a mesh. Segments without length have NaN, and the triangle -1."""

    __slots__ = ()
    _instead = "compare its `distance`"


class _ContactsFields(NamedTuple):
    segment: Ints
    """(K,): the segment of the input."""
    fraction: Floats
    """(K,): where along the segment, from 0 to 1."""
    arc_length: Floats
    """(K,): how far along the centreline from the base."""
    distance: Floats
    """(K,): the distance, 0 where they touch or overlap."""
    depth: Floats
    """(K,): the distance with a sign: negative where they overlap."""
    normal: Floats
    """(K, 3): the unit vector from the wall to the robot, or NaN."""
    on_robot: Floats
    """(K, 3): the robot's closest point."""
    on_mesh: Floats
    """(K, 3): the mesh's closest point."""
    triangle: Ints
    """(K,): the triangle."""
    robot: Ints
    """(K,): the robot of the batch, 0 where there is one."""
    offsets: Ints
    """(B + 1,): the contacts of robot k are ``offsets[k]:offsets[k + 1]``."""


class Contacts(_Answer, _ContactsFields):
    """Contacts of robots with a mesh, one in each row."""

    __slots__ = ()
    _instead = "use len(contacts.distance)"


class _ClearanceFields(NamedTuple):
    lower: FloatOrFloats
    """The clearance is at least this."""
    upper: FloatOrFloats
    """The clearance is at most this: 0 where the tube touches the mesh."""
    resolved: BoolOrBools
    """Whether the bounds are no farther apart than the tolerance and ``uncertainty``."""
    uncertainty: FloatOrFloats
    """What a stated deviation of the points costs, which no finer tolerance can mend."""
    on_robot: Floats
    """A point of the tube, (3,)."""
    on_mesh: Floats
    """A point of the mesh, (3,). The two are ``upper`` apart, or nearer."""
    segment: IntOrInts
    """The segment of the input there."""
    arc_length: FloatOrFloats
    """How far along the centreline from the base."""
    triangle: IntOrInts
    """The triangle there."""
    status: StrOrStrs
    """Of a batch: why there are no bounds, as the ``kind`` of the error, and the empty string where there are."""


class Clearance(_Answer, _ClearanceFields):
    """Bounds on the clearance of a tube."""

    __slots__ = ()
    _instead = "compare its `lower` and `upper`"


class _MotionAnswerFields(NamedTuple):
    decision: DecisionOrDecisions
    """Whether the margin is kept at every time from 0 to 1."""
    interval: Floats
    """(2,): the margin is kept before the first time, and may not be kept until the second."""
    t: FloatOrFloats
    """Where the decision is contact: the time of a shape that does not keep the margin; else NaN."""
    upper: FloatOrFloats
    """The clearance of that shape is at most this."""
    on_robot: Floats
    """A point of that shape, (3,)."""
    on_mesh: Floats
    """A point of the mesh, (3,)."""
    segment: IntOrInts
    """The segment of the input there."""
    arc_length: FloatOrFloats
    """How far along that shape's centreline from the base."""
    triangle: IntOrInts
    """The triangle there."""
    reason: ReasonOrReasons
    """Where the decision is undecided, why; else ``UndecidedReason.NONE``."""


class MotionAnswer(_MotionDecision, _MotionAnswerFields):
    """Whether a motion keeps a margin, until when, and which shape does not."""

    __slots__ = ()


class _MotionClearanceFields(NamedTuple):
    lower: FloatOrFloats
    """No shape of the motion is nearer than this."""
    upper: FloatOrFloats
    """The shape at ``t`` is no farther away than this: 0 where it touches the mesh."""
    resolved: BoolOrBools
    """Whether the bounds are no farther apart than the tolerance and ``uncertainty``."""
    uncertainty: FloatOrFloats
    """What the errors that shapes state for themselves cost, and no finer tolerance can mend."""
    t: FloatOrFloats
    """The time of the shape that realises ``upper``, from 0 to 1."""
    on_robot: Floats
    """A point of that shape, (3,)."""
    on_mesh: Floats
    """A point of the mesh, (3,). The two are ``upper`` apart, or nearer."""
    segment: IntOrInts
    """The segment of the input there."""
    arc_length: FloatOrFloats
    """How far along that shape's centreline from the base."""
    triangle: IntOrInts
    """The triangle there."""


class MotionClearance(_Answer, _MotionClearanceFields):
    """How near a motion comes, between bounds, and when."""

    __slots__ = ()
    _instead = "compare its `lower` and `upper`"


class _InsideAnswerFields(NamedTuple):
    clears: BoolOrBools
    """Whether every link keeps more than the margin."""
    base: SideOrSides
    """The side of the first point of the centreline."""
    tip: SideOrSides
    """The side of the last point of the centreline."""
    crosses_opening: BoolOrBools
    """Whether a link touches the lid of an opening of the mesh: the triangles between its edges and its centre."""


class InsideAnswer(_Answer, _InsideAnswerFields):
    """Whether a robot keeps a margin, and on which side it is."""

    __slots__ = ()

    @property
    def is_clear(self) -> BoolOrBools:
        """Whether every link keeps more than the margin, on whichever side: ``clears``."""
        return self.clears

    @property
    def holds(self) -> BoolOrBools:
        """Whether the whole robot is inside and every link keeps the margin: no link touches the mesh or crosses an
        opening, base or tip is inside, and neither is outside. Near an opening an end may be undecided: it is on the side
        of the other end."""
        base, tip = self.base, self.tip
        is_inside = ((base == Side.INSIDE) | (tip == Side.INSIDE)) & (base != Side.OUTSIDE) & (tip != Side.OUTSIDE)
        crosses = np.asarray(self.crosses_opening)
        return is_inside & self.clears & (~crosses if crosses.ndim else not self.crosses_opening)


class _SurfaceFields(NamedTuple):
    width: Floats
    """(K,): how wide each opening is, the widest first: its extent across the line between two corners far apart."""
    centre: Floats
    """(K, 3): the mean of the ends of its edges."""
    edges: Ints
    """(K,): the number of its edges."""
    nonmanifold_edges: int
    """The number of edges of more than two triangles."""
    misoriented_edges: int
    """The number of edges whose two triangles face opposite ways."""


class Surface(_SurfaceFields):
    """What a mesh is as a surface: its openings, and edges that make its sides doubtful."""

    __slots__ = ()

    def __bool__(self) -> NoReturn:
        raise _no_truth("Surface", "use `.is_sound`")

    def __repr__(self) -> str:
        return _short(self)

    @property
    def is_sound(self) -> bool:
        """Whether the mesh is closed, and all its triangles face the same way."""
        return len(self.width) == 0 and self.nonmanifold_edges == 0 and self.misoriented_edges == 0


class _CertificateFields(NamedTuple):
    lower: Floats
    """(N - 1,): the distance is at least this."""
    upper: Floats
    """(N - 1,): the distance is at most this."""


class Certificate(_Answer, _CertificateFields):
    """Bounds on distances that hold despite all rounding."""

    __slots__ = ()
    _instead = "compare its `lower` and `upper`"


class _GradientFields(NamedTuple):
    value: FloatOrFloats
    """The distance, or minus the least translation where robot and mesh overlap."""
    points: Floats
    """(N, 3): the derivative with respect to each point, in the robot's frame."""
    radii: Floats
    """(N - 1,): the derivative with respect to each radius."""
    pose: Floats
    """(4, 4): the derivative with respect to the entries of the pose."""
    kink: BoolOrBools
    """Whether other points are as close, for which the derivative is another, or a bend between equal radii is closest,
    which is no longer filled if one of the radii changes alone."""


class Gradient(_Answer, _GradientFields):
    """A distance, and how it changes."""

    __slots__ = ()
    _instead = "compare its `value`"


class _RobotProximityFields(NamedTuple):
    distance: FloatOrFloats
    """The distance, 0 where they touch or overlap, and infinite where no parts of one robot could meet."""
    on_first: Floats
    """(3,): the closest point of the first."""
    on_second: Floats
    """(3,): the closest point of the second."""
    segments: Ints
    """(2,): the segment of the input of either."""
    arc_lengths: Floats
    """(2,): how far along the centreline of either from its base."""


class RobotProximity(_Answer, _RobotProximityFields):
    """Where two robots, or two parts of one, are closest to each other."""

    __slots__ = ()
    _instead = "compare its `distance`"


class _RobotClearanceFields(NamedTuple):
    lower: FloatOrFloats
    """The clearance is at least this."""
    upper: FloatOrFloats
    """The clearance is at most this: 0 where the tubes touch or overlap."""
    resolved: BoolOrBools
    """Whether the bounds are no farther apart than the tolerance and ``uncertainty``."""
    uncertainty: FloatOrFloats
    """What stated deviations of the points cost, which no finer tolerance can mend."""
    on_first: Floats
    """A point of the first tube, (3,)."""
    on_second: Floats
    """A point of the second tube, (3,). The two are ``upper`` apart, or nearer."""
    arc_lengths: Floats
    """(2,): how far along the centreline of either from its base."""
    status: StrOrStrs
    """Of a batch: why there are no bounds, as the ``kind`` of the error, and the empty string where there are."""


class RobotClearance(_Answer, _RobotClearanceFields):
    """Bounds on how near two tubes are."""

    __slots__ = ()
    _instead = "compare its `lower` and `upper`"


class _RobotContactsFields(NamedTuple):
    distance: Floats
    """(K,): the distance, 0 where they touch or overlap."""
    on_first: Floats
    """(K, 3): the closest point of the first."""
    on_second: Floats
    """(K, 3): the closest point of the second."""
    segments: Ints
    """(K, 2): the segment of the input of either."""
    arc_lengths: Floats
    """(K, 2): how far along the centreline of either from its base."""
    pair: Ints
    """(K,): the pair of the batch, 0 where there is one."""
    offsets: Ints
    """(B + 1,): the places of pair k are ``offsets[k]:offsets[k + 1]``."""


class RobotContacts(_Answer, _RobotContactsFields):
    """Places where two robots are near one another, one in each row."""

    __slots__ = ()
    _instead = "use len(contacts.distance)"


class _RobotMotionAnswerFields(NamedTuple):
    decision: DecisionOrDecisions
    """Whether the margin is kept at every time from 0 to 1."""
    interval: Floats
    """(2,): the margin is kept before the first time, and may not be kept until the second."""
    t: FloatOrFloats
    """Where the decision is contact: the time of two shapes that do not keep the margin; else NaN."""
    upper: FloatOrFloats
    """The clearance of those shapes is at most this."""
    on_first: Floats
    """A point of the first robot's shape, (3,)."""
    on_second: Floats
    """A point of the second robot's shape, (3,)."""
    arc_lengths: Floats
    """How far along each centreline from the base, (2,)."""
    reason: ReasonOrReasons
    """Where the decision is undecided, why; else ``UndecidedReason.NONE``."""


class RobotMotionAnswer(_MotionDecision, _RobotMotionAnswerFields):
    """Whether two moving robots, or two parts of one, keep a margin, and which shapes do not."""

    __slots__ = ()


class _RobotMotionClearanceFields(NamedTuple):
    lower: FloatOrFloats
    """The robots are never nearer to each other than this."""
    upper: FloatOrFloats
    """The shapes at ``t`` are no farther apart than this: 0 where they touch or overlap."""
    resolved: BoolOrBools
    """Whether the bounds are no farther apart than the tolerance and ``uncertainty``."""
    uncertainty: FloatOrFloats
    """What the errors that shapes state for themselves cost, and no finer tolerance can mend."""
    t: FloatOrFloats
    """The time of the shapes that realise ``upper``, from 0 to 1."""
    on_first: Floats
    """(3,): a point of the first robot."""
    on_second: Floats
    """(3,): a point of the second. The two are ``upper`` apart, or nearer."""
    arc_lengths: Floats
    """(2,): how far along the centreline of either from its base."""


class RobotMotionClearance(_Answer, _RobotMotionClearanceFields):
    """How near two moving robots come to each other, between bounds, and when."""

    __slots__ = ()
    _instead = "compare its `lower` and `upper`"


class _SceneMotionAnswerFields(NamedTuple):
    decision: DecisionOrDecisions
    """Whether all margins are kept at every time from 0 to 1."""
    interval: Floats
    """(2,): all margins are kept before the first time, and may not be kept until the second."""
    t: FloatOrFloats
    """Where the decision is contact: the time of shapes that do not keep a margin; else NaN."""
    upper: FloatOrFloats
    """The clearance of those shapes is at most this."""
    structure: IntOrInts
    """The structure in contact, or -1 where it is between robots."""
    name: StrOrStrs
    """The name of the structure, or the empty string."""
    robots: Ints
    """(2,): the robot and -1, or the two robots, or one robot twice where it is itself."""
    on_first: Floats
    """(3,): a point of the first robot."""
    on_second: Floats
    """(3,): a point of the structure or the second robot."""
    arc_lengths: Floats
    """(2,): how far along the centreline of either robot from its base; NaN for a structure."""
    triangle: IntOrInts
    """The triangle of the structure, or -1."""
    reason: ReasonOrReasons
    """Where the decision is undecided, why; else ``UndecidedReason.NONE``."""
    status: StrOrStrs
    """Of a batch: why there is no answer, as the ``kind`` of the error, and the empty string where there is one."""


class SceneMotionAnswer(_MotionDecision, _SceneMotionAnswerFields):
    """Whether robots that move in a scene keep all margins, and what does not."""

    __slots__ = ()


class _SceneClearanceFields(NamedTuple):
    lower: FloatOrFloats
    """Every slack is at least this; infinite where nothing has a margin."""
    upper: FloatOrFloats
    """The slack there is at most this."""
    resolved: BoolOrBools
    """Whether the bounds are no farther apart than the tolerance and ``uncertainty``."""
    uncertainty: FloatOrFloats
    """What the errors that tubes state for themselves cost, and no finer tolerance can mend."""
    structure: IntOrInts
    """The structure, or -1 where it is between two robots."""
    name: StrOrStrs
    """The name of the structure, or the empty string."""
    robots: Ints
    """(2,): the robot and -1, or the two robots."""
    on_first: Floats
    """(3,): a point of the first robot."""
    on_second: Floats
    """(3,): a point of the structure or the second robot."""
    arc_lengths: Floats
    """(2,): how far along the centreline of either robot from its base; NaN for a structure."""
    triangle: IntOrInts
    """The triangle of the structure, or -1."""
    status: StrOrStrs
    """Of a batch: why there are no bounds, as the ``kind`` of the error, and the empty string where there are."""


class SceneClearance(_Answer, _SceneClearanceFields):
    """Bounds on the least slack of tubes in a scene."""

    __slots__ = ()
    _instead = "compare its `lower` and `upper`"


class _SceneMotionClearanceFields(NamedTuple):
    lower: FloatOrFloats
    """Every slack is at least this at every time; infinite where nothing has a margin."""
    upper: FloatOrFloats
    """The slack there, at the time ``t``, is at most this."""
    resolved: BoolOrBools
    """Whether the bounds are no farther apart than the tolerance and ``uncertainty``."""
    uncertainty: FloatOrFloats
    """What the errors that shapes state for themselves cost, and no finer tolerance can mend."""
    t: FloatOrFloats
    """The time of the shapes that realise ``upper``, from 0 to 1."""
    structure: IntOrInts
    """The structure, or -1 where it is between two robots."""
    name: StrOrStrs
    """The name of the structure, or the empty string."""
    robots: Ints
    """(2,): the robot and -1, or the two robots."""
    on_first: Floats
    """(3,): a point of the first robot."""
    on_second: Floats
    """(3,): a point of the structure or the second robot."""
    arc_lengths: Floats
    """(2,): how far along the centreline of either robot from its base; NaN for a structure."""
    triangle: IntOrInts
    """The triangle of the structure, or -1."""
    status: StrOrStrs
    """Of a batch: why there are no bounds, as the ``kind`` of the error, and the empty string where there are."""


class SceneMotionClearance(_Answer, _SceneMotionClearanceFields):
    """Bounds on the least slack of robots that move in a scene, and when."""

    __slots__ = ()
    _instead = "compare its `lower` and `upper`"


class _PerStructureFields(NamedTuple):
    distance: Floats
    """(M,): the distances, 0 where they touch or overlap."""
    slack: Floats
    """(M,): the distance less the margin between the two, or NaN where they have none."""
    on_robot: Floats
    """(M, 3): the robots' closest points."""
    on_mesh: Floats
    """(M, 3): the structures' closest points."""
    robot: Ints
    """(M,): the robot of the list that is closest."""
    segment: Ints
    """(M,): its segment."""
    arc_length: Floats
    """(M,): how far along its centreline from the base."""
    triangle: Ints
    """(M,): the structure's closest triangle."""
    name: Strs
    """(M,): the name of the structure."""


class PerStructure(_Answer, _PerStructureFields):
    """Where robots are closest to each of M structures of a scene, in the scene's frame."""

    __slots__ = ()
    _axes = ("batch", "structure")
    _instead = "compare its `slack`"


class _SceneContactsFields(NamedTuple):
    structure: Ints
    """(K,): the structure."""
    name: Strs
    """(K,): the name of the structure."""
    robot: Ints
    """(K,): the robot of the list."""
    segment: Ints
    """(K,): the segment of the input."""
    fraction: Floats
    """(K,): where along the segment, from 0 to 1."""
    arc_length: Floats
    """(K,): how far along the centreline from the base."""
    distance: Floats
    """(K,): the distance, 0 where they touch or overlap."""
    depth: Floats
    """(K,): the distance with a sign: negative where they overlap."""
    normal: Floats
    """(K, 3): the unit vector from the wall to the robot, or NaN."""
    on_robot: Floats
    """(K, 3): the robot's closest point."""
    on_mesh: Floats
    """(K, 3): the structure's closest point."""
    triangle: Ints
    """(K,): the triangle."""
    batch: Ints
    """(K,): the set of robots of the batch, 0 where there is one."""
    offsets: Ints
    """(B + 1,): the contacts of set k are ``offsets[k]:offsets[k + 1]``."""


class SceneContacts(_Answer, _SceneContactsFields):
    """Contacts of robots with the structures of a scene, one in each row, in the scene's frame."""

    __slots__ = ()
    _instead = "use len(contacts.distance)"


class _TightestFields(NamedTuple):
    slack: FloatOrFloats
    """The distance less the margin; negative where a margin is not kept, and infinite where nothing has a margin."""
    distance: FloatOrFloats
    """The distance there, 0 where they touch or overlap."""
    structure: IntOrInts
    """The structure, or -1 where it is between two robots."""
    name: StrOrStrs
    """The name of the structure, or the empty string."""
    robots: Ints
    """(2,): the robot and -1, or the two robots."""
    segments: Ints
    """(2,): the segments of those robots."""
    triangle: IntOrInts
    """The triangle of the structure, or -1."""
    on_first: Floats
    """(3,): the closest point of the first robot."""
    on_second: Floats
    """(3,): the closest point of the structure or the second robot."""


class Tightest(_Answer, _TightestFields):
    """Where the room in a scene is least."""

    __slots__ = ()

    @property
    def is_clear(self) -> BoolOrBools:
        """Whether every margin is kept: ``slack`` is more than 0. False where nothing has a margin."""
        found = (np.asarray(self.slack) > 0) & (self.robots[..., 0] >= 0)
        return bool(found) if np.ndim(found) == 0 else found


class FramedPoints(np.ndarray[Any, np.dtype[np.float64]]):
    """Points as they were read from a file that states their frame. Copies, parts and joined arrays of them keep the
    frame. What is computed from them is a plain array."""

    frame: Optional[str] = None
    """The frame: "RAS" or "LPS"."""

    def __array_finalize__(self, source: Any) -> None:
        self.frame = getattr(source, "frame", None)

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        plain = np.asarray(array)
        return plain[()] if plain.ndim == 0 else plain

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        found = super().__array_function__(function, types, args, kwargs)
        if function in _JOINING and isinstance(found, np.ndarray) and found.dtype == np.float64:
            frames = sorted({given.frame for given in _points_in((args, kwargs)) if given.frame is not None})
            if len(frames) > 1:
                text = f"points of the frames {' and '.join(frames)} are joined: x and y have opposite signs; load all with one frame"
                warnings.warn(text, stacklevel=_callers_level())
            return _framed(found, frames[0] if len(frames) == 1 else None)
        return found

    def __reduce__(self) -> tuple[Any, ...]:
        return _framed, (np.asarray(self), self.frame)

    def __deepcopy__(self, memo: Any) -> FramedPoints:
        return _framed(np.asarray(self).copy(), self.frame)


# Others, such as `np.stack`, call one of these.
_JOINING = (np.concatenate, np.insert, np.tile, np.broadcast_to)


def _callers_level() -> int:
    """The level of the stack at which neither this package nor numpy is."""
    level, frame = 0, sys._getframe()
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] in ("numpy", "parry_continuum"):
        level, frame = level + 1, frame.f_back
    return level


def _points_in(given: Any) -> Iterator[FramedPoints]:
    """The points with a frame among arguments, and in their lists."""
    if isinstance(given, FramedPoints):
        yield given
    elif isinstance(given, (list, tuple, dict)):
        for part in given.values() if isinstance(given, dict) else given:
            yield from _points_in(part)


def _framed(points: Floats, frame: Optional[str]) -> FramedPoints:
    """Points with their frame."""
    found = points.view(FramedPoints)
    found.frame = frame
    return found


class Centreline(NamedTuple):
    """A centreline that was read from a file."""

    points: Floats
    """(N, 3): the points. A mesh that states another frame warns if it is asked about them."""
    radii: Optional[Floats]
    """(N - 1,): the radius of each segment, or None if the file has none."""
    frame: Optional[str]
    """The frame, "RAS" or "LPS", or None if the file does not state it."""
    unit: Optional[str]
    """The unit that the file states, such as "mm", or None."""
    skipped: int
    """How many points were left out because they have no position yet."""

    def __repr__(self) -> str:
        return _short(self)
