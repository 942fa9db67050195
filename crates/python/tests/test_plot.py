"""The plot shows the answer of `per_link`."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from parry_continuum import ContinuumError, Mesh, plot_clearance

# Two floors: one 2 below the robot's first part, one 0.5 below its second part.
FLOORS = Mesh(
    [[-9, -9, 0], [3, -9, 0], [3, 9, 0], [-9, 9, 0], [3, -9, 1.5], [9, -9, 1.5], [9, 9, 1.5], [3, 9, 1.5]],
    [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
    unit="mm",
)
# The third point is given twice.
ROBOT = np.array([[-4.0, 0, 2.5], [-2, 0, 2.5], [0, 0, 2.5], [0, 0, 2.5], [5, 0, 2.5], [6, 0, 2.5]])
RADIUS = 0.5


@pytest.fixture(autouse=True)
def figures(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("MPLBACKEND", "Agg")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    yield
    pyplot.close("all")


def test_the_line_is_the_distance_of_each_segment() -> None:
    axes: Any = plot_clearance(FLOORS, ROBOT, RADIUS)
    (stairs,) = axes.patches
    values, edges, _ = stairs.get_data()
    assert_allclose(values, [2, 2, 0.5, 0.5])
    assert_allclose(edges, [0, 2, 4, 9, 10])
    (dot,) = axes.lines
    assert_allclose(dot.get_ydata(), [0.5])
    # Where the first point above the second floor is.
    assert 7 <= dot.get_xdata()[0] <= 9
    assert axes.get_title().startswith("minimum 0.500 mm: segment 3, ")
    assert axes.get_xlabel().endswith("(mm)") and axes.get_ylabel().endswith("(mm)")
    assert axes.get_ylim()[0] == 0 and axes.get_legend() is None


def test_segments_that_do_not_keep_the_margin_are_marked() -> None:
    axes: Any = plot_clearance(FLOORS, ROBOT, RADIUS, margin=1.0)
    (near,) = axes.collections
    assert_allclose(near.get_segments(), [[[4, 0.5], [9, 0.5]], [[9, 0.5], [10, 0.5]]])
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert texts == ["margin 1 mm", "not kept"]
    kept = plot_clearance(FLOORS, ROBOT, RADIUS, margin=0.25)
    assert len(kept.collections) == 0
    # A margin is kept by more than its length alone.
    assert len(plot_clearance(FLOORS, ROBOT, RADIUS, margin=0.5).collections) == 1


def test_a_pose_caps_and_axes_of_the_caller() -> None:
    from matplotlib.figure import Figure

    own: Any = Figure().subplots()
    pose = np.eye(4)
    pose[2, 3] = 1
    assert plot_clearance(FLOORS, ROBOT.tolist(), [RADIUS] * 5, pose=pose, axes=own) is own
    assert_allclose(own.patches[0].get_data()[0], [3, 3, 1.5, 1.5])
    upright = [[-5, 0, 8], [-5, 0, 5], [-5, 0, 3]]
    for caps, tip in (("capsules", 2.5), ("cylinders", 3), ("fitted", 3)):
        axes: Any = plot_clearance(FLOORS, upright, RADIUS, caps=caps)  # type: ignore[arg-type]
        assert axes.patches[0].get_data()[0][-1] == tip


def test_wrong_arguments_are_named() -> None:
    with pytest.raises(ContinuumError, match="a plot is about one robot, and 2 are given") as raised:
        plot_clearance(FLOORS, np.stack([ROBOT, ROBOT]), RADIUS)
    assert raised.value.kind == "bad_shape"
    with pytest.raises(ContinuumError, match="margin"):
        plot_clearance(FLOORS, ROBOT, RADIUS, margin=-1.0)
    with pytest.raises(ContinuumError, match="radii"):
        plot_clearance(FLOORS, ROBOT, [0.5, 0.5])


def test_without_matplotlib_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(ImportError, match=r"pip install 'parry-continuum\[plot\]'"):
        plot_clearance(FLOORS, ROBOT, RADIUS)
