"""Robots beside robots: this package beside python-fcl and coal. Alone it writes its chapter to the standard output."""

import importlib.util
import itertools
import time

import numpy as np
from ways import turned

from parry_continuum import RobotPair, SelfQuery

ENOUGH = 0.15  # seconds of each question in each round
ROUNDS = 3
ALL = float(np.finfo(float).max)


def bent(side):
    """A robot of 30 links that bends to one side: its points and its radius."""
    s = 2.0 * np.arange(31)
    turn = s / 45
    return np.stack([side * 45 * (1 - np.cos(turn)), 0.3 * s * np.sin(s / 20), 45 * np.sin(turn)], axis=1), 1.0


def coil(links):
    """A coil of three turns: its points and its radius."""
    turn = np.arange(links + 1) * 6 * np.pi / links
    return np.stack([10 * np.cos(turn), 10 * np.sin(turn), 4 * turn / np.pi], axis=1), 0.8


def timed(ask, places):
    """The median of bursts, each of all places: a question's microseconds of processor time, and the answers."""
    found = np.array([ask(place) for place in places], float)
    times, until = [], time.perf_counter() + ENOUGH
    while len(times) < 5 or time.perf_counter() < until:
        begin = time.process_time()
        for place in places:
            ask(place)
        times.append(time.process_time() - begin)
    return 1e6 * float(np.median(times)) / len(places), found


class Fcl:
    """python-fcl: made once, then moved."""

    name, keeps_least = "python-fcl", True

    def __init__(self):
        import fcl

        self.fcl = fcl

    def link(self, radius, length, rotation, middle, sphere=False):
        fcl = self.fcl
        shape = fcl.Sphere(radius) if sphere else fcl.Capsule(radius, length)
        return fcl.CollisionObject(shape, fcl.Transform(rotation, middle))

    def manager(self, objects):
        manager = self.fcl.DynamicAABBTreeCollisionManager()
        manager.registerObjects(objects)
        manager.setup()
        return manager

    def move(self, link, middle):
        link.setTranslation(middle)

    def least(self, pairs, bound):
        distance, request, kept = self.fcl.distance, self.fcl.DistanceRequest(), self.fcl.DistanceResult(bound)
        for one, two in pairs:
            distance(one, two, request, kept)
        return kept.min_distance

    def clears(self, pairs, margin):
        return self.least(pairs, margin) >= margin

    def of_managers(self, one, two, bound):
        data = self.fcl.DistanceData(result=self.fcl.DistanceResult(bound))
        one.distance(two, data, self.fcl.defaultDistanceCallback)
        return data.result.min_distance

    def of_itself(self, manager, parts, bound):
        fcl, order = self.fcl, {part.getTranslation().tobytes(): k for k, part in enumerate(parts)}

        def but_neighbours(one, two, data):  # they are other objects here, told by their places
            places = [order[part.getTranslation().tobytes()] for part in (one, two)]
            if abs(places[0] - places[1]) < 2:
                return False, data.result.min_distance
            return fcl.defaultDistanceCallback(one, two, data)

        data = fcl.DistanceData(result=fcl.DistanceResult(bound))
        manager.distance(data, but_neighbours)
        return data.result.min_distance


class Coal:
    """coal: made once, then moved."""

    name, keeps_least = "coal", False

    def __init__(self):
        import coal

        self.coal = coal

    def link(self, radius, length, rotation, middle, sphere=False):
        coal = self.coal
        shape = coal.Sphere(radius) if sphere else coal.Capsule(radius, length)
        return coal.CollisionObject(shape, rotation, middle)

    def manager(self, objects):
        manager = self.coal.DynamicAABBTreeCollisionManager()
        for one in objects:
            manager.registerObject(one)
        manager.setup()
        return manager

    def move(self, link, middle):
        link.setTranslation(middle)
        link.computeAABB()

    def least(self, pairs, bound):
        distance, request, result = self.coal.distance, self.coal.DistanceRequest(), self.coal.DistanceResult()
        return min(bound, min(distance(one, two, request, result) for one, two in pairs))

    def clears(self, pairs, margin):
        collide, request, result = self.coal.collide, self.coal.CollisionRequest(), self.coal.CollisionResult()
        request.security_margin = margin
        clears = True
        for one, two in pairs:
            result.clear()
            clears &= not collide(one, two, request, result)
        return clears

    def of_managers(self, one, two, bound):
        callback = self.coal.DistanceCallBackDefault()  # one of Python's cannot be made
        callback.data.result.min_distance = bound
        one.distance(two, callback)
        return callback.data.result.min_distance


def links(peer, robot, sphere=False):
    points, radius = robot
    pieces = itertools.pairwise(points)
    return [
        peer.link(radius, np.linalg.norm(end - start), turned(end - start), (start + end) / 2, sphere)
        for start, end in pieces
    ]


def two_robots(peer_types, offset):
    """Rows of the table of two robots: the name, the times of both questions, how far the distance is off."""
    a, b = bent(1.0), bent(-1.0)
    places = [np.array([offset + 0.2 * k, 4.0, 0.0]) for k in range(60)]
    poses = []
    for place in places:
        pose = np.eye(4)
        pose[:3, 3] = place
        poses.append(pose)
    pair = RobotPair()
    given = (*a, *b)
    rows = []

    def own(name, minimum, clears, robots=given):
        taken, found = timed(lambda pose: minimum(*robots, pose_b=pose, caps="capsules").distance, poses)
        margin = found.min() / 2
        kept, clear = timed(lambda pose: clears(*robots, margin=margin, pose_b=pose, caps="capsules"), poses)
        assert clear.all()
        rows.append((name, taken, kept, "", ""))
        return found, margin

    def new_minimum(*robots, **more):
        return RobotPair().minimum(*robots, **more)

    def new_clears(*robots, **more):
        return RobotPair().clears(*robots, **more)

    exact, margin = own("**`RobotPair`**, a new one for each query", new_minimum, new_clears)
    own("**`RobotPair`**, the same for all queries", pair.minimum, pair.clears)
    short = (a[0][:2], a[1], b[0][:2], b[1])
    own("a new `RobotPair`, one link and one: what a call costs", new_minimum, new_clears, short)

    middles = (b[0][1:] + b[0][:-1]) / 2
    for make in peer_types:
        peer = make()

        def loop(question, bound, sphere, peer=peer):
            one, two = links(peer, a, sphere), links(peer, b, sphere)

            def ask(place):
                for link, middle in zip(two, middles + place, strict=True):
                    peer.move(link, middle)
                return question(itertools.product(one, two), bound)

            return ask

        def managers(bound, peer=peer):
            one, two = links(peer, a), links(peer, b)
            first, second = peer.manager(one), peer.manager(two)

            def ask(place):
                for link, middle in zip(two, middles + place, strict=True):
                    peer.move(link, middle)
                second.update()
                return peer.of_managers(first, second, bound)

            return ask

        bounded = managers(margin)
        for name, minimum, clears in [
            ("900 pairs of capsules", loop(peer.least, ALL, False), loop(peer.clears, margin, False)),
            ("managers of capsules", managers(ALL), lambda place, ask=bounded, margin=margin: ask(place) >= margin),
            ("900 pairs of spheres: what the calls cost", loop(peer.least, ALL, True), loop(peer.clears, margin, True)),
        ]:
            taken, found = timed(minimum, places)
            kept = None
            if peer.keeps_least or "managers" not in name:
                kept, clear = timed(clears, places)
                assert clear.all()
            over = under = ""
            if "capsules" in name:
                over, under = (f"{off:.1e}" if off > 0 else "0" for off in ((found - exact).max(), (exact - found).max()))
            rows.append((f"{peer.name}, {name}", taken, kept, over, under))
            print(rows[-1], flush=True)
    return rows


def one_robot(peer_types, count):
    """Rows of the table of a coil: the name and the times of both questions."""
    robot = coil(count)
    once = range(5)
    query = SelfQuery()
    rows = []
    for name, query_of in [
        ("**`SelfQuery`**, a new one for each query", SelfQuery),
        ("**`SelfQuery`**, the same for all queries", lambda: query),
    ]:
        taken = timed(lambda _, of=query_of: of().minimum(*robot, caps="capsules").distance, once)[0]
        kept = timed(lambda _, of=query_of: of().clears(*robot, margin=1.0, caps="capsules"), once)[0]
        rows.append((name, taken, kept))
    for make in peer_types:
        peer = make()
        for shape in ("capsules", "spheres"):
            parts = links(peer, robot, shape == "spheres")
            pairs = [(one, two) for k, one in enumerate(parts) for two in parts[k + 2 :]]
            taken = timed(lambda _, peer=peer, pairs=pairs: peer.least(pairs, ALL), once)[0]
            kept = timed(lambda _, peer=peer, pairs=pairs: peer.clears(pairs, 1.0), once)[0]
            cost = ": what the calls cost" if shape == "spheres" else ""
            rows.append((f"{peer.name}, {len(pairs):,} pairs of {shape}{cost}", taken, kept))
            print(rows[-1], flush=True)
        if peer.keeps_least:
            parts = links(peer, robot)
            manager = peer.manager(parts)

            def ask(bound, peer=peer, manager=manager, parts=parts):
                return peer.of_itself(manager, parts, bound)

            taken, kept = timed(lambda _, ask=ask: ask(ALL), once)[0], timed(lambda _, ask=ask: ask(1.0), once)[0]
            rows.append((f"{peer.name}, a manager of capsules", taken, kept))
    return rows


def least_of_rounds(rows_of, *given):
    """The rows, each time the least of several rounds, which go through all rows in turn."""
    rounds = [rows_of(*given) for _ in range(ROUNDS)]
    return [
        (name, *(None if times[0] is None else min(times) for times in zip(*(row[1:3] for row in same), strict=True)), *rest)
        for same in zip(*rounds, strict=True)
        for name, _, _, *rest in same[:1]
    ]


def chapter(number):
    """The lines of the chapter; `number` writes a time."""
    peer_types = [peer for peer, package in ((Fcl, "fcl"), (Coal, "coal")) if importlib.util.find_spec(package)]
    lines = [
        "## Robots beside robots",
        "",
        "Two bent robots of 30 links; the second moves past the first in 60 places. The queries: the least distance, and whether they keep",
        "half of the least distance of all places as a margin. All links are capsules here, ours too. Microseconds of processor time per",
        "query, the least of three medians of bursts, in turns. The peers' shapes are made once, and the second robot's links are moved for",
        "every query. The near robots bend past one another without contact: their planes are 4 mm apart.",
        "",
        "- Pairs: python-fcl's `distance` of each, which takes no bound. coal's `distance`, and for the margin its `collide` with a",
        "  `security_margin`.",
        "- Managers: `DynamicAABBTreeCollisionManager.distance` of two, with the library's own callback, which prunes pairs whose boxes are",
        "  farther than the least so far. python-fcl's callback runs in Python, and starts from the margin if there is one. coal's callback",
        "  keeps the distance of the last pair, not the least, and Python cannot replace it. So its time is not the time of a right",
        "  answer, and it is not measured with the margin.",
        "- Spheres in place of the capsules cost hardly more than the calls, loops and moves in Python. Subtract them to get the time of",
        "  C++.",
        "",
        "| robots | way | distance, us | margin, us | too far by, mm | too near by, mm |",
        "|---|---|---|---|---|---|",
    ]
    for name, offset in (("near", 26.0), ("far", 80.0)):
        for way, taken, kept, over, under in least_of_rounds(two_robots, peer_types, offset):
            lines.append(f"| {name} | {way} | {number(taken)} | {'' if kept is None else number(kept)} | {over} | {under} |")
    lines += [
        "",
        "A coil of three turns beside itself; the margin is 1 mm. The loops leave out only neighbours, and find parts that are near because",
        "they are near along the robot; this package queries parts that could meet. So the answers are not compared, and no loop stops at",
        "the first pair within the margin. The manager's callback in Python leaves out neighbours; coal takes no callback.",
        "",
        "| links | way | distance, us | margin, us |",
        "|---|---|---|---|",
    ]
    for count in (60, 100):
        lines += [f"| {count} | {way} | {number(taken)} | {number(kept)} |" for way, taken, kept in least_of_rounds(one_robot, peer_types, count)]
    return lines


if __name__ == "__main__":
    print("\n".join(chapter(lambda value: f"{value:,.1f}")))
