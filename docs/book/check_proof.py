#!/usr/bin/env python3
"""Checks a proof of clearance: python3 check_proof.py MESH.obj PROOF.txt

Reads a mesh (Wavefront OBJ, triangles) and a proof, both as docs/book/proofs.md describes them. All
decisions are made in whole numbers: a double is a whole number times a power of two, so nothing is
rounded. Only the order in which triangles are divided into groups compares differences of doubles,
and any order would do. Prints the premises of the proof and what it does not cover, then `yes`; or
one line, `no` with the reason. The exit status is 0 for yes and 1 for no.
"""

import hashlib
import re
import struct
import sys
from fractions import Fraction
from math import gcd, isqrt

NAMES = {"chain": [], "tube": ["curvature", "length", "off", "tilt"]}
NAMES["motion"] = NAMES["tube"] + ["speed", "turn"]

# OBJ statements that neither add nor move a triangle.
OTHER_STATEMENTS = {"vn", "vt", "o", "g", "s", "usemtl", "mtllib"}
CORNER = re.compile("([1-9][0-9]{0,8})(/[1-9][0-9]{0,8}|/([1-9][0-9]{0,8})?/[1-9][0-9]{0,8})?")

NOT_COVERED = """Not covered, for you to compare:
  - the side of the wall: the robot may be on either side of a surface, or outside of a closed one
  - the premises: that the mesh is your wall, and that these lines describe all of your robot.
Caps are for start and end: f is the disc across the centreline, d the same in a stated direction,
r the half ball beyond that disc.
Between two round caps the centreline has whole balls. The premises:"""


class No(Exception):
    """The proof does not show what it claims."""


def need(condition, reason):
    if not condition:
        raise No(reason)


def shown(text):
    """What a file says, as it may be printed: escaped, and not more than 40 characters of it."""
    return ascii(text[:40]) + ("..." if len(text) > 40 else "")


def lines(text):
    """The lines of a file, one character per byte. LF or CR LF ends a line."""
    text = text.decode("latin-1").replace("\r\n", "\n")
    need("\r" not in text, "a line ends with CR alone")
    return text.split("\n")


def words(line):
    """The words of a line, between blanks and tabs. What stands behind a # is no part of it."""
    return [word for word in re.split("[ \t]+", line.split("#")[0]) if word]


def number(word):
    """The double nearest to a decimal."""
    is_number = re.fullmatch(r"-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?", word)
    need(is_number, f"{shown(word)} is no number")
    value = float(word)
    need(value - value == 0, f"{shown(word)} is out of range")
    return value


def whole(values, scale):
    """Doubles times a power of two, as whole numbers."""
    ratios = (value.as_integer_ratio() for value in values)
    return tuple(top * (scale // bottom) for top, bottom in ratios)


def up(value):
    """The least whole number that is not below a fraction."""
    return -(-value.numerator // value.denominator)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


class Words:
    """The words of a proof, one after another."""

    def __init__(self, text):
        self.words = [word for line in lines(text) for word in words(line)]
        self.words.reverse()

    def next(self):
        need(self.words, "the proof is not complete")
        return self.words.pop()

    def expect(self, text):
        for word in text.split():
            found = self.next()
            need(found == word, f"{shown(found)} stands where '{word}' should")

    def count(self):
        word = self.next()
        need(re.fullmatch(r"[0-9]{1,9}", word), f"{shown(word)} is no count")
        return int(word)

    def number(self):
        return number(self.next())

    def not_negative(self):
        value = self.number()
        need(value >= 0, f"{value} is negative")
        return value


class Mesh:
    def __init__(self, text):
        self.vertices, self.triangles, self.groups = [], [], {}
        for line in lines(text.removeprefix(b"\xef\xbb\xbf")):
            # Some readers join such a line with the next one, a comment too.
            need(not line.rstrip(" \t").endswith("\\"), f"{shown(line)} is continued")
            kind, *rest = words(line) or [""]
            if kind == "v":
                # Three coordinates, and perhaps a colour. A weight would move the vertex.
                need(len(rest) in (3, 6), f"{shown(line)} is not a vertex with three coordinates")
                self.vertices.append(tuple([number(word) for word in rest][:3]))
            elif kind == "f":
                need(len(rest) == 3, f"{shown(line)} is not a triangle")
                corners = [CORNER.fullmatch(word) for word in rest]
                need(all(corners), f"{shown(line)} does not name three vertices, counted from 1")
                self.triangles.append(tuple(int(corner[1]) - 1 for corner in corners))
            else:
                need(not kind or kind in OTHER_STATEMENTS, f"{shown(line)} is not known of a mesh")
        count, corners = len(self.vertices), self.triangles
        need(corners, "the mesh has no triangle")
        need(all(i < count for three in corners for i in three), "a face names no vertex")
        self.low = [tuple(map(min, *(self.vertices[i] for i in three))) for three in corners]

    def digest(self):
        """SHA-256 over all coordinates as doubles, then the numbers of all corners from 0 on,
        little-endian."""
        sha = hashlib.sha256()
        for vertex in self.vertices:
            # 0 and -0 are one place.
            sha.update(struct.pack("<3d", *(x + 0.0 for x in vertex)))
        for corners in self.triangles:
            sha.update(struct.pack("<3I", *corners))
        return sha.hexdigest()

    def group(self, path):
        """The group that halvings lead to, '' for all: its triangles, its vertices, and the box
        around them."""
        if path not in self.groups:
            count = len(self.triangles)
            half = self.halves(path[:-1])[int(path[-1])] if path else range(count)
            vertices = [self.whole[i] for i in {i for t in half for i in self.triangles[t]}]
            self.groups[path] = (half, vertices, [(min(x), max(x)) for x in zip(*vertices)])
        return self.groups[path]

    def halves(self, path):
        """The rule: in the order of their least coordinates along the axis along which these are
        spread most."""
        triangles = self.group(path)[0]
        need(len(triangles) > 1, "one triangle is divided")
        columns = [[self.low[t][axis] for t in triangles] for axis in range(3)]
        spread = [max(column) - min(column) for column in columns]
        axis = spread.index(max(spread))
        ordered = sorted(triangles, key=lambda t: (self.low[t][axis], t))
        return ordered[: len(ordered) // 2], ordered[len(ordered) // 2 :]

    def not_above(self, path, q):
        """Two lower bounds on q . v over the vertices v of a group: that of the box, then the
        greatest one."""
        _, vertices, box = self.group(path)
        yield sum(min(c * low, c * high) for c, (low, high) in zip(q, box))
        a, b, c = q
        yield min(a * x + b * y + c * z for x, y, z in vertices)


class Shape:
    """Points of the centreline, the pieces between them, and the premises about these."""

    def __init__(self, words, kind):
        words.expect("shape")
        self.times = (words.number(), words.number()) if kind == "motion" else (0.0, 0.0)
        self.half = (Fraction(self.times[1]) - Fraction(self.times[0])) / 2
        count = words.count()
        need(count > 0, "a shape has no piece")
        self.points = [tuple(words.number() for _ in range(3)) for _ in range(count + 1)]
        self.pieces = []
        for _ in range(count):
            radius, caps = words.not_negative(), words.next()
            known = "[fr][fr]" if kind == "chain" else "[fr][fr]|d[fr]|[fr]d"
            need(re.fullmatch(known, caps), f"{shown(caps)} are no caps")
            rest = {name: words.not_negative() for name in NAMES[kind]}
            if "d" in caps:
                rest["direction"] = tuple(words.number() for _ in range(3))
            self.pieces.append((radius, caps, rest))
        words.expect("steps")
        self.steps = [words.next() for _ in range(words.count())]

    def premises(self):
        for (radius, caps, rest), start, end in zip(self.pieces, self.points, self.points[1:]):
            more = "".join(f", {name} {value}" for name, value in rest.items())
            yield f"  {start} to {end}: radius {radius}, caps {caps}{more}"

    def leads_to(self, later):
        """Whether the first and the last point of the centreline get to where they are in the next
        shape of a motion, each as fast as its piece may move."""
        for end in (0, -1):
            ways = [(shape, shape.pieces[end][2]) for shape in (self, later)]
            most = sum(shape.half * Fraction(p["speed"]) + Fraction(p["off"]) for shape, p in ways)
            places = zip(self.points[end], later.points[end])
            if sum((Fraction(b) - Fraction(a)) ** 2 for a, b in places) > most**2:
                return False
        return True

    def radii(self):
        """The radii along the robot, each one once where it repeats."""
        radii = [piece[0] for piece in self.pieces]
        return [radius for k, radius in enumerate(radii) if k == 0 or radius != radii[k - 1]]

    def places(self, scale):
        """For each piece its radius, its two ends, how far they move until the interval ends or are
        off, and how far the centreline may be beside the line between them, in whole numbers."""
        points = [whole(point, scale) for point in self.points]
        for (radius, _, rest), *ends in zip(self.pieces, points, points[1:]):
            moves = self.half * Fraction(rest["speed"]) + Fraction(rest["off"])
            bow = Fraction(rest["curvature"]) * Fraction(rest["length"]) ** 2 / 8
            yield radius, ends, up(moves * scale), up(bow * scale)

    def joins(self, other, scale):
        """Whether both ends of each piece are near enough to a piece of the same radius in the
        neighbouring shape, in the same order along the robot."""
        others = iter(list(other.places(scale)))
        there = next(others)
        for radius, ends, moves, _ in self.places(scale):
            for point in ends:
                while radius != there[0] or not is_near(point, there[1], moves + sum(there[2:])):
                    there = next(others, None)
                    if there is None:
                        return False
        return True

    def bodies(self, scale, margin):
        """For each piece its two ends, which of them are flat, the radius of both, and how far
        around all of it must be free, in whole numbers. src/query/proof/mod.rs derives why such
        a body contains the piece."""
        points, bodies = [whole(point, scale) for point in self.points], []
        for (r, caps, rest), *ends in zip(self.pieces, points, points[1:]):
            named = (Fraction(rest.get(name, 0)) for name in NAMES["motion"])
            r, (bend, length, off, tilt, speed, turn) = Fraction(r), named
            square = sum((b - a) ** 2 for a, b in zip(*ends))
            is_long = not rest or square <= ((length + 2 * off) * scale) ** 2
            need(is_long, f"a piece of length {rest.get('length')} does not reach its two points")
            flat, chord = [cap != "r" for cap in caps], Fraction(isqrt(square), scale)
            radius, around = r + bend * length**2 / 8 + off, margin + self.half * speed
            if any(flat):
                around += self.half * turn * r
            if "d" in caps:
                need(bend * r < 1, "a piece bends within its radius at a flat end")
                need(bend * length + tilt <= Fraction(3, 2), "a piece at a flat end bends too much")
                radius = r + bend * length**2 / 2 + tilt * length + off
                at, back = caps.index("d"), length
                if flat[1 - at]:
                    back += r * (bend * length + tilt) + off
                way = whole(rest["direction"], scale)
                need(any(way), "a stated direction is none")
                # In whole multiples of a vector along the direction, at most 1 unit too long.
                way = tuple(x // gcd(*way) for x in way)
                unit = max(isqrt(dot(way, way)), 1)
                ahead, back = (up(x * scale / unit) for x in (r * tilt + off, back))
                tip = ends[at]
                ends[at] = tuple(x + ahead * w for x, w in zip(tip, way))
                ends[1 - at] = tuple(x - back * w for x, w in zip(tip, way))
            elif any(flat) and rest:
                need(chord > 4 * off, "a flat end has no certain direction")
                need(bend * length <= 1, "a piece with a flat end bends too much")
                turned = bend * length / 2 + tilt + Fraction(22, 7) * off / chord
                # In shares of the chord, whose coordinates are multiples of 2^64.
                share = up((r * turned + off) / chord * 2**64)
                axis = tuple((b - a) >> 64 for a, b in zip(*ends))
                for end, sign in ((0, -1), (1, 1)):
                    if flat[end]:
                        ends[end] = tuple(x + sign * share * w for x, w in zip(ends[end], axis))
            need(not any(flat) or ends[0] != ends[1], "a flat end has no certain direction")
            bodies.append((*ends, flat, up(radius * scale), up(around * scale)))
        return bodies


def is_near(point, ends, most):
    """Whether a point is at most so far from the line between two others."""
    start, end = ends
    axis = tuple(b - a for a, b in zip(start, end))
    way = tuple(b - a for a, b in zip(start, point))
    along, length = dot(way, axis), dot(axis, axis)
    if along <= 0:
        return dot(way, way) <= most**2
    if along >= length:
        return sum((b - a) ** 2 for a, b in zip(end, point)) <= most**2
    return dot(way, way) * length - along**2 <= most**2 * length


def is_below(q, level, body):
    """Whether a body, with what must be free around it, lies below the plane q . x = level.

    Both its ends must be farther below than a + b, where a is how far the end reaches towards the
    plane and b is how far around it must be free, all times |q|. Of half a ball that the plane is
    in front of a^2 = r^2 q^2, of a disc across the axis w, or of half a ball from behind, it is
    r^2 (q^2 - (q . w)^2 / w^2). d > a + b is d^2 > a^2 + b^2 and (d^2 - a^2 - b^2)^2 > 4 a^2 b^2,
    without roots."""
    start, end, flat, radius, around = body
    axis = tuple(to - at for at, to in zip(start, end))
    square, length, height = dot(q, q), dot(axis, axis), dot(q, axis)
    for point, is_flat, out in zip((start, end), flat, (-height, height)):
        d, is_disc = level - dot(q, point), is_flat or out < 0
        # Of a disc all is multiplied by w^2.
        unit, reach = (length, square * length - height**2) if is_disc else (1, square)
        a2, b2 = radius**2 * reach, around**2 * square * unit
        rest = d**2 * unit - a2 - b2
        if d <= 0 or rest <= 0 or rest**2 <= 4 * a2 * b2:
            return False
    return True


def check(mesh, bodies, steps):
    """Follows the steps from all triangles and all pieces on. Returns how many planes there are."""
    planes, to_part, steps = 0, [("", 0, len(bodies))], iter(steps)
    while to_part:
        path, first, end = to_part.pop()
        step = next(steps, None)
        need(step, "the steps end before all is parted")
        if step == "t":
            need(len(mesh.group(path)[0]) > 1, "one triangle is divided")
            to_part += [(path + "1", first, end), (path + "0", first, end)]
        elif step == "p":
            need(end - first > 1, "one piece is divided")
            middle = (first + end) // 2
            to_part += [(path, middle, end), (path, first, middle)]
        else:
            is_plane = re.fullmatch(r"-?[0-9]{1,30},-?[0-9]{1,30},-?[0-9]{1,30}", step)
            need(is_plane, f"{shown(step)} is no step")
            q = tuple(int(word) for word in step.split(","))
            run, levels = bodies[first:end], mesh.not_above(path, q)
            parted = any(all(is_below(q, level, body) for body in run) for level in levels)
            what = f"pieces {first} to {end - 1} from the triangles '{path}'"
            need(parted, f"{step} parts not {what}")
            planes += 1
    need(next(steps, None) is None, "there are steps left")
    return planes


def main(mesh_path, proof_path):
    with open(mesh_path, "rb") as file:
        mesh = Mesh(file.read())
    with open(proof_path, "rb") as file:
        words = Words(file.read())
    words.expect("proof of clearance 2 mesh")
    counts = [words.count(), words.count()]
    is_same = counts == [len(mesh.vertices), len(mesh.triangles)]
    need(is_same, "the proof is about another mesh: it has other counts")
    need(words.next() == mesh.digest(), "the proof is about another mesh")
    words.expect("margin")
    margin, kind = words.not_negative(), words.next()
    need(kind in NAMES, f"{shown(kind)} is no kind of robot")
    shapes = [Shape(words, kind) for _ in range(words.count())]
    words.expect("end")
    need(not words.words, "something stands behind the end")
    if kind == "motion":
        times = [time for shape in shapes for time in shape.times]
        reaches = times[:1] == [0.0] and times[-1:] == [1.0]
        need(reaches, "the times do not reach from 0 to 1")
        need(times[1:-1:2] == times[2::2], "a time is left out")
        need(all(shape.half > 0 for shape in shapes), "an interval of time has no length")
        follow = all(shape.leads_to(later) for shape, later in zip(shapes, shapes[1:]))
        need(follow, "the robot jumps between two shapes: it is faster than is stated")
        same = all(shape.radii() == shapes[0].radii() for shape in shapes)
        need(same, "the radii differ between two shapes")
    else:
        need(len(shapes) == 1, "there is not one shape")
    doubles = [x for vertex in mesh.vertices for x in vertex] + [margin]
    doubles += [x for shape in shapes for point in shape.points for x in point]
    doubles += [piece[0] for shape in shapes for piece in shape.pieces]
    rests = [rest for shape in shapes for *_, rest in shape.pieces]
    doubles += [x for rest in rests for x in rest.get("direction", ())]
    # Coordinates become whole numbers so, and what is rounded up to one is rounded by little.
    scale = max(x.as_integer_ratio()[1] for x in doubles) * 2**64
    mesh.whole = [whole(vertex, scale) for vertex in mesh.vertices]
    if kind == "motion":
        pairs = list(zip(shapes, shapes[1:]))
        joined = all(a.joins(b, scale) and b.joins(a, scale) for a, b in pairs)
        need(joined, "a part of the robot jumps between two shapes: it is faster than is stated")
    bodies = (shape.bodies(scale, Fraction(margin)) for shape in shapes)
    planes = sum(check(mesh, all_of, shape.steps) for all_of, shape in zip(bodies, shapes))
    print(f"This {kind} keeps more than {margin} from {counts[1]} triangles, by {planes} planes.")
    print(NOT_COVERED)
    for shape in shapes:
        if kind == "motion":
            print(f" from t = {shape.times[0]} to {shape.times[1]}, at their middle:")
        print("\n".join(shape.premises()))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
        print("yes")
    except Exception as reason:  # Whatever cannot be read is no proof.
        # A `No` is escaped already where it quotes a file.
        text = str(reason) if isinstance(reason, No) else ascii(f"{type(reason).__name__}: {reason}")
        print("no: " + text)
        sys.exit(1)
