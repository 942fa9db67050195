"""Plans of OMPL whose edges are proven: `pip install 'ompl>=2' matplotlib`.

    python ompl_plan.py
    python ompl_plan.py --mesh ventricle.stl --organ vein.stl --base base.txt

A concentric tube robot enters a cavity of the brain with two organs, beside a second robot at rest. RRT-Connect and PRM plan with
edges that `Scene.clears_motion` proves, and with OMPL's own validator, which checks states 0.5 mm or 0.1 mm apart. The edges that
each validator accepts are checked by `Scene.clears_motion`. Lengths are in mm.

The robot is a telescope of two balanced pairs of precurved tubes, torsionally rigid. Turning the tubes of a pair together turns
its curvature, turning them apart lowers it. So a section has any curvature vector up to the curvature of its tubes.
"""

import argparse
import itertools
import time
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from parry_continuum import BendingMotion, Decision, Mesh, RigidMotion, Scene, load, write_proof

# Joint limits of the two sections: least length, largest length, and the curvature of the tubes. Then the radii.
SHORTEST, LONGEST, CURVATURE = np.array([1.0, 1.0]), np.array([32.0, 26.0]), np.array([0.05, 0.06])
RADII = np.array([1.0, 0.7])

# A state is a row of `BendingMotion` for each section, times SCALE. ARMS is how far a curvature of 1 / mm moves the tip of a robot
# that is half out, in mm^2. So the distance of two states is about the distance that the tip moves.
ARMS = LONGEST / 2 * (LONGEST / 4 + [LONGEST[1] / 2, 0])
SCALE = np.stack([[1, 1], ARMS, ARMS], axis=1)
BOUNDS = np.stack([[SHORTEST, -CURVATURE, -CURVATURE], [LONGEST, CURVATURE, CURVATURE]]).swapaxes(1, 2).reshape(2, 6) * SCALE.ravel()

# `Scene.clears` checks straight links. A link is at most 1 / 32 of a section, and THICKER exceeds its distance from the arc. The
# first and last link of a section are short: they give the flat ends their direction.
SHARES = np.concatenate([[0.0, 1e-3], np.arange(1, 32) / 32, [1 - 1e-3, 1.0]])
THICKER = 0.01
LINK_RADII = np.repeat(RADII, len(SHARES) - 1) + THICKER

RESOLUTION = 1e-3  # An edge within this of a margin may stay undecided. Undecided edges are not accepted.


def sections(states):
    """Length and curvatures of each section in states (..., 6): (..., 2, 3)."""
    return np.reshape(states, (*np.shape(states)[:-1], 2, 3)) / SCALE


def centrelines(states):
    """The points of the robot in states (..., 6), in the frame of its base: (..., N, 3)."""
    rows = sections(states)
    at, frame, points = np.zeros((*rows.shape[:-2], 1, 3)), np.eye(3), []
    for section in range(2):
        bend, arc = rows[..., section, None, 1:], rows[..., section, :1] * SHARES
        angle = np.linalg.norm(bend, axis=-1) * arc
        # arc^2 (1 - cos angle) / angle^2 and arc sin(angle) / angle, also for straight sections.
        across = (0.5 * arc**2 * np.sinc(angle / (2 * np.pi)) ** 2)[..., None]
        along = (arc * np.sinc(angle / np.pi))[..., None]
        local = np.concatenate([across * bend, along], axis=-1)
        points.append(at + local[..., min(section, 1) :, :] @ np.swapaxes(frame, -1, -2))
        turn = np.zeros((*rows.shape[:-2], 3, 3))
        turn[..., :2, :2] = np.eye(2) - across[..., -1:, :] * np.swapaxes(bend, -1, -2) * bend
        turn[..., :2, 2] = along[..., -1, :] * bend[..., 0, :]
        turn[..., 2, :2] = -turn[..., :2, 2]
        turn[..., 2, 2] = np.cos(angle[..., -1])
        at, frame = points[-1][..., -1:, :], frame @ turn
    return np.concatenate(points, axis=-2)


def are_within_limits(states):
    """Whether no section bends more than its tubes. The bounds of the state space limit the lengths."""
    return (np.linalg.norm(sections(states)[..., 1:], axis=-1) <= CURVATURE).all(axis=-1)


class World:
    """The pose of the robot's base, and what the robot must not touch: meshes with margins, and a second robot beside the base.

    Margins are kept from surfaces. A robot whose base is inside the cavity cannot leave it without crossing the wall.
    """

    def __init__(self, structures, base, robot_margin):
        self.structures, self.base = structures, base
        self.scene = Scene(robot_margin=robot_margin)
        for name, (mesh, margin) in structures.items():
            self.scene.add(name, mesh, margin=margin)
        self.second = (np.array([[-5.0, 0, 0], [-4.0, 0, 9.0]]) @ base[:3, :3].T + base[:3, 3], 1.0)
        self.rest = RigidMotion(*self.second, np.eye(4), np.eye(4))

    def clears(self, states):
        """Whether the robot keeps all margins in a state (6,), or in each of many (B, 6)."""
        return self.scene.clears([(centrelines(states), LINK_RADII, self.base), self.second])

    def motion(self, starts, ends):
        """The motion along an edge, or along each of many: lengths and curvatures change evenly."""
        return BendingMotion(sections(starts), sections(ends), RADII, pose=self.base)

    def decide(self, starts, ends):
        """The proven `Decision` whether the robot keeps all margins along an edge, or along each of many."""
        return self.scene.clears_motion([self.motion(starts, ends), self.rest], resolution=RESOLUTION).decision

    def far_state(self, random, count=20_000):
        """The state whose tip is farthest from the base, among `count` random states that keep all margins."""
        states = random.uniform(*BOUNDS, (count, 6))
        states = states[are_within_limits(states)]
        states = states[self.clears(states)]
        if not len(states):
            raise SystemExit("no random state keeps the margins; lower --margin, or change --base")
        return states[np.linalg.norm(centrelines(states)[:, -1], axis=1).argmax()]


class ProvenMotions(ob.MotionValidator):
    """Accepts an edge if `Scene.clears_motion` proves that the robot keeps all margins along it."""

    def __init__(self, information, world):
        super().__init__(information)
        self.world, self.checked = world, 0

    def checkMotion(self, start, end):
        self.checked += 1
        # The limits are convex: an edge keeps them if its ends do. Planners start edges at valid states only.
        return bool(are_within_limits(end[0:6])) and self.world.decide(start[0:6], end[0:6]) is Decision.CLEAR


class Outcome(NamedTuple):
    """The result of one run of a planner."""

    seconds: float
    checked: int  # how many edges the validator checked
    accepted: np.ndarray  # (E, 2, 6): the edges of the trees or of the roadmap
    touching: np.ndarray  # (E,): which of them violate a margin
    path: np.ndarray | None  # (P, 6): the states of the plan, with shortcuts; None if none was found in time


def plan(world, ends, planner, step, seconds):
    """Plans between two states. `step` is the longest valid segment of OMPL's own validator, or None for proven edges."""
    space = ob.RealVectorStateSpace()
    for low, high in BOUNDS.T:
        space.addDimension(low, high)
    information = ob.SpaceInformation(space)
    information.setStateValidityChecker(lambda state: bool(are_within_limits(state[0:6])) and world.clears(state[0:6]))
    proven = ProvenMotions(information, world)
    if step is None:
        information.setMotionValidator(proven)
    else:
        space.setLongestValidSegmentFraction(min(1.0, step / space.getMaximumExtent()))
    information.setup()
    start, goal = space.allocState(), space.allocState()
    start[0:6], goal[0:6] = (state.tolist() for state in ends)
    problem, solver = ob.ProblemDefinition(information), planner(information)
    problem.setStartAndGoalStates(start, goal)
    solver.setProblemDefinition(problem)
    begin = time.perf_counter()
    solver.solve(float(seconds))
    seconds = time.perf_counter() - begin
    checked = proven.checked if step is None else information.getCheckedMotionCount()

    data = ob.PlannerData(information)
    solver.getPlannerData(data)
    places = [tuple(data.getVertex(k).getState()[0:6]) for k in range(data.numVertices())]
    # Each edge once: a roadmap has both directions, and where two trees meet the state belongs to both.
    accepted = np.array(sorted({tuple(sorted([place, places[b]])) for a, place in enumerate(places) for b in data.getEdges(a)}))
    accepted = accepted.reshape(-1, 2, 6)
    path, touching = None, np.zeros(len(accepted), bool)
    if len(accepted):
        touching = world.decide(accepted[:, 0], accepted[:, 1]) == Decision.CONTACT
    if problem.hasExactSolution():
        path = problem.getSolutionPath()
        og.PathSimplifier(information).reduceVertices(path)  # by the same validator
        path = np.array([state[0:6] for state in path.getStates()])
    return Outcome(seconds, checked, accepted, touching, path)


def skin(centres, half_widths, around):
    """A surface of ellipses across z with these centres (R, 3) and half-widths (R, 2). Half-widths of 0 close it."""
    angle = 2 * np.pi * np.arange(around) / around
    rings = np.repeat(centres[:, None], around, axis=1)
    rings[..., :2] += half_widths[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    a = np.arange((len(centres) - 1) * around)
    b = a - a % around + (a + 1) % around
    return Mesh(rings.reshape(-1, 3), np.concatenate([np.stack([a, b, a + around], 1), np.stack([b, b + around, a + around], 1)]))


def cavity(rings):
    """A lateral ventricle that narrows to a foramen and widens into the third ventricle, a vein across it and a plexus."""
    knots = np.array([[-7, 0, 0, 0, 0], [-5, 0, 0, 8, 7], [2, 0, 0, 11, 9], [12, 2, 0, 11, 9], [18, 5, 0, 8, 7], [23, 8, -1, 3.3, 3.3],
                      [28, 12, -2, 3.8, 6], [35, 15, -3, 3.5, 9], [42, 17, -3, 3, 9], [47, 18, -3, 0, 0]], float)
    z = np.linspace(-7, 47, rings)
    x, y, *widths = (np.interp(z, knots[:, 0], column) for column in knots[:, 1:].T)
    wall = skin(np.stack([x, y, z], axis=1), np.stack(widths, axis=1) * (1 + 0.03 * np.sin(1.1 * z))[:, None], rings // 2)
    ends = np.array([[14.0, 3, -7.5], [15, 3, 13]])
    vein = skin(np.repeat(ends, 2, axis=0), np.array([[0.0], [0.4], [0.4], [0.0]]) * [1, 1], 12)
    share = np.linspace(-1, 1, 15)
    plexus = skin(np.stack([3 + share, share - 4, 17 + 3 * share], axis=1), np.sqrt(1 - share**2)[:, None] * [2.5, 2.0], 16)
    return wall, Mesh(vein.vertices[:, [2, 1, 0]], vein.faces), plexus


def write_proofs(world, path, folder):
    """Writes each structure as .obj, and a proof for each structure and edge. Returns the files of the proofs.

    `docs/book/check_proof.py` checks a proof against the .obj. No proof covers the second robot: `World.decide` does.
    """
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for name, (mesh, margin) in world.structures.items():
        for number, (start, end) in enumerate(itertools.pairwise(path)):
            proof = mesh.prove_motion(world.motion(start, end), margin=margin, resolution=RESOLUTION)
            if proof is None:
                raise SystemExit(f"edge {number} has no proof for {name}; lower the margins")
            files.append(folder / f"{name}-{number}.txt")
            write_proof(files[-1], mesh, proof).replace(folder / f"{name}.obj")
    return files


def draw(world, path, file):
    """Draws the robot at twelve moments of the plan."""
    figure, axes = plt.subplots(figsize=(7, 8), layout="constrained", subplot_kw={"projection": "3d"})
    for k, (mesh, _) in enumerate(world.structures.values()):
        colour, alpha = ("firebrick", 0.8) if k else ("silver", 0.15)
        axes.plot_trisurf(*mesh.vertices.T, triangles=mesh.faces, color=colour, alpha=alpha, linewidth=0)
    axes.plot(*world.second[0].T, color="black", linewidth=5, label="second robot")
    times = np.linspace(0, len(path) - 1, 400)
    states = np.stack([np.interp(times, np.arange(len(path)), column) for column in path.T], axis=1)
    shapes = centrelines(states) @ world.base[:3, :3].T + world.base[:3, 3]
    for k in np.linspace(0, len(shapes) - 1, 12).astype(int):
        axes.plot(*shapes[k].T, color=plt.get_cmap("viridis")(k / len(shapes)), linewidth=3)
    axes.plot(*shapes[:, -1].T, "k--", linewidth=1, label="path of the tip")
    axes.set(xlabel="x, mm", ylabel="y, mm", zlabel="z, mm", aspect="equal")
    axes.legend(loc="upper left")
    figure.savefig(file, dpi=150)
    plt.close(figure)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mesh", help="the wall of a cavity, in mm; without it one is generated")
    parser.add_argument("--organ", action="append", default=[], help="an organ beside --mesh; may be repeated")
    parser.add_argument("--base", help="a text file of the robot's 4 x 4 base pose in --mesh; the robot leaves it along z")
    parser.add_argument("--margin", type=float, default=0.5, help="of the wall and the second robot, in mm")
    parser.add_argument("--organ-margin", type=float, default=0.5, help="of each organ, in mm")
    parser.add_argument("--rings", type=int, default=100, help="of the generated cavity: rings**2 triangles")
    parser.add_argument("--steps", type=float, nargs="*", default=[0.5, 0.1], help="of OMPL's own validator, in mm")
    parser.add_argument("--plans", type=int, default=10, help="for each planner and validator")
    parser.add_argument("--seconds", type=float, default=10, help="after which a plan is given up")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--output", type=Path, default=Path("plan"), help="the folder of plan.png and the proofs")
    given = parser.parse_args(arguments)

    wall, *organs = map(load, [given.mesh, *given.organ]) if given.mesh else cavity(given.rings)
    structures = {"wall": (wall, given.margin)} | {f"organ{k}": (mesh, given.organ_margin) for k, mesh in enumerate(organs)}
    world = World(structures, np.loadtxt(given.base) if given.base else np.eye(4), given.margin)
    start = np.array([SHORTEST[0], 0, 0, SHORTEST[1], 0, 0])
    if not world.clears(start):
        raise SystemExit("the robot does not keep the margins where it enters; lower --margin, or change --base")
    ends = [start, world.far_state(np.random.default_rng(given.seed))]

    ou.setLogLevel(ou.LOG_ERROR)
    ou.RNG.setSeed(given.seed)
    print("planner      edges by         plans     s a plan    edges  ms an edge  accepted  touching")
    outcomes = {}
    for planner, step in itertools.product([og.RRTConnect, og.PRM], [None, *given.steps]):
        outcomes[planner.__name__, step] = runs = [plan(world, ends, planner, step, given.seconds) for _ in range(given.plans)]
        seconds, checked = sum(run.seconds for run in runs), sum(run.checked for run in runs)
        print(f"{planner.__name__:12} {f'steps of {step} mm' if step else 'proof':15} {sum(run.path is not None for run in runs):2} of "
              f"{len(runs):2} {seconds / len(runs):12.3f} {checked:8} {1e3 * seconds / max(checked, 1):11.2f} "
              f"{sum(len(run.accepted) for run in runs):9} {sum(int(run.touching.sum()) for run in runs):9}")

    paths = [run.path for (_, step), runs in outcomes.items() for run in runs if step is None and run.path is not None]
    if not paths:
        raise SystemExit("no plan with proven edges was found; give more --seconds, or lower --margin")
    path = min(paths, key=len)
    files = write_proofs(world, path, given.output)
    draw(world, path, given.output / "plan.png")
    print(f"the shortest plan has {len(path) - 1} edges; {len(files)} proofs and plan.png are in {given.output}")
    return world, outcomes, path, files


if __name__ == "__main__":
    main()
