#!/usr/bin/env python3
"""Checks a proof of clearance: python3 check_proof.py MESH.obj PROOF.txt

Reads a mesh (Wavefront OBJ, triangles) and a proof as docs/book/proofs.md describes it. What is decided is decided in whole
numbers: a double is a whole number times a power of two, so that nothing is rounded. Only the order in which triangles are
divided into groups compares differences of doubles, and any order would do. Prints what the proof takes for granted, and
`yes`, or `no` with the reason. The exit status is 0 for yes and 1 for no.
"""

import hashlib
import re
import struct
import sys
from fractions import Fraction
from math import isqrt

NAMES = {"chain": [], "tube": ["curvature", "length", "off"]}
NAMES["motion"] = NAMES["tube"] + ["speed", "turn"]


class No(Exception):
    """The proof does not show what it claims."""


def need(condition, reason):
    if not condition:
        raise No(reason)


def number(word):
    """The double nearest to a decimal."""
    need(re.fullmatch(r"-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?", word), f"'{word}' is no number")
    value = float(word)
    need(value - value == 0, f"'{word}' is out of range")
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
    """The words of a proof, one after another. What stands behind a # is no part of it."""

    def __init__(self, text):
        self.words = [word for line in text.splitlines() for word in line.split("#")[0].split()]
        self.words.reverse()

    def next(self):
        need(self.words, "the proof is not complete")
        return self.words.pop()

    def expect(self, text):
        for word in text.split():
            found = self.next()
            need(found == word, f"'{found}' stands where '{word}' should")

    def count(self):
        word = self.next()
        need(re.fullmatch(r"[0-9]{1,9}", word), f"'{word}' is no count")
        return int(word)

    def number(self):
        return number(self.next())

    def not_negative(self):
        value = self.number()
        need(value >= 0, f"{value} is negative")
        return value


class Mesh:
    def __init__(self, path):
        self.vertices, self.triangles, self.groups = [], [], {}
        with open(path, encoding="utf-8-sig") as lines:
            for line in lines:
                words = line.split()
                if words[:1] == ["v"]:
                    need(len(words) > 3, "a vertex of the mesh has not three coordinates")
                    self.vertices.append(tuple(number(word) for word in words[1:4]))
                elif words[:1] == ["f"]:
                    need(len(words) == 4, "a face of the mesh is not a triangle")
                    self.triangles.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:]))
        count, corners = len(self.vertices), self.triangles
        need(corners and all(0 <= i < count for three in corners for i in three), "a face names no vertex")
        self.low = [tuple(map(min, *(self.vertices[i] for i in three))) for three in corners]

    def digest(self):
        """SHA-256 over all coordinates as doubles, then the numbers of all corners from 0 on, little-endian."""
        sha = hashlib.sha256()
        for vertex in self.vertices:
            # 0 and -0 are one place.
            sha.update(struct.pack("<3d", *(x + 0.0 for x in vertex)))
        for corners in self.triangles:
            sha.update(struct.pack("<3I", *corners))
        return sha.hexdigest()

    def group(self, path):
        """The group that halvings lead to, '' for all: its triangles, its vertices, and the box around them."""
        if path not in self.groups:
            half = self.halves(path[:-1])[int(path[-1])] if path else range(len(self.triangles))
            vertices = [self.whole[i] for i in {i for t in half for i in self.triangles[t]}]
            self.groups[path] = (half, vertices, [(min(x), max(x)) for x in zip(*vertices)])
        return self.groups[path]

    def halves(self, path):
        """The rule: in the order of their least coordinates along the axis along which these are spread most."""
        triangles = self.group(path)[0]
        need(len(triangles) > 1, "one triangle is divided")
        columns = [[self.low[t][axis] for t in triangles] for axis in range(3)]
        spread = [max(column) - min(column) for column in columns]
        axis = spread.index(max(spread))
        ordered = sorted(triangles, key=lambda t: (self.low[t][axis], t))
        return ordered[: len(ordered) // 2], ordered[len(ordered) // 2 :]

    def not_above(self, path, q):
        """Two numbers that q . v is not below for any vertex v of a group: that of the box, then the greatest there is."""
        _, vertices, box = self.group(path)
        yield sum(min(c * low, c * high) for c, (low, high) in zip(q, box))
        a, b, c = q
        yield min(a * x + b * y + c * z for x, y, z in vertices)


class Shape:
    """Points of the centreline, the pieces between them, and what is taken for granted of these."""

    def __init__(self, words, kind):
        words.expect("shape")
        self.times = (words.number(), words.number()) if kind == "motion" else (0.0, 0.0)
        count = words.count()
        need(count > 0, "a shape has no piece")
        self.points = [(words.number(), words.number(), words.number()) for _ in range(count + 1)]
        self.pieces = []
        for _ in range(count):
            radius, caps = words.not_negative(), words.next()
            need(re.fullmatch("[fr][fr]", caps), f"'{caps}' are no caps")
            rest = {name: words.not_negative() for name in NAMES[kind]}
            self.pieces.append((radius, caps, rest))
        words.expect("steps")
        self.steps = [words.next() for _ in range(words.count())]

    def premises(self):
        for (radius, caps, rest), start, end in zip(self.pieces, self.points, self.points[1:]):
            yield f"  {start} to {end}: radius {radius}, caps {caps}" + "".join(f", {n} {v}" for n, v in rest.items())

    def bodies(self, scale, margin):
        """For each piece its two ends, which of them are flat, the radius of both, and how far around all of it must be
        free, in whole numbers. The page on proofs says why such a body has the piece."""
        half = (Fraction(self.times[1]) - Fraction(self.times[0])) / 2
        points, bodies = [whole(point, scale) for point in self.points], []
        for (r, caps, rest), start, end in zip(self.pieces, points, points[1:]):
            rest = {name: Fraction(value) for name, value in rest.items()}
            bend, length, off, speed, turn = (rest.get(name, Fraction(0)) for name in NAMES["motion"])
            radius = Fraction(r) + bend * length**2 / 8 + off
            around = margin + half * speed
            flat = [cap == "f" for cap in caps]
            if any(flat):
                chord = Fraction(isqrt(sum((b - a) ** 2 for a, b in zip(start, end))), scale)
                need(chord > 2 * off, "a flat end has no certain direction")
                need(bend * length <= 1, "a piece with a flat end bends too much")
                around += half * turn * Fraction(r) + Fraction(r) * bend * length / 2
                around += off + radius * off * Fraction(22, 7) / chord
            bodies.append((start, end, flat, up(radius * scale), up(around * scale)))
        return bodies


def is_below(q, level, body):
    """Whether a body, with what must be free around it, lies below the plane q . x = level.

    Both its ends must be farther below than a + b, where a is how far the end reaches towards the plane and b is how far
    around it must be free, all times |q|. Of half a ball that the plane is in front of a^2 = r^2 q^2, of a disc across the
    axis w, or of half a ball from behind, it is r^2 (q^2 - (q . w)^2 / w^2). d > a + b is d^2 > a^2 + b^2 and
    (d^2 - a^2 - b^2)^2 > 4 a^2 b^2, without roots."""
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
            need(re.fullmatch(r"-?[0-9]{1,30},-?[0-9]{1,30},-?[0-9]{1,30}", step), f"'{step}' is no step")
            q = tuple(int(word) for word in step.split(","))
            levels = mesh.not_above(path, q)
            parted = any(all(is_below(q, level, body) for body in bodies[first:end]) for level in levels)
            need(parted, f"{step} parts not pieces {first} to {end - 1} from the triangles '{path}'")
            planes += 1
    need(next(steps, None) is None, "there are steps left")
    return planes


def main(mesh_path, proof_path):
    mesh = Mesh(mesh_path)
    with open(proof_path, encoding="utf-8") as file:
        words = Words(file.read())
    words.expect("proof of clearance 1 mesh")
    counts = [words.count(), words.count()]
    need(counts == [len(mesh.vertices), len(mesh.triangles)], "the proof is about another mesh: it has other counts")
    need(words.next() == mesh.digest(), "the proof is about another mesh")
    words.expect("margin")
    margin, kind = words.not_negative(), words.next()
    need(kind in NAMES, f"'{kind}' is no kind of robot")
    shapes = [Shape(words, kind) for _ in range(words.count())]
    words.expect("end")
    need(not words.words, "something stands behind the end")
    times = [time for shape in shapes for time in shape.times]
    if kind == "motion":
        need(times[:1] == [0.0] and times[-1:] == [1.0], "the times do not reach from 0 to 1")
        need(times[1:-1:2] == times[2::2] and times == sorted(times), "a time is left out")
    else:
        need(len(shapes) == 1, "there is not one shape")
    doubles = [x for vertex in mesh.vertices for x in vertex] + [margin]
    doubles += [x for shape in shapes for point in shape.points for x in point]
    doubles += [piece[0] for shape in shapes for piece in shape.pieces]
    # Coordinates become whole numbers so, and what is rounded up to one is rounded by little.
    scale = max(x.as_integer_ratio()[1] for x in doubles) * 2**64
    mesh.whole = [whole(vertex, scale) for vertex in mesh.vertices]
    planes = sum(check(mesh, shape.bodies(scale, Fraction(margin)), shape.steps) for shape in shapes)
    print(f"This {kind} keeps more than {margin} from {counts[1]} triangles, by {planes} planes. Taken for granted:")
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
    except (No, OSError, ValueError) as reason:
        print(f"no: {reason}")
        sys.exit(1)
