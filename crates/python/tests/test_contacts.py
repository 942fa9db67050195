"""Contacts of a rough wall, and how prominence leaves the shallow ones out."""

from __future__ import annotations

import numpy as np

from parry_continuum import Mesh


def test_prominence() -> None:
    """Bumps of 0.1 under a straight robot: each is a contact, but one is left if lesser ones than 0.5 do not count."""
    x, y = np.meshgrid(np.linspace(-5, 5, 101), np.linspace(-1, 1, 21), indexing="ij")
    height = 0.1 * np.cos(6 * x) * np.cos(2 * y) - 0.01 * x**2
    vertices = np.stack([x, y, height], axis=-1).reshape(-1, 3)
    a = (21 * np.arange(100)[:, None] + np.arange(20)).ravel()
    faces = np.concatenate([np.stack([a, a + 21, a + 1], 1), np.stack([a + 21, a + 22, a + 1], 1)])
    wall, robot = Mesh(vertices, faces), np.array([[-4, 0, 1.0], [4, 0, 1.0]])
    every = wall.contacts_within(robot, 0.2, margin=1.2)
    assert 5 <= len(every.segment) <= 20
    assert (np.abs(every.on_mesh[:, 1]) < 0.2).all() and every.distance.min() == wall.distance(robot, 0.2)
    # Between bumps the wall is about 0.2 lower than on them.
    assert len(wall.contacts_within(robot, 0.2, margin=1.2, prominence=0.1).segment) == len(every.segment)
    few = wall.contacts_within(robot, 0.2, margin=1.2, prominence=0.5)
    assert few.distance.tolist() == [every.distance.min()]
    # Before the outermost bumps it is 1.03 away, so that no way within a margin of 1 leads from them to a nearer place.
    assert len(wall.contacts_within(robot, 0.2, margin=1.0, prominence=0.5).segment) == 3
