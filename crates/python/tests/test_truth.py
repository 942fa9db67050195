"""No answer passes for yes or no by being there: ``bool()`` is an error that names what to use."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from parry_continuum import Decision, Decisions, LinearMotion, Mesh, RobotPair, Scene, SelfQuery, Side, UndecidedReason
from shapes import sphere

MESH = Mesh(*sphere())
PAIR, QUERY = RobotPair(), SelfQuery()
INSIDE = np.array([[0, 0, 0.0], [0, 0, 1.0]])
THROUGH = np.array([[0, 0, 0.0], [0, 0, 30.0]])
BOTH = np.stack([INSIDE, THROUGH])
SHIFT = np.array([0.5, 0, 0])
SCENE = Scene()
SCENE.add("wall", MESH, margin=0.5)
AT_REST = LinearMotion(INSIDE + [3, 0, 0], INSIDE + [3, 0, 0], 0.1)


def motion(points: np.ndarray) -> LinearMotion:
    return LinearMotion(points, points + SHIFT, 0.1)


def hairpin(y: float) -> np.ndarray:
    return np.array([[0, 0, 0], [0, 0, 40], [8, 0, 40], [4, y, 2]])


def swing(ends: list[float]) -> LinearMotion:
    return LinearMotion(np.stack([hairpin(-6.0) for _ in ends]), np.stack([hairpin(end) for end in ends]), 1.0)


# Of each function: one that is clear, one that is not, and both of them as a batch.
DECIDED = {
    "clears_motion": [MESH.clears_motion(motion(p), margin=0.5, resolution=0.01) for p in (INSIDE, THROUGH, BOTH)],
    "time_of_contact": [MESH.time_of_contact(motion(p), margin=0.5, resolution=0.01) for p in (INSIDE, THROUGH, BOTH)],
    "clears_motion_while": [
        MESH.clears_motion_while(MESH.vertices, motion(p), margin=0.5, resolution=0.01) for p in (INSIDE, THROUGH, BOTH)
    ],
    "clears_path": [
        MESH.clears_path(np.stack([p, p + SHIFT], axis=-3), 0.1, 0.0, margin=0.5, resolution=0.01)
        for p in (INSIDE, THROUGH, BOTH)
    ],
    "clears_tube": [MESH.clears_tube(p, 0.1, margin=0.5, resolution=0.01) for p in (INSIDE, THROUGH, BOTH)],
    "clears_inside": [MESH.clears_inside(p, 0.1, margin=0.5) for p in (INSIDE, THROUGH, BOTH)],
    "tightest": [SCENE.tightest([(p, 0.1)]) for p in (INSIDE, THROUGH, BOTH)],
    "pair.clears_motions": [
        PAIR.clears_motions(motion(p), AT_REST, margin=1.0, resolution=0.01)
        for p in (INSIDE, INSIDE + [3, 0, 0], np.stack([INSIDE, INSIDE + [3, 0, 0]]))
    ],
    "pair.clears_tubes": [
        PAIR.clears_tubes(p, 0.1, INSIDE + [3, 0, 0], 0.1, margin=1.0, resolution=0.01)
        for p in (INSIDE, INSIDE + [3, 0, 0], np.stack([INSIDE, INSIDE + [3, 0, 0]]))
    ],
    "query.clears_tube": [QUERY.clears_tube(p, 0.1, margin=1.0, resolution=0.01) for p in (INSIDE, THROUGH, BOTH)],
    "query.clears_motion": [
        QUERY.clears_motion(m, margin=2.5, resolution=1e-3)
        for m in (LinearMotion(hairpin(-6), hairpin(-5), 1.0), LinearMotion(hairpin(-6), hairpin(2), 1.0), swing([-5, 2]))
    ],
}


@pytest.mark.parametrize("name", DECIDED)
def test_is_clear(name: str) -> None:
    clear, touches, both = DECIDED[name]
    assert [clear.is_clear, touches.is_clear] == [True, name == "query.clears_tube"]
    assert type(clear.is_clear) is bool
    assert_array_equal(both.is_clear, [clear.is_clear, touches.is_clear])
    assert both.is_clear.dtype == np.bool_ and type(both.is_clear) is np.ndarray


@pytest.mark.parametrize("name", DECIDED)
def test_no_truth_value(name: str) -> None:
    for answer in DECIDED[name]:
        with pytest.raises(TypeError, match=r"truth value .* is ambiguous; use `\.is_clear`"):
            bool(answer)
        with pytest.raises(TypeError, match="is_clear"):
            assert not answer


@pytest.mark.parametrize(
    ("answer", "instead"),
    [
        (MESH.minimum(INSIDE, 0.1), "`distance`"),
        (MESH.per_link(BOTH, 0.1), "`distance`"),
        (MESH.contacts_within(INSIDE, 0.1, margin=0.5), r"len\(contacts.distance\)"),
        (MESH.clearance(INSIDE, 0.1, tolerance=0.5), "`lower` and `upper`"),
        (MESH.clearance_of_motion(motion(INSIDE), tolerance=0.5), "`lower` and `upper`"),
        (MESH.certify(INSIDE, 0.1, MESH.per_link(INSIDE, 0.1)), "`lower` and `upper`"),
        (MESH.distance_and_gradient(INSIDE, 0.1), "`value`"),
        (PAIR.minimum(INSIDE, 0.1, THROUGH, 0.1), "`distance`"),
        (PAIR.contacts_within(INSIDE, 0.1, THROUGH, 0.1, margin=9.0), r"len\(contacts.distance\)"),
        (PAIR.clearance(INSIDE, 0.1, THROUGH, 0.1, tolerance=9.0), "`lower` and `upper`"),
        (SCENE.per_structure([(INSIDE, 0.1)]), "`slack`"),
        (SCENE.contacts_within([(INSIDE, 0.1)], reach=0.5), r"len\(contacts.distance\)"),
        (Side.OUTSIDE, r"side is Side\.INSIDE.*\.is_clear"),
        (Side.UNDECIDED, r"side is Side\.INSIDE.*\.is_clear"),
        (MESH.side([0, 0, 0]), r"side is Side\.INSIDE.*\.is_clear"),
        (MESH.side([[0, 0, 0]]), r"sides == Side\.INSIDE.*\.is_clear"),
        (Decision.CONTACT, r"use `\.is_clear`"),
        (Decision.UNDECIDED, r"use `\.is_clear`"),
    ],
)
def test_other_answers(answer: object, instead: str) -> None:
    with pytest.raises(TypeError, match="truth value .* is ambiguous; .*" + instead):
        bool(answer)


def test_inside_holds() -> None:
    places = np.stack([INSIDE, THROUGH, INSIDE + [0, 0, 50]])
    many = MESH.clears_inside(places, 0.1, margin=0.5)
    assert_array_equal(many.holds, [True, False, False])
    assert_array_equal(many.is_clear, [True, False, True])
    for place, holds in zip(places, [True, False, False]):
        assert MESH.clears_inside(place, 0.1, margin=0.5).holds is holds
    none = MESH.clears_inside(places[:0], 0.1, margin=0.5)
    assert none.holds.shape == none.is_clear.shape == (0,)


DECISIONS = MESH.clears_tube(BOTH, 0.1, margin=0.5, resolution=0.01)


@pytest.mark.parametrize(
    "ask",
    [
        lambda d: np.where(d, 1, 0),
        lambda d: np.where(d.tolist(), 1, 0),
        lambda d: np.count_nonzero(d),
        lambda d: d.astype(bool),
        lambda d: np.array(d, dtype=bool),
        lambda d: np.asarray(d).astype(bool),
        lambda d: np.array(list(d)).any(),
        lambda d: np.logical_and.reduce(d),
        lambda d: np.logical_or(d, d),
        lambda d: np.logical_not(d),
        lambda d: d.nonzero(),
        lambda d: np.flatnonzero(d),
        lambda d: np.argwhere(d),
        lambda d: np.extract(d, [1, 2]),
        lambda d: np.compress(d, [1, 2]),
        lambda d: np.zeros(2, bool).__setitem__(slice(None), d),
        lambda d: any(d),
        lambda d: np.any(d),
        lambda d: np.all(d),
    ],
)
def test_numpy_takes_no_decision_for_true(ask: Any) -> None:
    for decisions in (DECISIONS, MESH.clears_motion(motion(BOTH), margin=0.5, resolution=0.01).decision):
        with pytest.raises(TypeError, match=r"use `\.is_clear`"):
            ask(decisions)
    with pytest.raises(TypeError, match=r"use `\.is_inside`"):
        ask(MESH.side([[0, 0, 0], [0, 0, 50]]))


def test_decisions_are_no_index() -> None:
    for index in (DECISIONS, DECISIONS[1], DECISIONS.tolist(), np.asarray(DECISIONS)):
        with pytest.raises(IndexError):
            BOTH[index]
    assert_array_equal(BOTH[DECISIONS.is_clear], BOTH[:1])
    assert_array_equal(BOTH[DECISIONS == Decision.CONTACT], BOTH[1:])


def test_what_decisions_are() -> None:
    assert Decision.CONTACT == -1 and int(Decision.CLEAR) == 1 and Decision(0) is Decision.UNDECIDED
    assert Decision.CONTACT != Side.INSIDE and Decision.CLEAR > Decision.UNDECIDED >= 0 > Decision.CONTACT <= -1
    assert {Decision.CLEAR: 2}[DECISIONS[0]] == 2
    assert_array_equal(DECISIONS.astype(int), [1, -1])
    assert_array_equal(np.asarray(DECISIONS, float), [1, -1])
    assert type(DECISIONS.astype(int)) is np.ndarray
    assert_array_equal(DECISIONS < 0, [False, True])
    assert_array_equal(np.unique(DECISIONS), [Decision.CONTACT, Decision.CLEAR])
    with pytest.raises(TypeError):
        assert Decision.CLEAR < "x"  # type: ignore[operator]
    for again in (copy.copy(DECISIONS), pickle.loads(pickle.dumps(DECISIONS)), DECISIONS[:], DECISIONS.copy()):
        assert type(again) is Decisions and again[1] is Decision.CONTACT
    table = MESH.clears_motion(motion(BOTH), margin=0.5, resolution=0.01).to_dict()
    assert table["decision"].dtype == np.int8 and table["decision"].tolist() == [1, -1]


def test_sides_have_what_a_side_has() -> None:
    points = [[0, 0, 0], [0, 0, 50], MESH.vertices[0]]
    sides = MESH.side(points)
    for name in ("is_inside", "is_outside"):
        assert_array_equal(getattr(sides, name), [getattr(MESH.side(point), name) for point in points])
        assert getattr(sides, name).dtype == bool and type(getattr(MESH.side(points[0]), name)) is bool
    assert_array_equal(sides.is_inside, [True, False, False])
    assert_array_equal(sides.is_outside, [False, True, False])


def test_items_of_batches_have_no_truth_value_either() -> None:
    decisions = DECISIONS
    assert list(decisions) == [Decision.CLEAR, Decision.CONTACT] and decisions[1] is Decision.CONTACT
    for ask in (lambda: bool(decisions[:1]), lambda: bool(decisions[1]), decisions.all, lambda: np.any(decisions)):
        with pytest.raises(TypeError, match="is_clear"):
            ask()
    sides = MESH.side([[0, 0, 0], [0, 0, 50]])
    assert sides[0] is Side.INSIDE and type(sides == Side.INSIDE) is np.ndarray
    assert (sides == Side.INSIDE).tolist() == [True, False]
    with pytest.raises(TypeError, match="sides == Side.INSIDE"):
        sides.all()
    none = MESH.clears_tube(BOTH[:0], 0.1, margin=0.5, resolution=0.01)
    assert none.is_clear.shape == (0,)
    assert not UndecidedReason.NONE and UndecidedReason.WORK  # whether there is a reason


@pytest.mark.parametrize("name", DECIDED)
def test_copies(name: str) -> None:
    for answer in DECIDED[name]:
        for again in (copy.copy(answer), copy.deepcopy(answer), pickle.loads(pickle.dumps(answer))):
            assert type(again) is type(answer)
            assert_array_equal(again.is_clear, answer.is_clear)
            if isinstance(answer, tuple):
                for one, other in zip(again, answer):
                    assert_array_equal(one, other)


def test_dask() -> None:
    dask = pytest.importorskip("dask")
    answer = MESH.clears_motion(motion(BOTH), margin=0.5, resolution=0.01)
    same = dask.delayed(lambda given: given)(answer)
    assert_array_equal(same.compute(scheduler="synchronous").is_clear, answer.is_clear)
    one = dask.delayed(lambda: MESH.clears_motion(motion(INSIDE), margin=0.5, resolution=0.01))()
    assert one.compute(scheduler="synchronous").is_clear
